"""A scenario, run to its end, with every tick kept: what filmstrips are cut from."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from behaviours.components import Feet, Flight, Phase, Posture, Reaction, Sustained
from behaviours.perceive.threats import KINDS
from behaviours.playing import body_of, clip_of, clip_pose, clip_time_s
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation
from behaviours.timing import TICK_S
from demos.figures.meeting import posed
from demos.figures.press import Press
from engine.body.skeleton import Body, Pose
from engine.core.errors import BadInput
from engine.render.scene import (
    BLEND_GREY,
    CLIP_BLUE,
    SIMULATED_RED,
    SUSTAINED_ORANGE,
    Ball,
    Colour,
    Scene,
)

COLOURS: dict[Phase, Colour] = {
    Phase.PLAY: CLIP_BLUE,
    Phase.HOLD: SUSTAINED_ORANGE,
    Phase.RESPOND: SIMULATED_RED,
    Phase.DOWN: SIMULATED_RED,
}
LEGEND = (
    (CLIP_BLUE, "clip"), (BLEND_GREY, "blends"), (SUSTAINED_ORANGE, "sustained pose"), (SIMULATED_RED, "simulated"),
)  # fmt: skip


class Frame(NamedTuple):
    """One tick of a run, as it was shown."""

    time_s: float
    phase: Phase
    pose: Pose
    planted: np.ndarray  # (2,)
    balls: list[Ball]
    clip: str  # that is played, or was


class Take(NamedTuple):
    """A run."""

    body: Body
    frames: list[Frame]
    perceived: int  # tick at which the reaction begins
    contact: int  # tick of the first touch
    clip: Pose  # the poses of the thesis at the last tick before the touch
    rules: Pose
    sustained: Pose
    wanted_m: np.ndarray

    def colour(self, tick: int) -> Colour:
        """The thesis's colour of what is shown: orange for the sustained pose, reached just before the touch."""
        if tick == self.contact - 1:
            return SUSTAINED_ORANGE
        return COLOURS.get(self.frames[tick].phase, BLEND_GREY)

    def scene(self, tick: int, about_m) -> Scene:
        """One tick, with a point of the ground (2,) over the origin."""
        frame, colour = self.frames[tick], self.colour(tick)
        pose = Pose(frame.pose.root_m - (*about_m[:2], 0.0), frame.pose.rotations)
        scene = Scene([posed(self.body, pose, colour)])
        scene.balls = [
            replace(ball, position_m=np.subtract(ball.position_m, (*about_m[:2], 0.0))) for ball in frame.balls
        ]
        return scene


def take(press: Press, scenario: dict[str, Any]) -> Take:
    """Runs a scenario given as plain data (see `behaviours.scenario`). Clips that are missing are stood in for.

    BadInput where nothing is touched: a filmstrip is told from the contact on.
    """
    checked = check_scenario({"version": 1, **scenario}, "figure")
    simulation = Simulation(checked, lambda spec: press.clip(spec.clip))
    world = simulation.world
    frames: list[Frame] = []
    stages, contact = None, None
    for tick in range(simulation.ticks):
        simulation.step()
        frames.append(_frame(world, tick))
        phase = frames[-1].phase
        if phase in (Phase.PROTECT, Phase.STARTLE):
            stages = _stages(world, tick)
        if contact is None and phase in (Phase.RESPOND, Phase.DOWN):
            contact = tick
    if contact is None:
        raise BadInput("figure", "the threat of its scenario touches nobody")
    perceived = next((tick for tick, frame in enumerate(frames) if frame.phase != Phase.PLAY), 0)
    return Take(body_of(world, 0), frames, perceived, contact, *(stages or _stages(world, 0)))


def _frame(world, tick: int) -> Frame:
    p, f = world[Posture], world[Flight]
    balls = [
        Ball(f.position_m[k].copy(), float(f.radius_m[k]), f.turned[k].copy(), tuple(KINDS)[f.kind[k]])
        for k in world.rows(Flight)
    ]
    return Frame(
        tick * TICK_S,
        Phase(int(world[Reaction].phase[0])),
        Pose(p.root_m[0].copy(), p.rotations[0].copy()),
        world[Feet].planted[0].copy(),
        balls,
        clip_of(world, 0).name,
    )


def _stages(world, tick: int) -> tuple[Pose, Pose, Pose, np.ndarray]:
    s = world[Sustained]
    return (
        clip_pose(world, 0, clip_time_s(world, 0, tick)),
        Pose(s.rules_root_m[0].copy(), s.rules_rotations[0].copy()),
        Pose(s.root_m[0].copy(), s.rotations[0].copy()),
        s.com_wanted_m[0].copy(),
    )
