"""`brace bench --motion`: how good the motion is, over seeded threats at real clips. Every figure has a bar to meet.

A case is a whole run: a clip, a moment of it, a threat from anywhere. It is measured by `behaviours.measures`;
threats to the head are thrown once more at somebody who sees nothing coming, and some cases once more in a mirror.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from behaviours.components import Phase
from behaviours.observing import Observer
from behaviours.scenario import Scenario, check_scenario
from behaviours.simulation import Simulation
from engine.clips.clip import Clip
from engine.clips.library import find_clip
from engine.core.errors import EnvironmentTrouble

# real clips, all of the library's and more where they lie beside the checkout
LIBRARY_CLIPS = ("walk", "stand", "dance", "hop", "run")
BESIDE = Path(__file__).resolve().parents[2].parent / "shared" / "mocap" / "asfamc"
CLIPS_BESIDE = {
    "fight": "14_02.amc", "run to a stop": "16_08.amc", "kick": "135_04.amc", "punch": "02_05.amc", "walk 2":
    "07_04.amc",
}  # fmt: skip
PERCEIVED_S = 0.15
AFTER_CONTACT_S = 1.1  # response and recovery, and a little of the clip again
EVERY_MIRRORED = 4
AHEAD_DEG = 60.0


class Case(NamedTuple):
    """One seeded threat at one clip."""

    number: int
    clip: str
    start_s: float
    startle: bool
    target: str
    azimuth_deg: float
    elevation_deg: float
    speed_mps: float
    size: float

    @property
    def frontal_head(self) -> bool:
        return self.target == "head" and abs(self.azimuth_deg) <= AHEAD_DEG

    def __str__(self) -> str:
        return (
            f"case {self.number}: {self.clip} at {self.start_s:.2f} s, {self.target} from {self.azimuth_deg:.0f} deg, "
            f"{self.elevation_deg:.0f} deg up, {self.speed_mps:.1f} m/s, size {self.size:.2f}"
            f"{', startle' if self.startle else ''}"
        )


def find_clips() -> dict[str, Clip]:
    """The clips to try, by name: those that are here. At least the library's, which `brace clips fetch` brings."""
    found = {}
    for name in LIBRARY_CLIPS:
        try:
            found[name] = find_clip(name)
        except EnvironmentTrouble:
            continue
    for name, file in CLIPS_BESIDE.items():
        if (BESIDE / file).is_file():
            found[name] = find_clip(str(BESIDE / file))
    return found


def make_cases(clips: dict[str, Clip], count: int, seed: int = 1) -> list[Case]:
    """Threats spread over the clips in turn: half of them from the front, seven in ten at the head."""
    chance, names = np.random.default_rng(seed), list(clips)
    cases = []
    for number in range(count):
        clip = clips[names[number % len(names)]]
        latest = clip.duration_s if clip.loops else max(0.1, clip.duration_s - 1.6)
        aside = AHEAD_DEG if number // len(names) % 2 == 0 else 180.0
        cases.append(Case(
            number, names[number % len(names)], float(chance.uniform(0.0, latest)), bool(chance.random() < 0.5),
            str(chance.choice(["head", "torso", "pelvis"], p=[0.7, 0.2, 0.1])), float(chance.uniform(-aside, aside)),
            float(chance.uniform(-5.0, 25.0)), float(chance.uniform(22.8, 29.7)), float(chance.random()),
        ))  # fmt: skip
    return cases


def scenario_of(case: Case, *, mirrored: bool = False, protects: bool = True) -> Scenario:
    """The case as a scenario; mirrored, or thrown at somebody who sees nothing coming."""
    longest_ttc_s = 1.4 * (0.25 + 0.75 * (29.7 - case.speed_mps) / (29.7 - 22.8))
    return check_scenario({
        "duration_s": PERCEIVED_S + longest_ttc_s + AFTER_CONTACT_S,
        "character": [{
            "clip": case.clip, "start_s": case.start_s, "startle": case.startle, "mirrored": mirrored,
            "protects": protects,
        }],
        "threat": [{
            "target": case.target, "perceived_s": PERCEIVED_S,
            "azimuth_deg": -case.azimuth_deg if mirrored else case.azimuth_deg,
            "elevation_deg": case.elevation_deg, "speed_mps": case.speed_mps, "size": case.size,
        }],
    })  # fmt: skip


