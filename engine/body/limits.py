"""How far a joint goes: published ranges of motion, and rotations held inside them.

A joint's rotation is taken apart as swing * twist, the twist about the bone's axis Z; the swing, a rotation vector
without Z part, and the twist give three numbers (swing X, swing Y, twist Z) in radians, each with a low and a high
limit. Where a clip itself goes beyond a limit, its own excess is kept and never added to: `clamp_keeping` and
`excess_beyond_rad`.

Sources: NASA-STD-3000, Man-Systems Integration Standards, vol. 1, fig. 3.3.2.3.1-1 (95th percentile male: neck,
shoulder, elbow, forearm, wrist, hip); Magee, Orthopedic Physical Assessment (lumbar and thoracic spine); Neumann,
Kinesiology of the Musculoskeletal System (sternoclavicular joint); AAOS, Joint Motion (hip rotation and extension,
subtalar joint, toes) after Norkin & White, Measurement of Joint Motion; Bennell et al. 1998 (dorsiflexion bearing
weight). The 95th percentile is taken where it is published: a limit is there to forbid the impossible, not the unusual.
The stance paper's 48 degrees of freedom are those with a range worth the name; the others keep only the play that real
joints have (carrying angle of the elbow, varus and valgus of the knee ...).
"""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import JOINT_COUNT, MIRRORED, joint_index
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# joint: ((low, high) of swing X, swing Y, twist Z) in degrees; left side given, the right one is its mirror image.
# Positive Y bows the trunk, flexes the knee and points the foot; negative Y lifts arm and thigh forward and flexes the
# elbow.
_DEGREES = {
    "waist": ((-20, 20), (-35, 60), (-18, 18)),  # lumbar: lateral; extension, flexion; rotation
    "back": ((-40, 40), (-45, 45), (-50, 50)),  # thoracic
    "neck": ((-50, 50), (-65, 50), (-65, 65)),  # with the head's: NASA's whole cervical spine
    "head": ((-15, 15), (-38, 25), (-40, 40)),  # upper cervical: the atlas turns 40 to each side
    "left_clavicle": ((-10, 45), (-35, 35), (-30, 30)),  # depression, elevation; axial; protraction, retraction
    # adducted to abducted; flexed to extended. 45 degrees past straight ahead (AAOS: 135 of horizontal adduction) is a
    # swing X of -64 for a level arm, and of -100 for one raised across the face: the box has to hold both
    "left_shoulder": ((-100, 180), (-180, 83), (-127, 127)),
    "left_elbow": ((-15, 15), (-159, 0), (-126, 126)),  # carrying angle; flexion, none backwards; forearm
    "left_wrist": ((-95, 78), (-37, 48), (-15, 15)),  # flexion, extension; radial, ulnar; play
    "left_hip": ((-30, 54), (-148, 30), (-45, 45)),  # adduction, abduction; flexion, extension; rotation
    "left_knee": ((-10, 10), (0, 150), (-20, 20)),  # play; flexion, none backwards; play
    "left_ankle": ((-35, 20), (-40, 60), (-25, 25)),  # inversion, eversion; dorsi-, plantarflexion; play
    "left_toe": ((-10, 10), (-80, 45), (-15, 15)),
}


def standard_limits() -> tuple[np.ndarray, np.ndarray]:
    """Low and high limits (J, 3), radians. The pelvis, which nothing holds, has infinite ones."""
    low, high = np.full((JOINT_COUNT, 3), -np.inf), np.full((JOINT_COUNT, 3), np.inf)
    for name, ranges in _DEGREES.items():
        j = joint_index(name)
        low[j], high[j] = np.radians(ranges).T
        # a mirror in the X-Z plane keeps turns about Y and reverses those about X and Z
        m = MIRRORED[j]
        if m != j:
            low[m] = (-high[j, 0], low[j, 1], -high[j, 2])
            high[m] = (-low[j, 0], high[j, 1], -low[j, 2])
    return low, high


@njit(cache=True)
def components(q):
    """Swing X, swing Y and twist Z of a rotation, radians; the swing at most pi long, the twist in [-pi, pi]."""
    swing, twist = quaternion.swing_twist(q)
    s = quaternion.to_rotation_vector(swing)
    return (s[0], s[1], quaternion.to_rotation_vector(twist)[2])


@njit(cache=True)
def from_components(swing_x_rad, swing_y_rad, twist_rad):
    """The rotation that has these components."""
    return quaternion.multiply(
        quaternion.from_rotation_vector((swing_x_rad, swing_y_rad, 0.0)), quaternion.about_z(twist_rad)
    )


