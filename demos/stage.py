"""What is to be seen of a world, as plain data for the renderer: people and balls, and what the people believe.

Nothing here changes state: a world that is drawn and one that is not go on alike.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from behaviours.components import Character, Feet, Flight, Phase, Posture, Reaction, Sustained
from behaviours.perceive.threats import KINDS
from behaviours.playing import body_of, clip_pose, clip_time_s
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import Body, Pose
from engine.body.support import polygon_of, sole_points
from engine.maths import rotations
from engine.render.scene import (
    BLEND_GREY,
    CLIP_BLUE,
    PERSON,
    RULES_YELLOW,
    SIMULATED_RED,
    SUSTAINED_ORANGE,
    Balance,
    Ball,
    Figure,
    FloorStyle,
    Scene,
)

GHOSTS = ("clip", "rules", "sustained")
GHOST_ALPHA = 0.35
STANDING_M = 0.012  # a sole as low as this stands on the ground
# the thesis's colours of fig. 4.1 for the floor marks: what the character is doing now
PHASE_COLOURS = {
    Phase.PLAY: CLIP_BLUE,
    Phase.RESPOND: SIMULATED_RED,
    Phase.DOWN: SIMULATED_RED,
    Phase.RECOVER_BLEND: BLEND_GREY,
    Phase.RECOVER_RETURN: BLEND_GREY,
}
HALL_M = (18.0, 11.0)  # from its middle: farther out, somebody is as good as in the wall
PROTECTING = (Phase.STARTLE, Phase.PROTECT, Phase.HOLD, Phase.RESPOND)


def scene_of(world, alpha: float = 1.0, ghosts: Collection[str] = ()) -> Scene:
    """The world as it looks a share `alpha` of the way from the tick before the last to the last.

    `ghosts`: which of GHOSTS to show beside the living, while a character protects itself.
    """
    scene = Scene(floor=FloorStyle("gym"))
    for row in world.rows(Character, Posture):
        body, pose = body_of(world, row), shown_pose(world, row, alpha)
        positions, orientations = joints_of(body, pose)
        scene.figures.append(Figure(body, positions, orientations, PERSON))
        scene.balances.append(_balance(world, row, body, pose, positions, orientations))
        for name, (colour, ghost) in _ghosts(world, row).items():
            if name in ghosts:
                scene.figures.append(Figure(body, *joints_of(body, ghost), colour, GHOST_ALPHA))
    scene.balls.extend(_balls(world, alpha))
    return scene


def floor_under(scene: Scene, style: str) -> FloorStyle:
    """The floor asked for; plain ground once somebody has walked on out of the hall, which has walls."""
    outside = any((np.abs(figure.positions[0, :2]) > HALL_M).any() for figure in scene.figures)
    return FloorStyle("plain" if style == "gym" and outside else style)


def shown_pose(world, row: int, alpha: float = 1.0) -> Pose:
    """A character between the last two ticks."""
    p = world[Posture]
    return Pose(
        (1.0 - alpha) * p.before_root_m[row] + alpha * p.root_m[row],
        rotations.slerp(p.before_rotations[row], p.rotations[row], alpha),
    )


def standing(world, row: int, body: Body, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """(2,) bool: the feet that carry: flagged as planted, or with the sole on the ground."""
    low_m = sole_points(body, positions, orientations)[..., 2].min(axis=1)
    return world[Feet].planted[row] | (low_m < STANDING_M)


def pelvis_m(world, row: int) -> np.ndarray:
    """Where a character is, for cameras to follow."""
    return world[Posture].root_m[row].copy()


def _balance(world, row: int, body: Body, pose: Pose, positions: np.ndarray, orientations: np.ndarray) -> Balance:
    phase = Phase(int(world[Reaction].phase[row]))
    polygon = polygon_of(body, positions, orientations, standing(world, row, body, positions, orientations))
    wanted = world[Sustained].com_wanted_m[row].copy() if phase in PROTECTING else None
    return Balance(polygon, com_of(body, pose), wanted, PHASE_COLOURS.get(phase, SUSTAINED_ORANGE))


def _ghosts(world, row: int) -> dict[str, tuple[tuple[float, float, float], Pose]]:
    """The poses that a protecting character compares, with the thesis's colours; nothing at other times."""
    if Phase(int(world[Reaction].phase[row])) not in PROTECTING:
        return {}
    s = world[Sustained]
    return {
        "clip": (CLIP_BLUE, clip_pose(world, row, clip_time_s(world, row, world.tick))),
        "rules": (RULES_YELLOW, Pose(s.rules_root_m[row].copy(), s.rules_rotations[row].copy())),
        "sustained": (SUSTAINED_ORANGE, Pose(s.root_m[row].copy(), s.rotations[row].copy())),
    }


def _balls(world, alpha: float) -> list[Ball]:
    f, kinds = world[Flight], tuple(KINDS)
    return [
        Ball(
            (1.0 - alpha) * f.before_m[row] + alpha * f.position_m[row],
            float(f.radius_m[row]),
            rotations.slerp(f.before_turned[row], f.turned[row], alpha),
            kinds[f.kind[row]],
        )
        for row in world.rows(Flight)
    ]
