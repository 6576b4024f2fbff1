"""What lies on the floor: the soft dark where something touches it, and the marks of the centre of mass."""

from __future__ import annotations

import moderngl
import numpy as np

from engine.body import skeleton as sk
from engine.render.gpu import SQUARE, Instances, make_pass
from engine.render.scene import Ball, Figure, Scene

CONTACT, COM_MARK, OPEN_RING = range(3)
CONTACT_COLOUR = (0.16, 0.18, 0.23)
LIFT_M = 0.0012  # over the floor, for marks that overlay each other in this order
MARK_RADIUS_M = 0.038

# half thickness over the joint's centre of what is drawn around it: at that height it touches
_JOINT_RADIUS_M = np.full(sk.JOINT_COUNT, 0.06)
_JOINT_RADIUS_M[[sk.PELVIS, sk.WAIST, sk.BACK]] = 0.11
_JOINT_RADIUS_M[[*sk.ANKLES]] = 0.085
_JOINT_RADIUS_M[[*sk.TOES, *sk.WRISTS]] = 0.03


class DecalPass:
    """Soft and round marks as instanced squares."""

    def __init__(self, gl):
        layout = (gl.buffer(SQUARE.tobytes()), "2f", "corner")
        attributes = ("place_m", "half_m", "colour", "kind")
        program = make_pass(gl, "decal")
        self.contacts, self.marks = (
            Instances(gl, [program], layout, "4f 2f 4f 1f", attributes, mode=moderngl.TRIANGLE_STRIP) for _ in range(2)
        )

    def upload(self, scene: Scene) -> None:
        contacts = [row for figure in scene.figures if figure.alpha >= 1.0 for row in figure_contacts(figure)]
        contacts += [row for ball in scene.balls if ball.alpha >= 1.0 for row in _ball_contact(ball)]
        contacts = contacts if scene.floor.shown else []  # nothing to fall on
        self.contacts.upload(np.array(contacts, "f4").reshape(-1, 11))
        self.marks.upload(np.array(_balance_marks(scene), "f4").reshape(-1, 11))

    def draw_contacts(self) -> None:
        self.contacts.draw()

    def draw_marks(self) -> None:
        self.marks.draw()


def figure_contacts(figure: Figure) -> list[tuple[float, ...]]:
    """A dark spot under each joint that is near the floor, and a faint wide one under the whole body."""
    rows = []
    gap_m = np.clip(figure.positions[:, 2] - _JOINT_RADIUS_M, 0.0, 3.0)
    strength = 0.42 * np.exp(-gap_m / 0.05)
    for joint in np.flatnonzero(strength > 0.01):
        x, y, _ = figure.positions[joint]
        spread = 0.075 + 0.5 * gap_m[joint] + 0.5 * _JOINT_RADIUS_M[joint]
        rows.append(_mark(x, y, 0.0, spread, spread, (*CONTACT_COLOUR, strength[joint]), CONTACT))
    x, y, z = figure.positions[sk.PELVIS]
    rows.append(
        _mark(x, y, 0.0, 0.62, 0.62, (*CONTACT_COLOUR, 0.16 * np.exp(-min(max(z - 0.9, 0.0), 20.0) / 0.8)), CONTACT)
    )
    return rows


def _ball_contact(ball: Ball) -> list[tuple[float, ...]]:
    x, y, z = np.asarray(ball.position_m, float)
    gap_m = min(max(z - ball.radius_m, 0.0), 20.0 * ball.radius_m)
    strength = 0.55 * np.exp(-gap_m / (0.9 * ball.radius_m))
    spread = 0.95 * ball.radius_m + 0.5 * gap_m
    return [_mark(x, y, 0.0, spread, spread, (*CONTACT_COLOUR, strength), CONTACT)] if strength > 0.01 else []


def _balance_marks(scene: Scene) -> list[tuple[float, ...]]:
    rows = []
    for balance in scene.balances:
        if balance.wanted_m is not None:
            x, y = np.asarray(balance.wanted_m, float)[:2]
            rows.append(
                _mark(
                    x,
                    y,
                    0.0,
                    1.45 * MARK_RADIUS_M,
                    1.45 * MARK_RADIUS_M,
                    (*balance.colour[:3], 1.0),
                    OPEN_RING,
                    level=2,
                )
            )
        if balance.com_m is not None:
            x, y = np.asarray(balance.com_m, float)[:2]
            rows.append(
                _mark(
                    x,
                    y,
                    0.0,
                    MARK_RADIUS_M,
                    MARK_RADIUS_M,
                    (*(0.55 * np.asarray(balance.colour[:3])), 1.0),
                    COM_MARK,
                    level=3,
                )
            )
    return rows


def _mark(x, y, heading, half_along, half_across, colour, kind, level: int = 0) -> tuple[float, ...]:
    return (x, y, LIFT_M * (1 + level), heading, half_along, half_across, *colour, kind)
