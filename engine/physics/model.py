"""The MuJoCo model of one body: our bones, masses and inertias, capsules and soles over a floor, ball joints
everywhere.

All joints are ball joints, so that any pose of any clip is a state, and MuJoCo's kinematics are ours. What a joint
cannot do (an elbow sideways) is left to the ligaments of `engine.physics.tracking`, which know how far a clip itself
oversteps, and to the stops of `engine.physics.stops`. Parts lie on the floor and, softly, on one another; the ball is
met by our own impulse law (engine.physics.impact), because MuJoCo's soft contacts bounce wrongly at spike speed.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

import mujoco
import numpy as np

from engine.body.anthropometry import joints_at_identity
from engine.body.capsules import CAPSULES, Capsules, body_capsules
from engine.body.mass_parts import point_inertia
from engine.body.skeleton import JOINT_COUNT, JOINTS, PARENT, SOLE_POINTS, Body
from engine.core.errors import EnvironmentTrouble
from engine.maths.ballistics import GRAVITY_MPS2
from engine.physics.layout import STATE_SIZE
from engine.physics.part_stops import PAIRS_BY_NAME, pairs_of

# MuJoCo would write a log file wherever the user happens to be. What it warns of, a state that has left the numbers,
# shows in the state itself, and the world stops at it by name.
mujoco.set_mju_user_warning(lambda _text: None)

SUB_STEPS_HZ = 480
SOLE_BEAD_M = 0.012  # the sole's contact points are small beads that touch the sole's plane from inside
FOOT_LIFT_M = 0.004
FLOOR_FRICTION = 0.8  # a shoe on a sports floor: 0.7 to 1.1 (EN 14904 asks for 80 - 110 on its pendulum scale)

# flesh in flesh, where a pose begins so or one lies on one's own arm: it parts slowly, critically damped. What comes
# fast is stopped by `engine.physics.stops`.
FLESH_SOLREF = "0.02 1"
FLESH_FRICTION = 0.5

# Greatest joint torques, N m for a man of 73 kg, rounded: isometric maxima of young men in the stronger direction (hip,
# knee, ankle after Anderson, Madigan and Nussbaum 2007; trunk after Kumar, Dufresne and Van Schoor 1995;
# shoulder, elbow, wrist after Garner and Pandy 2001; neck after Vasavada, Li and Delp 2001)
STRENGTH_NM = {
    "waist": 280, "back": 250, "neck": 60, "head": 40, "clavicle": 120, "shoulder": 110, "elbow": 75, "wrist": 18,
    "hip": 260, "knee": 240, "ankle": 160, "toe": 20,
}  # fmt: skip
STRENGTH_BODY_KG = 73.0


@dataclass(frozen=True, eq=False)
class RagdollModel:
    """One body ready to be simulated. Never changes, but for MuJoCo's scratch, which every call fills from a state."""

    body: Body
    key: str  # content of the body, for caches and world.assets
    mujoco_model: mujoco.MjModel = field(repr=False)
    data: mujoco.MjData = field(repr=False)
    state_size: int
    positions: slice  # of a state: qpos, root (3,) then quaternions (J, 4)
    velocities: slice  # of a state: qvel, root linear (3,) world, then angular (J, 3), each in its own joint's frame
    capsules: Capsules
    pairs: np.ndarray  # (P, 2) of them that stop each other
    mass_kg: float
    inertia_kgm2: np.ndarray  # (J,) seen by each joint's servo
    strength_nm: np.ndarray  # (J,)


_MODELS: dict[str, RagdollModel] = {}


def model_for(body: Body) -> RagdollModel:
    """The model of a body; made once for each content (some milliseconds), then the same object again."""
    key = body_key(body)
    if key not in _MODELS:
        _MODELS[key] = _make(body, key)
    return _MODELS[key]


def body_key(body: Body) -> str:
    """A name of the body's content: equal for equal numbers."""
    content = hashlib.sha256()
    for name, value in zip(body._fields, body, strict=True):
        content.update(name.encode() + np.ascontiguousarray(value).tobytes())
    return content.hexdigest()[:16]


def _make(body, key):
    m = mujoco.MjModel.from_xml_string(xml_of(body))
    kinds = mujoco.mjtState
    before, size = (mujoco.mj_stateSize(m, kind) for kind in (kinds.mjSTATE_TIME, kinds.mjSTATE_INTEGRATION))
    if size != STATE_SIZE:
        found = f"MuJoCo {mujoco.__version__} keeps a state of {size} numbers"
        raise EnvironmentTrouble("mujoco", f"{found}, expected {STATE_SIZE}: install the version in requirements.lock")
    return RagdollModel(
        body=body,
        key=key,
        mujoco_model=m,
        data=mujoco.MjData(m),
        state_size=size,
        positions=slice(before, before + m.nq),
        velocities=slice(before + m.nq, before + m.nq + m.nv),
        capsules=body_capsules(body),
        pairs=pairs_of(m),
        mass_kg=float(body.part_mass_kg.sum()),
        inertia_kgm2=servo_inertia_kgm2(body),
        strength_nm=_strength_nm(body),
    )


def _strength_nm(body):
    scale = body.part_mass_kg.sum() / STRENGTH_BODY_KG
    bare = [name.removeprefix("left_").removeprefix("right_") for name in JOINTS]
    return np.array([STRENGTH_NM.get(name, 0) * scale for name in bare])


