"""The cases of `brace bench --motion`: seeded threats at real clips, and a few people knocked off their feet."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from behaviours.scenario import check_scenario, check_threat
from behaviours.scenario_spec import Scenario
from behaviours.timing import TICK_S
from engine.clips.clip import Clip
from engine.clips.library import LIBRARY, find_clip
from engine.core.errors import EnvironmentTrouble

# real clips: the library's, and more where they lie beside the checkout
LIBRARY_CLIPS = ("walk", "stand", "dance", "hop", "run")
BESIDE = Path(__file__).resolve().parents[2].parent / "shared" / "mocap" / "asfamc"
CLIPS_BESIDE = {
    "fight": "14_02.amc",
    "run to a stop": "16_08.amc",
    "kick": "135_04.amc",
    "punch": "02_05.amc",
    "walk 2": "07_04.amc",
}
INSTEAD = {"fight": "punch", "kick": "kick"}  # clips of `brace clips fetch --extra`, where those are not there
WANTED = ("walk", "stand", "fight", "dance", "run to a stop")  # these at least, of six
GET_UPS = ("getup_faceup", "getup_facedown")

PERCEIVED_S = 0.15
AFTER_CONTACT_S = 1.1  # response and recovery, and a little of the clip again
AFTER_FALL_S = 6.5  # to fall, to lie still, to get up and to stand
NEW_ONE_IN = 4  # rounds of the clips in which a new motion is searched for
AHEAD_DEG = 60.0


class Release(NamedTuple):
    """A ball as it comes into the world."""

    tick: int
    position_m: tuple[float, float, float]
    velocity_mps: tuple[float, float, float]


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
    recover: str = "same"
    mass_kg: float | None = None  # of something heavy, that knocks people down; None: a volleyball

    @property
    def frontal_head(self) -> bool:
        return self.target == "head" and abs(self.azimuth_deg) <= AHEAD_DEG

    @property
    def knocks_down(self) -> bool:
        return self.mass_kg is not None

    def __str__(self) -> str:
        at = f"case {self.number}: {self.clip} at {self.start_s:.2f} s"
        extras = [f"{self.mass_kg:.0f} kg"] if self.mass_kg is not None else []
        extras += ["startle"] * self.startle + [f"recover {self.recover}"] * (self.recover != "same")
        return ", ".join([
            at, f"{self.target} from {self.azimuth_deg:.0f} deg", f"{self.elevation_deg:.0f} deg up",
            f"{self.speed_mps:.1f} m/s", f"size {self.size:.2f}", *extras,
        ])  # fmt: skip


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
        elif name in INSTEAD and INSTEAD[name] in ready_names():
            found[name] = find_clip(INSTEAD[name])
    if not found:
        raise EnvironmentTrouble("clip-not-fetched", "no real clip is here; `brace clips fetch` brings some")
    return found


def where_from(clips: dict[str, Clip]) -> str:
    """A line that says which clips were found and where, and what is missing of those that are wanted."""
    beside = [name for name in clips if (BESIDE / CLIPS_BESIDE.get(name, "")).is_file()]
    fetched = [name for name in clips if name not in beside]
    words = f"clips: {', '.join(fetched) or 'none'} (fetched)"
    words += f"; {', '.join(beside)} (CMU files beside the checkout)" if beside else "; none beside the checkout"
    missing = [name for name in WANTED if name not in clips]
    return words + (f"; MISSING: {', '.join(missing)}" if missing else "")


def get_ups_here() -> bool:
    """Whether there is a motion that gets up."""
    return any(name in ready_names() for name in GET_UPS)


def ready_names() -> list[str]:
    """The clips of the library that are here."""
    return [listed.name for listed in LIBRARY if listed.ready]


def make_cases(clips: dict[str, Clip], count: int, seed: int = 1) -> list[Case]:
    """Threats spread over the clips in turn: half of them from the front, seven in ten at the head."""
    chance, names = np.random.default_rng(seed), list(clips)
    cases = []
    for number in range(count):
        clip, turn = clips[names[number % len(names)]], number // len(names)
        latest = clip.duration_s if clip.loops else max(0.1, clip.duration_s - 1.6)
        aside = AHEAD_DEG if turn % 2 == 0 else 180.0
        cases.append(Case(
            number, names[number % len(names)], float(chance.uniform(0.0, latest)), bool(chance.random() < 0.5),
            str(chance.choice(["head", "torso", "pelvis"], p=[0.7, 0.2, 0.1])), float(chance.uniform(-aside, aside)),
            float(chance.uniform(-5.0, 25.0)), float(chance.uniform(22.8, 29.7)), float(chance.random()),
            "new" if turn % NEW_ONE_IN == NEW_ONE_IN - 1 else "same",
        ))  # fmt: skip
    return cases


def make_knock_downs(clips: dict[str, Clip], count: int, seed: int = 1) -> list[Case]:
    """Heavy things at the trunk, from ahead or behind, which nobody stands: for the way down, and up again."""
    chance, names = np.random.default_rng(seed + 1000), list(clips)
    cases = []
    for number in range(count):
        clip = clips[names[number % len(names)]]
        behind = 180.0 if number % 2 else 0.0
        cases.append(Case(
            number, names[number % len(names)], float(chance.uniform(0.0, 0.5 * clip.duration_s)), False, "torso",
            float(chance.uniform(-40.0, 40.0)) + behind, float(chance.uniform(0.0, 15.0)),
            float(chance.uniform(14.0, 18.0)), 0.9, "new", float(chance.uniform(10.0, 16.0)),
        ))  # fmt: skip
    return cases


def scenario_of(case: Case, *, mirrored: bool = False, protects: bool = True) -> Scenario:
    """The case as a scenario; mirrored, or with the threat to somebody who sees nothing coming, who is met as well."""
    threat: dict[str, Any] = {
        "target": case.target, "perceived_s": PERCEIVED_S,
        "azimuth_deg": -case.azimuth_deg if mirrored else case.azimuth_deg,
        "elevation_deg": case.elevation_deg, "speed_mps": case.speed_mps, "size": case.size,
    }  # fmt: skip
    if case.knocks_down:
        heavy = {"kind": "custom", "mass_kg": case.mass_kg, "radius_m": 0.2, "speed_range_mps": [8.0, 20.0]}
        threat |= heavy | {"ttc_s": 0.6}
        duration_s = PERCEIVED_S + 0.6 + AFTER_FALL_S
    else:
        longest_ttc_s = 1.4 * (0.25 + 0.75 * (29.7 - case.speed_mps) / (29.7 - 22.8))
        duration_s = PERCEIVED_S + longest_ttc_s + AFTER_CONTACT_S
    return check_scenario({
        "duration_s": round(duration_s / TICK_S) * TICK_S,
        "character": [{
            "clip": case.clip, "start_s": case.start_s, "startle": case.startle, "mirrored": mirrored,
            "protects": protects, "recover": case.recover if protects else "same",
        }],
        "threat": [threat],
    })  # fmt: skip


def same_ball(case: Case, release: Release) -> Scenario:
    """The very ball of a case, on the very path, past or into somebody who sees nothing coming."""
    scenario = scenario_of(case, protects=False)
    (threat,) = scenario.threat
    thrown = {
        "free": True, "target": threat.target, "size": threat.size, "released_s": release.tick * TICK_S,
        "position_m": release.position_m, "velocity_mps": release.velocity_mps,
    }  # fmt: skip
    return scenario.model_copy(update={"threat": (check_threat(thrown),)})
