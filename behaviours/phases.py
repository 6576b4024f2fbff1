"""From one phase of the reaction (fig. 4.1) to the next, without a jump: what every change of phase does."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from behaviours.blends.blending import primary_support
from behaviours.components import COMPONENTS, Blend, Feet, Phase, Reaction, Script
from behaviours.playing import body_of
from behaviours.settle import seams
from behaviours.settle.settling import settled_pose
from behaviours.settle.sources import foot_goals, source_pose
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, Pose

STATE = tuple(kind for kind in COMPONENTS if kind is not Script)  # what a change of phase reads and writes


def enter(world, row: int, tick: int, phase: Phase) -> None:
    """Begins a phase now, and says so."""
    world[Reaction].phase[row] = phase
    world[Reaction].since[row] = tick
    world.emit("phase", world.entity(row), name=phase.name.lower())


@contextmanager
def keep_continuous(world, row: int, tick: int) -> Iterator[None]:
    """Around all that makes another source of poses take over at this tick: measures the seam between the two.

    What is shown goes on from where the old source was and as it moved. Both sources are asked for two moments: the old
    one before anything is changed, the new one when all of it is set up.
    """
    shown_before = Pose(*settled_pose(world, row, tick - 1 - seams.MOMENT))
    yield
    last, later = tick - 1, tick - 1 + seams.MOMENT
    pose, pose_later = source_pose(world, row, last), source_pose(world, row, later)
    goals, goals_later = foot_goals(world, row, last, pose), foot_goals(world, row, later, pose_later)
    source = seams.Moving(pose, pose_later, goals, goals_later)
    seams.begin_seam(world, row, tick, body_of(world, row), shown_before, source)


def set_blend(world, row: int, tick: int, start: Pose, end: Pose, ticks: float) -> None:
    """Sets the two ends of a blend that left its first end at the last tick; how the hands go is yet to be chosen."""
    b, f = world[Blend], world[Feet]
    b.from_root_m[row], b.from_rotations[row] = start
    b.to_root_m[row], b.to_rotations[row] = end
    b.since[row], b.ticks[row], b.lead_s[row] = tick - 1, ticks, 0.0
    body = body_of(world, row)
    positions, _ = joints_of(body, start)
    b.support[row] = primary_support(f.planted[row], positions[list(ANKLES)], com_of(body, start))