def servo_inertia_kgm2(body: Body) -> np.ndarray:
    """(J,) the inertia that each joint has to move: what hangs on it; for a leg's, half of what stands on it.

    The mean moment about the joint, across the bone, identity pose. A leg carries more often than it swings.
    """
    joints = joints_at_identity(body.offset_m)
    total = np.empty(JOINT_COUNT)
    first_leg = JOINTS.index("left_hip")
    for j in range(JOINT_COUNT):
        beyond = [k for k in range(JOINT_COUNT) if _carries(j, k)]
        leg = j >= first_leg
        moved = [k for k in range(JOINT_COUNT) if k not in beyond] if leg else beyond
        inertia = sum(
            body.part_inertia_kgm2[k] + point_inertia(body.part_mass_kg[k], joints[k] + body.part_com_m[k] - joints[j])
            for k in moved
        )
        total[j] = 0.5 * (inertia[0, 0] + inertia[1, 1]) * (0.5 if leg else 1.0)
    # toes roll over, they do not balance the body
    for j, name in enumerate(JOINTS):
        if name.endswith("toe"):
            total[j] *= 0.05
    return total


def _carries(j, k):
    """Whether joint k is j or hangs on it."""
    while k >= 0:
        if k == j:
            return True
        k = PARENT[k]
    return False


def xml_of(body: Body) -> str:
    """The model as MJCF text: readable, and the same bits every time."""
    children = [[k for k in range(JOINT_COUNT) if PARENT[k] == j] for j in range(JOINT_COUNT)]
    geoms = _geoms(body)

    def element(j, indent):
        pad = "  " * indent
        joint = "<freejoint/>" if j == 0 else '<joint type="ball"/>'
        lines = [f'{pad}<body name="{JOINTS[j]}" pos="{_text(body.offset_m[j])}">', f"{pad}  {joint}"]
        lines.append(f"{pad}  {_inertial(body, j)}")
        lines += [f"{pad}  {g}" for g in geoms[j]]
        for k in children[j]:
            lines += element(k, indent + 1)
        return [*lines, f"{pad}</body>"]

    return "\n".join(
        [
            '<mujoco model="brace">',
            '  <compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>',
            f'  <option timestep="{1.0 / SUB_STEPS_HZ!r}" gravity="{_text(GRAVITY_MPS2)}" cone="elliptic"'
            ' impratio="10" iterations="60" tolerance="1e-10">',
            '    <flag autoreset="disable" eulerdamp="disable"/>',
            "  </option>",
            "  <default>",
            # contype 0: parts meet the floor (whose contype is 1), and one another only where a pair says so
            f'    <geom contype="0" conaffinity="1" friction="{FLOOR_FRICTION} 0.005 0.0001" condim="3"'
            ' solref="0.008 1" solimp="0.95 0.99 0.002"/>',
            "  </default>",
            "  <worldbody>",
            '    <geom name="floor" type="plane" size="0 0 1" contype="1" conaffinity="0"/>',
            *element(0, 2),
            "  </worldbody>",
            "  <contact>",
            *[_pair(one, other) for one, other in PAIRS_BY_NAME],
            "  </contact>",
            "</mujoco>",
        ]
    )


def _pair(one, other):
    friction = f"{FLESH_FRICTION} {FLESH_FRICTION} 0.005 0.0001 0.0001"
    return (
        f'    <pair geom1="{one}" geom2="{other}" condim="3" friction="{friction}" solref="{FLESH_SOLREF}"'
        ' solimp="0.9 0.95 0.01"/>'
    )


def _text(values):
    return " ".join(repr(float(v)) for v in values)


def _inertial(body, j):
    i = body.part_inertia_kgm2[j]
    return (
        f'<inertial pos="{_text(body.part_com_m[j])}" mass="{float(body.part_mass_kg[j])!r}" '
        f'fullinertia="{_text((i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]))}"/>'
    )


def _geoms(body):
    """Per joint, the shapes that may touch the floor: all capsules, and the soles' points that the feet stand on."""
    capsules = body_capsules(body)
    out: list[list[str]] = [[] for _ in range(JOINT_COUNT)]
    for name, j, a, b, r in zip(CAPSULES, *capsules, strict=True):
        if name.endswith(("_foot", "_toes")):
            # only for lying on their sides: standing is the sole points' business
            a, b = a + [0.0, 0.0, FOOT_LIFT_M], b + [0.0, 0.0, FOOT_LIFT_M]
        if np.abs(b - a).max() < 1e-4:
            out[j].append(f'<geom name="{name}" type="sphere" pos="{_text(a)}" size="{_text([r])}"/>')
        else:
            out[j].append(f'<geom name="{name}" type="capsule" fromto="{_text([*a, *b])}" size="{_text([r])}"/>')
    for side, side_name in enumerate(("left", "right")):
        for k, point in enumerate(SOLE_POINTS):
            j = JOINTS.index(f"{side_name}_{'toe' if point.startswith('toe') else 'ankle'}")
            centre = body.sole_m[side, k] + [0.0, 0.0, SOLE_BEAD_M]
            out[j].append(
                f'<geom name="{side_name}_{point}" type="sphere" pos="{_text(centre)}" size="{_text([SOLE_BEAD_M])}"/>'
            )
    return out
