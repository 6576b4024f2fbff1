"""The spine's shape classes and the collars: the paper's table, equations 1 to 4, and limits never broken."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.stance import frame, torso
from behaviours.stance.torso import LARGE_C, LARGE_S, SMALL_C, SMALL_S, STRAIGHT
from engine.body.limits import excess_rad
from engine.body.skeleton import BACK, CLAVICLES, HEAD, JOINT_COUNT, NECK, WAIST
from engine.maths import quaternion

# the appendix, once more: AbX, ChestX, NeckX, HeadX, AbZ, ChestZ, NeckZ, HeadZ
TABLE = {
    LARGE_S: (0.15, -0.1, -0.12, -0.1, 0.08, -0.1, -0.12, -0.06),
    LARGE_C: (0.15, 0.15, 0.15, 0.1, 0.15, 0.15, 0.12, 0.06),
    SMALL_S: (0.15, -0.2, 0.06, -0.1, 0.15, -0.2, 0.12, 0.06),
    SMALL_C: (-0.15, 0.3, 0.15, 0.1, -0.15, 0.3, 0.12, 0.06),
    STRAIGHT: (0.0,) * 8,
}
SPINE = (WAIST, BACK, NECK, HEAD)


def shaped(body, sagittal_class=STRAIGHT, coronal_class=STRAIGHT, opposed=(False, False), **unknowns):
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1))
    classes = np.array([torso.SHAPE_CLASSES.index(sagittal_class), torso.SHAPE_CLASSES.index(coronal_class)])
    values = np.array([unknowns.get(name, 0.0) for name in torso.UNKNOWNS])
    torso.shape_torso(body, classes, np.array(opposed), values, rotations)
    return rotations


@pytest.mark.parametrize("name", TABLE)
def test_degrees_of_freedom_are_amplitude_times_weight(body, name):
    rotations = shaped(body, name, name, sagittal=1.3, coronal=-0.7)
    angles = np.array([frame.angles(rotations[j]) for j in SPINE])
    assert angles[:, 0] == pytest.approx(1.3 * np.array(TABLE[name][:4]), abs=1e-12)
    assert angles[:, 2] == pytest.approx(-0.7 * np.array(TABLE[name][4:]), abs=1e-12)


def test_twist_is_shared_equally(body):
    rotations = shaped(body, transverse=0.8)
    assert [frame.angles(rotations[j])[1] for j in SPINE] == pytest.approx([0.2] * 4)


def test_the_abdomens_offset_adds_to_it_alone(body):
    plain, offset = shaped(body, LARGE_C, sagittal=1.0), shaped(body, LARGE_C, sagittal=1.0, abdomen_x=0.2)
    assert frame.angles(offset[WAIST])[0] - frame.angles(plain[WAIST])[0] == pytest.approx(0.2)
    assert np.array_equal(plain[BACK:], offset[BACK:])


def shoulder_moves(body, rotations):
    """How each shoulder goes, seen from the chest: ahead, up."""
    moves = []
    for side in range(2):
        out = (0.0, 1.0 - 2.0 * side, 0.0)
        moves.append(np.subtract(quaternion.rotate(rotations[CLAVICLES[side]], out), out)[[0, 2]])
    return np.array(moves)


def test_aligned_collars_take_both_shoulders_the_same_way(body):
    left, right = shoulder_moves(body, shaped(body, collar_y=0.2, collar_z=0.1))
    assert left == pytest.approx(right)
    assert left[0] < 0.0 < left[1]  # back and up


def test_opposed_collars_are_one_rigid_unit(body):
    rotations = shaped(body, opposed=(True, True), collar_y=0.2, collar_z=0.1)
    assert np.array_equal(rotations[CLAVICLES[0]], rotations[CLAVICLES[1]])
    left, right = shoulder_moves(body, rotations)
    assert left[0] < 0.0 < right[0]  # turned left, as the twist with the same sign turns
    assert right[1] < 0.0 < left[1]


@given(
    st.sampled_from(torso.SHAPE_CLASSES), st.sampled_from(torso.SHAPE_CLASSES), st.booleans(), st.booleans(),
    st.lists(st.floats(0.0, 1.0).map(lambda x: round(x, 6)), min_size=6, max_size=6),
)  # fmt: skip
def test_inside_the_bounds_no_limit_is_broken(body, sagittal, coronal, y, z, shares):
    classes = np.array([torso.SHAPE_CLASSES.index(sagittal), torso.SHAPE_CLASSES.index(coronal)])
    bounds = torso.amplitude_bounds(body, classes, np.array([y, z]))
    unknowns = bounds[:, 0] + np.array(shares) * (bounds[:, 1] - bounds[:, 0])
    rotations = shaped(body, sagittal, coronal, (y, z), **dict(zip(torso.UNKNOWNS, unknowns, strict=True)))
    assert excess_rad(body, rotations)[1:].max() < 1e-9


@pytest.mark.parametrize("name", [LARGE_S, LARGE_C, SMALL_S, SMALL_C])
@pytest.mark.parametrize("plane", ["sagittal", "coronal"])
def test_the_bounds_are_no_tighter_than_the_limits(body, name, plane):
    """Past the end of an amplitude some joint is over its limit, unless the end is the slider's."""
    classes = np.array([torso.SHAPE_CLASSES.index(name)] * 2)
    high = torso.amplitude_bounds(body, classes, np.array([False, False]))[torso.UNKNOWNS.index(plane), 1]
    over = excess_rad(body, shaped(body, name, name, **{plane: 1.01 * high}))[1:].max()
    assert high == 4.0 or over > 0.0
