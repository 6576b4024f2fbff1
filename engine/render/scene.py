"""What is to be seen in one frame, as plain data. The renderer knows nothing else: no clips, rules or threats."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.body.skeleton import ANKLES, HEAD, LEFT, RIGHT, TOES, WRISTS, Body
from engine.maths import quaternion

if TYPE_CHECKING:
    from engine.core.debug_draw import DebugDraw

Colour = tuple[float, float, float]  # sRGB as an artist picks it, 0..1

# Hermens 2006, figures 1.1, 1.2 and 4.1
CLIP_BLUE: Colour = (0.20, 0.45, 0.86)
RULES_YELLOW: Colour = (0.97, 0.78, 0.12)
SUSTAINED_ORANGE: Colour = (0.95, 0.47, 0.10)
SIMULATED_RED: Colour = (0.84, 0.17, 0.16)
BLEND_GREY: Colour = (0.55, 0.57, 0.60)
PERSON: Colour = (0.90, 0.87, 0.83)  # the one who lives: warm porcelain

_FLESH_M, _SKIN_M = 0.08, 0.015  # how far a body's surface is from its joints, and from its tips


@dataclass(frozen=True)
class Figure:
    """One character, as kinematics left it."""

    body: Body
    positions: np.ndarray  # (21, 3) joints, world metres
    orientations: np.ndarray  # (21, 4) w x y z
    colour: Colour = PERSON
    alpha: float = 1.0  # below 1: a ghost, seen through and without shadow
    style: str = "smooth"  # or "jointed": a mannequin of rigid parts


@dataclass(frozen=True)
class Ball:
    """Anything thrown."""

    position_m: Any  # (3,)
    radius_m: float = 0.105
    orientation: Any = (1.0, 0.0, 0.0, 0.0)  # w x y z: the panels show the spin
    kind: str = "volleyball"  # anything else is drawn as a plain two-tone ball
    alpha: float = 1.0


@dataclass(frozen=True)
class Balance:
    """Where a character's weight is, drawn on the floor: support polygon, the COM's foot point, where it is wanted."""

    support_m: np.ndarray  # (N, 2) corners in order, world; fewer than three: only the marker
    com_m: Any = None  # (3,) world; None draws no marker
    wanted_m: Any = None  # (2,) the optimisation's goal, drawn as an open ring
    colour: Colour = SUSTAINED_ORANGE


FLOORS = ("plain", "gym")


@dataclass(frozen=True)
class FloorStyle:
    """The ground and what is around it: `plain`, a floor that melts into paper, or `gym`, a volleyball hall.

    Centre, lines and fading are those of the plain one; `centre_m` None follows what the camera looks at.
    """

    style: str = "plain"  # one of FLOORS
    shown: bool = True
    lines: bool = True
    centre_m: tuple[float, float] | None = None
    fade_m: float = 11.0  # distance at which it has melted into the background


@dataclass
class Scene:
    """Everything in one picture."""

    figures: list[Figure] = field(default_factory=list)
    balls: list[Ball] = field(default_factory=list)
    balances: list[Balance] = field(default_factory=list)
    draw: DebugDraw | None = None
    floor: FloorStyle = field(default_factory=FloorStyle)
    captions: list[tuple[str, str]] = field(default_factory=list)  # (corner, text); corners: top-left ... bottom-right


def extent_points(scene: Scene) -> np.ndarray:
    """Points (N, 3) that a camera must see to see all figures and balls, surfaces included; none below the floor."""
    points = [np.zeros((0, 3))]
    for figure in scene.figures:
        points += [_surrounded(figure.positions, _FLESH_M), _surrounded(tips_of(figure), _SKIN_M)]
    points += [_surrounded(np.reshape(ball.position_m, (1, 3)), ball.radius_m) for ball in scene.balls]
    around = np.vstack(points)
    return np.column_stack([around[:, :2], np.maximum(around[:, 2], 0.0)])


def tips_of(figure: Figure) -> np.ndarray:
    """Crown, fingertips and soles of a figure (N, 3), world metres."""
    body, tips = figure.body, [(HEAD, figure.body.head_top_m)]
    for side in (LEFT, RIGHT):
        tips += [(WRISTS[side], body.fingertip_m[side])]
        tips += [(ANKLES[side], point) for point in body.sole_m[side, :4]]
        tips += [(TOES[side], point) for point in body.sole_m[side, 4:]]
    return np.array(
        [np.add(figure.positions[j], quaternion.rotate(figure.orientations[j], point)) for j, point in tips]
    )


def _surrounded(points_m: np.ndarray, radius_m: float) -> np.ndarray:
    """Each point's six neighbours at a distance along the axes."""
    return (points_m[:, None, :] + radius_m * np.vstack([np.eye(3), -np.eye(3)])).reshape(-1, 3)