def run_case(case: Case, clips: dict[str, Clip]) -> dict[str, Any]:
    """What came of it: the metrics of `brace react`, and the comparisons."""
    simulation = play(scenario_of(case), clips)
    report = simulation.report()
    track = simulation.watch.tracks[0]
    row = report["metrics"] | {"case": case, "finite": bool(np.isfinite(track.pose.rotations).all())}
    row["protect_ms"] = [1e3 * s for s in simulation.tick_s]
    if case.target == "head" and row["contact_error_s"] is not None:
        bare = play(scenario_of(case, protects=False), clips).report()["metrics"]
        row["bare_head_peak_g"], row["bare_first_contact"] = bare["head_peak_g"], bare["first_contact"]
    if case.number % EVERY_MIRRORED == 0 and abs(case.azimuth_deg) > 2.0:
        row["asymmetry_m"] = asymmetry_m(track, play(scenario_of(case, mirrored=True), clips).watch.tracks[0])
    return row


class Timed(Simulation):
    """A simulation that notes how long its ticks of protection took, without the observer's share."""

    def __init__(self, scenario: Scenario, find):
        super().__init__(scenario, find)
        self.watch = self.observer = Observer(self.world, self.world.assets.character_rows)
        self.tick_s: list[float] = []

    def step(self, world=None) -> None:
        begun = time.perf_counter()
        self.schedule.tick(self.world)
        passed_s = time.perf_counter() - begun
        self.watch.look(self.world)
        if self.watch.tracks[0].phase[-1] in (Phase.STARTLE, Phase.PROTECT):
            self.tick_s.append(passed_s)


def play(scenario: Scenario, clips: dict[str, Clip]) -> Timed:
    """The whole run."""
    simulation = Timed(scenario, lambda spec: clips[spec.clip])
    for _ in range(simulation.ticks):
        simulation.step()
    return simulation


def asymmetry_m(track, mirrored) -> float:
    """How far the joints of a run differ, up to contact, from those of its mirror image mirrored back."""
    from engine.body.kinematics import joints_of
    from engine.body.skeleton import MIRRORED

    ticks = next((k for k, phase in enumerate(track.phase) if phase == Phase.RESPOND), len(track.phase))
    ours = joints_of(track.body, track.pose)[0][:ticks]
    theirs = joints_of(mirrored.body, mirrored.pose)[0][:ticks, list(MIRRORED)] * [1.0, -1.0, 1.0]
    return float(np.abs(ours - theirs).max())


def bench(count: int, seed: int = 1, progress=iter) -> list[dict[str, Any]]:
    """All cases, run and measured."""
    clips = find_clips()
    return [run_case(case, clips) for case in progress(make_cases(clips, count, seed))]


def write_worst(rows: list[dict[str, Any]], folder: Path) -> list[Path]:
    """A filmstrip of the worst case of every figure, one picture a case."""
    from demos.benchmarks.motion_table import figures_of
    from demos.commands.capture import write_strip
    from demos.filming import CAMERAS, Shot
    from engine.render.context import make_context
    from engine.render.renderer import Renderer

    shot = Shot(size_px=(300, 380), camera=CAMERAS["quarter"])
    clips, written = find_clips(), {}
    with make_context(headless=True, size=shot.size_px) as context:
        renderer = Renderer(context)
        for figure in figures_of(rows):
            if figure.worst is None or figure.worst["case"].number in written:
                continue
            case = figure.worst["case"]
            simulation = Simulation(scenario_of(case), lambda spec: clips[spec.clip])
            words = "_".join(figure.name.replace("'", "").split(",")[0].split())
            path = folder / f"case_{case.number:03d}_{words}.png"
            write_strip(renderer, path, simulation, shot, frames=12)
            written[case.number] = path
    return list(written.values())
