"""The figures of the sustained pose over real frames: restarts, the cases of fig. 3.10, feet, joint limits, arms.

    bars = pose_bars(cases=200, seed=1)
    print("\\n".join(lines_of(bars)))

A case is a clip at a moment and a scripted threat from anywhere, posed as `brace pose` poses it; nothing moves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.protect.balance_search import solve
from behaviours.protect.pose_report import PoseCase, PosedCase, pose_case
from behaviours.protect.sustained import Case
from behaviours.protect.task import new_posed
from behaviours.protect.total_error import FORMS
from behaviours.settings import Settings
from engine.body.footing import leg_length_m, sole_depth_m
from engine.body.kinematics import joints_of
from engine.body.limits import excess_beyond_rad
from engine.body.overlap import overlaps_m, pair_name
from engine.body.skeleton import HIPS, JOINTS, Body, Pose
from engine.clips.clip import Clip

AHEAD_DEG = 75.0  # half of the threats come from within this
RESTARTS = 3  # a case
RESTART_SPREAD = np.array([0.03] * 3 + [0.1] * 7)  # metres of the pelvis, then controls: standard deviations
BETTER_SHARE = 0.01  # a restart that gains more than this of the total error counts
NOWHERE = "none"


class PoseBars(NamedTuple):
    """What came out over all cases. The words name the worst case, or "none"."""

    cases: int
    restarts: int  # perturbed, over all cases
    restarts_improved: int  # by more than 1 % of the total error
    poses_improved: int  # cases with at least one such restart
    worst_restart: str
    cases_by_name: dict[str, int]  # fig. 3.10, see sustained.Case
    feet_off_floor: int  # of twice as many feet as there are cases
    feet_off_because_hip_high: int  # with the sole out of the leg's reach from where the rules leave the hip
    worst_foot: str  # a foot that is off the floor for no such reason
    worst_limit_excess_deg: float  # beyond the limits and beyond the clip's own excess
    worst_limit: str
    over_limits: int  # cases beyond by more than half a degree
    worst_arm_depth_mm: float  # hands and forearms in head, trunk or each other
    worst_arm: str
    arms_inside: int  # cases deeper than 5 mm
    worst_com_m: float  # COM off where it is wanted, of those with a foot on the ground
    worst_com: str

    @property
    def restarts_share(self) -> float:
        """Of the poses, those that no perturbed restart improves."""
        return 1.0 - self.poses_improved / max(self.cases, 1)


class _Worst:
    """The greatest value so far, and the words that go with it."""

    def __init__(self, least: float = 0.0):
        self.value, self.words, self.least = least, NOWHERE, least

    def see(self, value: float, words: str) -> None:
        if value > self.value:
            self.value, self.words = float(value), words


def pose_cases(clips: dict[str, Clip], count: int, seed: int) -> list[tuple[str, PoseCase]]:
    """(clip, case): threats spread over the clips in turn, half of them from the front, from any height."""
    chance, names = np.random.default_rng(seed), list(clips)
    cases = []
    for number in range(count):
        name = names[number % len(names)]
        latest_s = max(0.2, clips[name].duration_s - 0.3)
        aside = AHEAD_DEG if number // len(names) % 2 == 0 else 180.0
        cases.append((name, PoseCase(
            float(chance.uniform(0.1, latest_s)), float(chance.uniform(-aside, aside)), float(chance.uniform(-5, 25)),
            float(chance.uniform(22.8, 29.7)), float(chance.random()),
            str(chance.choice(["head", "torso", "pelvis"], p=[0.7, 0.2, 0.1])),
        )))  # fmt: skip
    return cases


def words_of(name: str, case: PoseCase) -> str:
    """A case as `brace pose` takes it."""
    return (
        f"{name} at {case.at_s:.2f} s, {case.target} from {case.azimuth_deg:.0f} deg, {case.elevation_deg:.0f} deg up, "
        f"{case.speed_mps:.1f} m/s, size {case.size:.2f}"
    )


def pose_bars(cases: int, seed: int, clips: dict[str, Clip] | None = None, progress=iter) -> PoseBars:
    """Poses that many seeded cases at real clips (those of `brace bench --motion` unless given) and measures them."""
    if clips is None:
        from demos.benchmarks.motion_cases import find_clips

        clips = find_clips()
    settings, chance = Settings(), np.random.default_rng(seed + 1)
    by_name = {case.name.lower(): 0 for case in Case}
    limit, arm, com, restart = _Worst(), _Worst(), _Worst(), _Worst()
    improved = poses_improved = restarts = off = off_high = over = inside = 0
    foot = NOWHERE
    chosen = pose_cases(clips, cases, seed)
    for name, case in progress(chosen):
        posed, words = pose_case(clips[name], case, settings), words_of(name, case)
        found = posed.protection
        by_name[found.case.name.lower()] += 1
        excess_deg, joint = limit_excess(posed, found.sustained)
        limit.see(excess_deg, f"{joint}: {words}")
        over += excess_deg > 0.5
        depth_mm, pair = arm_depth(posed.body, found.sustained)
        arm.see(depth_mm, f"{pair}: {words}")
        inside += depth_mm > 5.0
        for side in range(2):
            if not found.feet.held[side]:
                off += 1
                high = hip_is_high(posed, side, settings)
                off_high += high
                foot = foot if high else words
        if found.case == Case.AIRBORNE:
            continue
        com.see(float(np.sqrt(np.sum((found.com_m[:2] - found.com_wanted_m) ** 2))), words)
        gains = restart_gains(posed, settings, chance)
        restarts += len(gains)
        improved += int(np.sum(gains > BETTER_SHARE))
        poses_improved += bool(np.any(gains > BETTER_SHARE))
        restart.see(float(gains.max()), f"{100 * gains.max():.1f} %: {words}")
    return PoseBars(
        len(chosen), restarts, improved, poses_improved, restart.words, by_name, off, off_high, foot,
        limit.value, limit.words, over, arm.value, arm.words, inside, com.value, com.words,
    )  # fmt: skip


def limit_excess(posed: PosedCase, pose: Pose) -> tuple[float, str]:
    """How far a pose's worst joint is beyond its limits, degrees, and which; the clip's own excess does not count.

    The clip is the pose at perception; for what is taken from the look-ahead, pelvis and lifted legs, that one's.
    """
    own = [excess_beyond_rad(posed.body, pose.rotations, clip.rotations) for clip in (posed.clip, posed.ahead)]
    excess = np.degrees(np.minimum(*own))
    return float(excess.max()), JOINTS[int(excess.argmax())]


def arm_depth(body: Body, pose: Pose) -> tuple[float, str]:
    """How deep a hand or forearm lies in head, trunk or the other arm, millimetres, at most; and which in what."""
    depths = overlaps_m(body, Pose(pose.root_m[None], pose.rotations[None]))[0]
    return 1e3 * float(depths.max()), pair_name(int(depths.argmax()))


def hip_is_high(posed: PosedCase, side: int, settings: Settings) -> bool:
    """Whether the floor is farther below a hip, as the rules leave it, than the leg with its foot is long."""
    positions, _ = joints_of(posed.body, posed.protection.rules)
    reach_m = settings.balance.leg_share * leg_length_m(posed.body, side)
    return bool(positions[HIPS[side], 2] - sole_depth_m(posed.body, side) > reach_m)


def restart_gains(posed: PosedCase, settings: Settings, chance: np.random.Generator) -> np.ndarray:
    """(RESTARTS,) by what share of the total error searches from perturbed starts end lower than the usual one."""
    found, scratch = posed.protection, new_posed()
    form = FORMS.index(settings.objective.form)
    start = np.concatenate([np.zeros(3), found.controls_initial])

    def ends_at(begin: np.ndarray) -> float:
        return solve(found.task, found.reference, form, begin, scratch, settings)[0].value

    usual = ends_at(start)
    spread = chance.normal(0.0, 1.0, (RESTARTS, len(start))) * RESTART_SPREAD
    return np.array([1.0 - ends_at(start + row) / max(usual, 1e-12) for row in spread])


def lines_of(bars: PoseBars) -> list[str]:
    """The figures as text, a line each."""
    named = ", ".join(f"{count} {name}" for name, count in bars.cases_by_name.items())
    return [
        f"{bars.cases} sustained poses: {named}",
        f"no perturbed restart over 1 % better: {100 * bars.restarts_share:.1f} % of poses "
        f"({bars.restarts_improved} of {bars.restarts} restarts; best {bars.worst_restart})",
        f"feet off the floor: {bars.feet_off_floor}, {bars.feet_off_because_hip_high} with the hip too high "
        f"(else: {bars.worst_foot})",
        f"beyond joint limits: {bars.worst_limit_excess_deg:.2f} degrees, {bars.over_limits} over 0.5 "
        f"({bars.worst_limit})",
        f"arms inside: {bars.worst_arm_depth_mm:.1f} mm, {bars.arms_inside} over 5 ({bars.worst_arm})",
        f"COM off where it is wanted: {1e3 * bars.worst_com_m:.1f} mm ({bars.worst_com})",
    ]
