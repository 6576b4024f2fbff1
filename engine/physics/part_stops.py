"""Parts that stop each other: no arm goes into head, trunk or the other arm, no leg into the other.

Each pair of capsules that comes near is a row for `engine.physics.stops`: the rate at which the gap between their
nearest places grows.
"""

from __future__ import annotations

import numpy as np

from engine.body.capsules import CAPSULES, capsules_at
from engine.body.skeleton import JOINT_COUNT, PARENT
from engine.maths import quaternion, shapes, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.physics.rows import rate_of
from engine.physics.tracking import world_frames

# what others' impulses may break is kept in view: a bound that is met by less than this, and parts this near each
# other, however fast they part, since an elbow that meets its limit throws a hand back
NEAR_MPS, IN_VIEW_M = 0.05, 0.01
CREEP_MPS = 0.02
FARTHEST_M = 0.15  # nothing within a body closes faster than this in `stops.EASE_S`
AT_FIRST = 0.75  # of the speed over the time that is left; a half would be an even brake
FLESH_M = 0.004  # what gives between two parts that are thrown together, of the soft tissue on both, before it is hard
LEAST_APART_M = 1e-6  # of two axes: nearer than this, there is no saying which way is out
TOUCHING_M = 0.01  # what a blow closes at once: this counts as touching

_TRUNK = ("pelvis", "belly", "chest", "upper_chest", "neck", "head")


def _between(ones, others):
    return [(one, other) for one in ones for other in others]


def _both(names):
    return [f"{side}_{name}" for side in ("left", "right") for name in names]


def _names_of_pairs():
    """Which capsules stop which, by name: never two that hang on one joint."""
    lower, legs = _both(("forearm", "hand")), _both(("thigh",))
    left, right = ([f"{side}_{part}" for part in ("upper_arm", "forearm", "hand")] for side in ("left", "right"))
    left_leg, right_leg = ([f"{side}_{part}" for part in ("thigh", "shank", "foot")] for side in ("left", "right"))
    return [
        *_between(lower, _TRUNK),
        *_between(_both(("upper_arm",)), ("head",)),
        *_between(left, right),
        *_between(lower, legs),
        # thighs meet at their knees, which are the shanks' upper ends too: at the hips they are one flesh
        *[pair for pair in _between(left_leg, right_leg) if any(name.endswith("shank") for name in pair)],
        ("left_foot", "right_foot"),
    ]


PAIRS_BY_NAME = _names_of_pairs()


def pairs_of(mujoco_model) -> np.ndarray:
    """(P, 2) the same as capsules, in the order in which MuJoCo keeps them."""
    geoms = zip(mujoco_model.pair_geom1, mujoco_model.pair_geom2, strict=True)
    return np.array([[CAPSULES.index(mujoco_model.geom(g).name) for g in pair] for pair in geoms])


def keep_own(model, target: np.ndarray) -> None:
    """Lets every pair of parts lie in each other as deep as they do in the target (J, 4): a clip keeps its own."""
    depths_into(PARENT, model.body.offset_m, target, model.capsules, model.pairs, model.mujoco_model.pair_margin)
    np.negative(model.mujoco_model.pair_margin, out=model.mujoco_model.pair_margin)


@njit(cache=True)
def depths_into(parent, offset_m, rotations, capsules, pairs, out):
    """How deep the parts of each pair (P, 2) lie in each other in a pose, metres, 0 where they are apart."""
    qpos = np.zeros(3 + 4 * JOINT_COUNT)
    for joint in range(JOINT_COUNT):
        for k in range(4):
            qpos[3 + 4 * joint + k] = rotations[joint, k]
    ends = capsules_at(capsules, *world_frames(parent, offset_m, qpos))
    for n in range(len(pairs)):
        a, b = pairs[n]
        gap_m = nearest(ends[a], ends[b], capsules.radius_m[a] + capsules.radius_m[b])[2]
        out[n] = max(0.0, -gap_m)


@njit(cache=True)
def parts_into(parent, offset_m, capsules, pairs, qpos, qvel, ease_s, h, limp, farthest_m, rows, least, count):
    """Adds the rows and bounds of the pairs nearer than farthest_m that close too fast, or nearly so; how many now."""
    positions, orientations = world_frames(parent, offset_m, qpos)
    ends = capsules_at(capsules, positions, orientations)
    for n in range(len(pairs)):
        if count == len(least):
            break
        a, b = pairs[n, 0], pairs[n, 1]
        on_a, on_b, gap_m = nearest(ends[a], ends[b], capsules.radius_m[a] + capsules.radius_m[b])
        apart_m = vector.distance(on_a, on_b)
        if gap_m > farthest_m or apart_m < LEAST_APART_M:
            continue
        normal = vector.scale(vector.subtract(on_a, on_b), 1.0 / apart_m)
        row = rows[count]
        _add_place(parent, positions, orientations, capsules.joint[a], on_a, normal, 1.0, row)
        _add_place(parent, positions, orientations, capsules.joint[b], on_b, normal, -1.0, row)
        rate_mps = rate_of(row, qvel)
        least[count] = -may_close_mps(gap_m, -rate_mps, ease_s, h) - limp * CREEP_MPS
        if gap_m < IN_VIEW_M or rate_mps < least[count] + NEAR_MPS:
            count += 1
        else:
            row[:] = 0.0
    return count


@njit(cache=True)
def may_close_mps(gap_m, closing_mps, ease_s, h):
    """How fast two parts may close: as stops have it, or, faster than that, braked within gap and flesh, harder at
    first than at last: what throws them together mostly still pushes.
    """
    cap_mps, left_m = max(gap_m, 0.0) / ease_s, gap_m + FLESH_M
    if closing_mps <= cap_mps or left_m <= 0.0:
        return cap_mps
    return max(cap_mps, closing_mps * (1.0 - AT_FIRST * closing_mps * h / left_m))


@njit(cache=True)
def nearest(ends, other_ends, radii_m):
    """The nearest places of two capsules' axes, and the gap between their surfaces, negative inside."""
    s, t = shapes.nearest_between(ends[0], ends[1], other_ends[0], other_ends[1])
    one, other = vector.mix(ends[0], ends[1], s), vector.mix(other_ends[0], other_ends[1], t)
    return one, other, vector.distance(one, other) - radii_m


@inner_kernel
def _add_place(parent, positions, orientations, joint, place, normal, sign, row):
    """Adds to a row how fast a place on a part moves along a normal, per generalised velocity."""
    j = joint
    while j >= 0:
        arm = vector.subtract(place, positions[j])
        turning = quaternion.unrotate(orientations[j], vector.cross(arm, normal))
        for axis in range(3):
            row[3 + 3 * j + axis] += sign * turning[axis]
        j = parent[j]
    for axis in range(3):
        row[axis] += sign * normal[axis]