@njit(cache=True)
def mix(a, b, weight):
    """A rotation between two, component by component: weight 0 gives a, 1 gives b.

    Limits are intervals of the components, so between two rotations inside them this one is inside; slerp is not. A
    hinge stays a hinge: an elbow that slerp takes from one forearm twist to another bends sideways on the way, this one
    does not. For joints that swing far from half a turn (elbow, wrist, knee, ankle); a shoulder is better slerped.
    """
    x0, y0, z0 = components(a)
    x1, y1, z1 = components(b)
    return from_components(x0 + weight * (x1 - x0), y0 + weight * (y1 - y0), z0 + weight * (z1 - z0))


@njit(cache=True)
def clamp_rotation(low, high, q):
    """The rotation with every component inside its limits (3,), (3,); exactly q where it already is.

    Continuous wherever its components are: everywhere but half a turn of swing or of twist away from the identity,
    where no limit is the nearer one (a circle cannot be drawn back onto an arc of it without a tear).
    """
    x, y, z = components(q)
    cx, cy, cz = min(max(x, low[0]), high[0]), min(max(y, low[1]), high[1]), min(max(z, low[2]), high[2])
    if cx == x and cy == y and cz == z:
        return (q[0] * 1.0, q[1] * 1.0, q[2] * 1.0, q[3] * 1.0)
    r = from_components(cx, cy, cz)
    # the sign of a quaternion means nothing, but a jump of it would spoil interpolation
    if r[0] * q[0] + r[1] * q[1] + r[2] * q[2] + r[3] * q[3] < 0.0:
        return (-r[0], -r[1], -r[2], -r[3])
    return r


@njit(cache=True)
def clamp_keeping(low, high, reference, q):
    """Like clamp_rotation, but a limit that the reference rotation oversteps is moved out to where that is."""
    x, y, z = components(reference)
    return clamp_rotation(
        (min(low[0], x), min(low[1], y), min(low[2], z)), (max(high[0], x), max(high[1], y), max(high[2], z)), q
    )


@njit(cache=True)
def clamp_pose(body, reference, rotations):
    """Clamps all joints of one pose (J, 4) in place, each keeping the excess of the reference pose (J, 4)."""
    for j in range(JOINT_COUNT):
        q = clamp_keeping(body.limit_low_rad[j], body.limit_high_rad[j], reference[j], rotations[j])
        rotations[j, 0], rotations[j, 1], rotations[j, 2], rotations[j, 3] = q


@njit(cache=True)
def beyond_limits(low, high, rotations):
    """(J, 3) how far each component of a pose (J, 4) is beyond its limits (J, 3), radians, negative below."""
    out = np.empty((JOINT_COUNT, 3))
    for j in range(JOINT_COUNT):
        c = components(rotations[j])
        for k in range(3):
            out[j, k] = max(c[k] - high[j, k], 0.0) + min(c[k] - low[j, k], 0.0)
    return out


@inner_kernel
def _overrun(low, high, value):
    """The farthest that a component lies outside; 0 when all are inside."""
    worst = 0.0
    for axis in range(3):
        worst = max(worst, low[axis] - value[axis], value[axis] - high[axis])
    return worst


@njit(cache=True)
def joint_excess_rad(low, high, reference, q):
    """How far q lies beyond the limits as the reference rotation has widened them; radians, 0 inside."""
    r = components(reference)
    return _overrun(
        (min(low[0], r[0]), min(low[1], r[1]), min(low[2], r[2])),
        (max(high[0], r[0]), max(high[1], r[1]), max(high[2], r[2])),
        components(q),
    )


@njit(cache=True)
def _excess_of_poses(low, high, reference, rotations, out):
    for n in range(len(rotations)):
        for j in range(JOINT_COUNT):
            out[n, j] = joint_excess_rad(low[j], high[j], reference[n % len(reference), j], rotations[n, j])


def excess_rad(body, rotations: np.ndarray) -> np.ndarray:
    """How far each joint lies beyond its limits, (..., J, 4) -> (..., J) radians, 0 inside."""
    return excess_beyond_rad(body, rotations, _IDENTITIES)


def excess_beyond_rad(body, rotations: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The same, without what the reference pose (J, 4), or each of as many poses (..., J, 4), oversteps itself."""
    flat = np.ascontiguousarray(rotations, float).reshape(-1, JOINT_COUNT, 4)
    kept = np.ascontiguousarray(reference, float).reshape(-1, JOINT_COUNT, 4)
    if len(kept) not in (1, len(flat)):
        raise ValueError(f"{len(kept)} reference poses for {len(flat)} poses, expected one or as many")
    out = np.empty((len(flat), JOINT_COUNT))
    _excess_of_poses(body.limit_low_rad, body.limit_high_rad, kept, flat, out)
    return out.reshape(np.shape(rotations)[:-1])


_IDENTITIES = np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1))
