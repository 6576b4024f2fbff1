"""What the switches of the View panel add to the picture: paths of balls, forces in limbs, words beside things."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from behaviours.components import Character, Flight, Threat
from behaviours.playing import body_of
from demos.stage import standing
from engine.body.skeleton import ANKLES, NECK, SHOULDERS
from engine.core.clock import TICK_S
from engine.core.debug_draw import DebugDraw
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.render.scene import Scene

if TYPE_CHECKING:
    from demos.window.session import Session

PATH = (0.72, 0.20, 0.16, 0.9)
FORCE = (0.13, 0.46, 0.38, 0.95)
GROUND_FORCE = (0.24, 0.43, 0.62, 0.95)
WORDS = (0.20, 0.23, 0.28, 1.0)
LIMB_M_PER_N, GROUND_M_PER_N = 1.0 / 250.0, 1.0 / 1600.0  # arrows' lengths
LEAST_N = 8.0  # a smaller force is not drawn
LONGEST_M = 1.2
PATH_STEPS = 40
# each limb: from its first joint to its last of the skeleton's table
LIMBS = {"left arm": (6, 8), "right arm": (10, 12), "head": (3, 4), "left leg": (13, 16), "right leg": (17, 20)}


def draw_marks(scene: Scene, session: Session) -> None:
    """Adds what is switched on, and takes away of the balance what is switched off."""
    view = session.view
    scene.draw = scene.draw or DebugDraw()
    scene.balances = [
        replace(
            balance,
            support_m=balance.support_m if view.support else balance.support_m[:0],
            com_m=balance.com_m if view.com else None,
            wanted_m=balance.wanted_m if view.com else None,
        )
        for balance in scene.balances
    ]
    if view.path:
        _draw_paths(scene.draw, session)
    if view.forces:
        for row in session.world.rows(Character):
            _draw_forces(scene.draw, session, int(row))
    if view.labels:
        _draw_labels(scene, session)


def _draw_paths(draw: DebugDraw, session: Session) -> None:
    """Of every ball that has been noticed and may still hit: how it flies until the contact that is expected."""
    world = session.world
    f, t = world[Flight], world[Threat]
    for row in world.rows(Flight, Threat):
        if not t.noticed[row] or t.spent[row] or t.strayed[row]:
            continue
        path = predicted_path(f, int(row), max(float(t.contact[row] - world.tick), 0.0) * TICK_S)
        for start, end in zip(path[:-1:2], path[1::2], strict=False):  # dashes
            draw.line(start, end, PATH, "path")
        draw.point(path[-1], 0.03, PATH, "path")


def predicted_path(flight, row: int, ahead_s: float) -> np.ndarray:
    """(N, 3) by the very function that the ball flies by."""
    p, v, drag = tuple(flight.position_m[row]), tuple(flight.velocity_mps[row]), float(flight.drag_per_m[row])
    moments = np.linspace(0.0, ahead_s, PATH_STEPS)
    return np.array([fly(p, v, GRAVITY_MPS2, drag, float(moment))[0] for moment in moments])


def limb_forces_N(body, part_forces_N: np.ndarray) -> dict[str, np.ndarray]:
    """(3,) a limb: what its first joint, and whatever it touches, do to it together."""
    joint = body.part_joint
    return {
        name: part_forces_N[(joint >= first) & (joint <= last)].sum(axis=0) for name, (first, last) in LIMBS.items()
    }


def _draw_forces(draw: DebugDraw, session: Session, row: int) -> None:
    """At the shoulders and the neck what moves arms and head; under the feet what carries the whole body."""
    world, body = session.world, body_of(session.world, row)
    parts_N = session.run.history.forces_N(row, world.tick, body.part_mass_kg)
    if parts_N is None:
        return
    joints_m = session.joints_m(row)
    at = {"left arm": SHOULDERS[0], "right arm": SHOULDERS[1], "head": NECK}
    forces = limb_forces_N(body, parts_N)
    for name, joint in at.items():
        _arrow(draw, joints_m[joint], forces[name], LIMB_M_PER_N, FORCE, session.view.labels)
    feet = [ANKLES[side] for side in np.flatnonzero(standing(world, row, body, *session.frames(row)))]
    if feet:
        place = joints_m[feet].mean(axis=0) * (1.0, 1.0, 0.0)
        _arrow(draw, place, parts_N.sum(axis=0), GROUND_M_PER_N, GROUND_FORCE, session.view.labels)


def _arrow(draw: DebugDraw, place: np.ndarray, force_N: np.ndarray, m_per_N: float, colour, words: bool) -> None:
    size_N = float(np.sqrt(np.sum(force_N * force_N)))
    if size_N < LEAST_N:
        return
    tip = place + force_N * (min(size_N * m_per_N, LONGEST_M) / size_N)
    draw.arrow(place, tip, colour, "forces")
    if words:
        draw.label(tip, f"{size_N:.0f} N", colour, "forces")


def _draw_labels(scene: Scene, session: Session) -> None:
    """Speeds of balls, how long until contact, what a character is about."""
    world = session.world
    f, t = world[Flight], world[Threat]
    assert scene.draw is not None
    for row in world.rows(Flight, Threat):
        speed = float(np.sqrt(np.sum(f.velocity_mps[row] ** 2)))
        left_s = (t.contact[row] - world.tick) * TICK_S
        coming = t.noticed[row] and not t.spent[row] and left_s >= 0.0
        words = f"{speed:.0f} m/s" + (f", {left_s:.2f} s" if coming else "")
        scene.draw.label(f.position_m[row] + (0.0, 0.0, 0.16), words, WORDS, "labels")
    for row in world.rows(Character):
        head = session.joints_m(int(row))[4] + (0.0, 0.0, 0.36)
        scene.draw.label(head, session.doing(int(row)), WORDS, "labels")
