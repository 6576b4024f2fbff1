"""One case of `brace bench --motion`, run and measured: a dict of plain values, so that any process can do it."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from behaviours.components import Flight, Phase, Reaction, Sustained
from behaviours.measure import measures
from behaviours.measure.head_measures import head_acceleration_g
from behaviours.measure.observing import HandWay, Observer, Track
from behaviours.scenario_spec import CharacterSpec, Scenario
from behaviours.simulation import Simulation
from behaviours.timing import TICK_S
from demos.benchmarks.motion_cases import Case, Release, same_ball, scenario_of
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import MIRRORED, Pose
from engine.clips.clip import Clip
from engine.clips.library import find_clip
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.physics import impact

EVERY_MIRRORED = 4
DEAD_AHEAD_DEG = 2.0  # left out of the comparison with the mirror image: there a side is chosen
PROTECTING = (Phase.STARTLE, Phase.PROTECT)
RECOVERING = (Phase.RECOVER_BLEND, Phase.RECOVER_RETURN)
LONGEST_FLIGHT_TICKS = 240
OFF_LINE = (HandWay.BOWED, HandWay.LED)

Row = dict[str, Any]


class Timed(Simulation):
    """An observed simulation that notes what its ticks of protection took of the processor, without the observer."""

    def __init__(self, scenario: Scenario, clips: dict[str, Clip]):
        def find(spec: CharacterSpec) -> Clip:
            return clips[spec.clip] if spec.clip in clips else find_clip(spec.clip)

        super().__init__(scenario, find)
        self.observer: Observer = Observer(self.world, self.world.assets.character_rows)
        self.tick_s: list[float] = []
        self.promised_s: float | None = None  # when the sustained pose, once it is known, is to be touched
        self.release: Release | None = None  # of the first ball

    @property
    def track(self) -> Track:
        return self.observer.tracks[0]

    def step(self, world=None) -> None:
        begun = time.thread_time()
        self.schedule.tick(self.world)
        passed_s = time.thread_time() - begun
        self.observer.look(self.world)
        if self.release is None:
            self.release = released(self.world)
        if self.track.phase[-1] in PROTECTING:
            self.tick_s.append(passed_s)
            if self.promised_s is None:
                self.promised_s = promised_contact_s(self.world)

    def events(self, *kinds: str) -> list[dict[str, Any]]:
        return [
            {"tick": event.tick, "kind": event.kind, **event.data} for event in self.world.events if event.kind in kinds
        ]


def released(world) -> Release | None:
    """The first ball, in the tick that it comes in."""
    f, balls = world[Flight], world.rows(Flight)
    if len(balls) == 0:
        return None
    at, mps = f.position_m[balls[0]].tolist(), f.velocity_mps[balls[0]].tolist()
    return Release(world.tick - 1, (at[0], at[1], at[2]), (mps[0], mps[1], mps[2]))


def promised_contact_s(world) -> float | None:
    """When the ball that is guarded against would first touch the sustained pose, standing still in its way."""
    threat, capsules = int(world[Reaction].threat[0]), world.assets.capsules[0]
    if not world.alive(threat):
        return None
    f, s, ball = world[Flight], world[Sustained], world.row(threat)
    pose = joints_of(world.assets.bodies[0], Pose(s.root_m[0], s.rotations[0]))
    at, mps = tuple(f.position_m[ball]), tuple(f.velocity_mps[ball])
    for tick in range(world.tick, world.tick + LONGEST_FLIGHT_TICKS):
        before, (at, mps) = at, fly(at, mps, GRAVITY_MPS2, float(f.drag_per_m[ball]), TICK_S)
        hit = impact.first_hit(capsules, pose, pose, before, at, float(f.radius_m[ball]))
        if hit is not None:
            return (tick - 1 + hit.share) * TICK_S
    return None


def play(scenario: Scenario, clips: dict[str, Clip]) -> Timed:
    """The whole run."""
    simulation = Timed(scenario, clips)
    for _ in range(simulation.ticks):
        simulation.step()
    return simulation


def run_case(case: Case, clips: dict[str, Clip]) -> Row:
    """What came of it: the metrics of `brace react`, what they were taken from, and the comparisons."""
    simulation = play(scenario_of(case), clips)
    row = simulation.report()["metrics"] | {"case": case} | more_of(simulation)
    row["protect_ms"] = [1e3 * s for s in simulation.tick_s]
    if case.knocks_down:
        return row | fall_of(simulation)
    touched = simulation.events("contact", "touch")
    row["first_contact"] = touched[0]["part"] if touched else None
    row["contact_error_s"] = touched[0]["late_s"] if touched else None
    met = touched and simulation.promised_s is not None
    row["promise_error_s"] = touched[0]["at_s"] - simulation.promised_s if met else None
    if case.target == "head" and simulation.release:
        row["bare_head_peak_g"] = head_peak_g(play(scenario_of(case, protects=False), clips))
        row["passed_head_peak_g"] = head_peak_g(play(same_ball(case, simulation.release), clips))
    if case.number % EVERY_MIRRORED == 0 and abs(case.azimuth_deg) > DEAD_AHEAD_DEG:
        row["asymmetry_m"] = asymmetry_m(simulation.track, play(scenario_of(case, mirrored=True), clips).track)
    return row


def more_of(simulation: Timed) -> Row:
    """What the bench wants beyond the metrics: by phase, and how much there was to measure."""
    track = simulation.track
    phases = np.array(track.phase)
    flagged = np.array(track.planted) & measures.ours(track)[:, None]
    settling = measures.settling_feet(track)
    after_blow = np.isin(phases, RECOVERING)[:, None]
    return {
        "limit_by_phase": measures.joint_limit_excess(track),
        "overlap_by_phase": measures.overlap(track),
        "seams": len(track.seams),
        "seam_by_phase": seams_by_phase(track),
        "snap": measures.snap(track),
        "snap_phase": Phase(track.phase[track.tick.index(measures.snap(track).tick)]).name.lower(),
        "fastest": measures.fastest_in_physics(track),
        "foot_ticks": int(flagged.sum()),
        "settling_foot_ticks": int(settling.sum()),
        "settling_before_m": measures.drift_max_m(track, settling & ~after_blow),
        "settling_after_m": measures.drift_max_m(track, settling & after_blow),
        "hand_frames": measures.hand_frames(track.lines),
        "led_astray_m": measures.hand_line_deviation_max_m(track.lines, OFF_LINE),
        "neck_line_m": measures.neck_line_deviation_max_m(track.lines),
        "line_ticks": len(track.lines),
        "two_sequences_ticks": int(np.equal(phases, Phase.RECOVER_BLEND).sum()),
        "reacting_ticks": int(measures.reacting(track).sum()),
        "searched": simulation.events("searched", "stays_down", "went_on"),
        "finite": bool(np.isfinite(track.pose.rotations).all() and np.isfinite(track.pose.root_m).all()),
    }


def seams_by_phase(track: Track) -> dict[str, tuple[measures.Worst, measures.Worst]]:
    """The greatest jumps of place and velocity at the seams into each phase."""
    worst: dict[str, tuple[measures.Worst, measures.Worst]] = {}
    for seam in track.seams:
        name, jumps = seam.into.name.lower(), measures.jump_of(seam)
        before = worst.get(name, jumps)
        worst[name] = (max(before[0], jumps[0]), max(before[1], jumps[1]))
    return worst


def fall_of(simulation: Timed) -> Row:
    """How a fall went: whether there was one, how still the body came to lie, and whether it got up again."""
    track = simulation.track
    phases = np.array(track.phase)
    down = np.flatnonzero(np.equal(phases, Phase.DOWN))
    rises = [event for event in simulation.events("searched") if event["chosen"] == "get_up"]
    com_m = com_of(track.body, track.pose)[:, 2]
    row: Row = {"fell": len(down) > 0, "got_up": bool(rises), "stands_again": False, "lies_mps": None, "lowest_m": None}
    row["rises_m"] = float(com_m.max() - com_m[0])
    if len(down) == 0:
        return row
    joints_m = joints_of(track.body, track.pose)[0]
    last = joints_m[max(down[0], down[-1] - 12) : down[-1] + 1]
    if len(last) > 1:
        row["lies_mps"] = float(np.linalg.norm(np.diff(last, axis=0), axis=2).max()) * 120.0
    row["lowest_m"] = float(joints_m[down, :, 2].min())
    row["stands_again"] = bool(rises) and bool(joints_m[-1, 0, 2] > 0.8 * joints_m[0, 0, 2])
    return row


def head_peak_g(simulation: Timed) -> float | None:
    """The head's greatest acceleration, g; None of somebody who was not struck."""
    head_g = head_acceleration_g(simulation.track)
    return float(head_g.max()) if len(head_g) else None


def asymmetry_m(track: Track, mirrored: Track) -> float:
    """How far the joints of a run differ, up to contact, from those of its mirror image mirrored back; infinite where
    the phases are not even the same.
    """
    ticks = next((k for k, phase in enumerate(track.phase) if phase == Phase.RESPOND), len(track.phase))
    if track.phase[: ticks + 1] != mirrored.phase[: ticks + 1]:
        return float("inf")
    ours = joints_of(track.body, track.pose)[0][:ticks]
    theirs = joints_of(mirrored.body, mirrored.pose)[0][:ticks, list(MIRRORED)] * [1.0, -1.0, 1.0]
    return float(np.abs(ours - theirs).max())
