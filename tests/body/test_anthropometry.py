"""The mass model against de Leva's own sums, and against the whole segments that ours are cut from."""

import numpy as np
import pytest

from engine.body import anthropometry as anthro
from engine.body import kinematics
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    HEAD,
    HIPS,
    JOINT_COUNT,
    KNEES,
    MIRRORED,
    NECK,
    SHOULDERS,
    TOES,
    WRISTS,
)  # fmt: skip
from tests.body.poses import identity_pose

SEXES = ["male", "female"]
PAIRED = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")


@pytest.mark.parametrize("sex", SEXES)
def test_the_table_sums_to_one_body(sex):
    table = anthro.DE_LEVA[sex]
    total = sum(s.mass * (2 if name in PAIRED else 1) for name, s in table.items())
    assert total == pytest.approx(1.0, abs=1.01e-4)  # the female column sums to 99.99 %


@pytest.mark.parametrize("sex", SEXES)
@pytest.mark.parametrize("height", [1.5, 1.75, 2.0])
def test_a_standard_body_is_as_tall_and_as_heavy_as_asked(sex, height):
    body = anthro.standard_body(height, sex, mass_kg=70.0)
    joints = anthro.joints_at_identity(body.offset_m)
    crown = joints[HEAD, 2] + body.head_top_m[2]
    sole = joints[ANKLES[0], 2] + body.sole_m[0, 0, 2]
    assert crown - sole == pytest.approx(height, rel=2e-3)
    assert anthro.stature_m(body.offset_m) == pytest.approx(height, rel=2e-3)
    assert body.part_mass_kg.sum() == pytest.approx(70.0, rel=2e-4)
    unsaid = anthro.standard_body(height, sex)
    assert unsaid.part_mass_kg.sum() == pytest.approx(anthro.BUILD[sex].body_mass_index * height**2, rel=5e-3)


def composite(body, joints_wanted):
    """Mass, COM and inertia of several parts as one, in the identity pose: the parallel-axis theorem written out."""
    joints = anthro.joints_at_identity(body.offset_m)
    rows = [k for k, j in enumerate(body.part_joint) if j in joints_wanted]
    mass = body.part_mass_kg[rows]
    com = joints[body.part_joint[rows]] + body.part_com_m[rows]
    middle = (mass[:, None] * com).sum(0) / mass.sum()
    inertia = np.zeros((3, 3))
    for k, m, c in zip(rows, mass, com - middle, strict=True):
        inertia += body.part_inertia_kgm2[k] + m * (np.dot(c, c) * np.eye(3) - np.outer(c, c))
    return mass.sum(), middle, inertia


@pytest.mark.parametrize("sex", SEXES)
def test_the_cut_segments_put_together_are_de_levas(sex):
    body = anthro.standard_body(1.74, sex, 70.0)
    table, joints = anthro.DE_LEVA[sex], anthro.joints_at_identity(body.offset_m)
    mass, com, inertia = composite(body, (HEAD, NECK))
    length = joints[HEAD, 2] + body.head_top_m[2] - joints[NECK, 2]
    assert mass == pytest.approx(table["head"].mass * 70)
    assert com[2] == pytest.approx(joints[NECK, 2] + (1 - table["head"].com) * length)
    np.testing.assert_allclose(np.diag(inertia), mass * (np.array(table["head"].gyration) * length) ** 2)
    mass, com, inertia = composite(body, (BACK, *CLAVICLES))
    trunk = joints[SHOULDERS[0], 2] - joints[HIPS[0], 2]
    build = anthro.BUILD[sex]
    length = (build.suprasternale - build.xiphion) * trunk
    assert mass == pytest.approx(table["upper_trunk"].mass * 70)
    top = joints[HIPS[0], 2] + build.suprasternale * trunk
    assert com[2] == pytest.approx(top - table["upper_trunk"].com * length)
    np.testing.assert_allclose(np.diag(inertia), mass * (np.array(table["upper_trunk"].gyration) * length) ** 2)
    mass, _, inertia = composite(body, (ANKLES[1], TOES[1]))
    foot = build.foot * anthro.stature_m(body.offset_m)
    gyration = np.array(table["foot"].gyration)[[2, 1, 0]]  # his long axis points forwards
    np.testing.assert_allclose(np.diag(inertia), mass * (gyration * foot) ** 2)


@pytest.mark.parametrize("sex", SEXES)
def test_every_joint_carries_a_part_that_could_be_a_body(sex):
    body = anthro.standard_body(1.6, sex)
    np.testing.assert_array_equal(body.part_joint, np.arange(JOINT_COUNT))
    for inertia in body.part_inertia_kgm2:
        a, b, c = np.linalg.eigvalsh(inertia)
        assert a > 0
        assert a + b >= c - 1e-12
        np.testing.assert_allclose(inertia, inertia.T)


def test_the_standing_body_balances_over_its_ankles_and_is_its_own_mirror():
    body = anthro.standard_body()
    com = kinematics.com_of(body, identity_pose(0.0))
    assert abs(com[1]) < 1e-12
    assert -0.02 < com[0] < 0.04
    # known share of stature: 56 to 57 % for men (Winter); measured from the sole
    sole = anthro.joints_at_identity(body.offset_m)[ANKLES[0], 2] + body.sole_m[0, 0, 2]
    assert (com[2] - sole) / 1.75 == pytest.approx(0.565, abs=0.015)
    np.testing.assert_allclose(body.part_com_m[MIRRORED] * [1, -1, 1], body.part_com_m, atol=1e-15)
    flip = np.diag([1.0, -1.0, 1.0])
    np.testing.assert_allclose(flip @ body.part_inertia_kgm2[MIRRORED] @ flip, body.part_inertia_kgm2, atol=1e-15)


def test_a_clip_without_toes_gets_them_and_keeps_what_it_has():
    standard = anthro.standard_body()
    offset = standard.offset_m.copy()
    offset[list(TOES)] = np.nan
    crown, fingers = np.array([0.02, 0.0, 0.13]), np.array([[0.0, 0.0, -0.2], [0.0, 0.01, -0.21]])
    body = anthro.make_body(offset, head_top_m=crown, fingertip_m=fingers)
    np.testing.assert_allclose(body.offset_m, standard.offset_m, atol=1e-3)
    np.testing.assert_array_equal(body.head_top_m, crown)
    np.testing.assert_array_equal(body.fingertip_m, fingers)
    assert (body.palm_m[:, 2] < 0).all()
    np.testing.assert_array_equal(np.isnan(offset[list(TOES)]), True)  # what was given is not written in


def test_wrong_bodies_are_refused_by_name():
    good = anthro.standard_body().offset_m
    with pytest.raises(ValueError, match="unknown sex 'robot'"):
        anthro.make_body(good, sex="robot")
    with pytest.raises(ValueError, match="finite"):
        anthro.make_body(np.where(np.arange(21)[:, None] == KNEES[0], np.inf, good))
    with pytest.raises(ValueError, match="shape"):
        anthro.make_body(good[:20])
    with pytest.raises(ValueError, match="body mass"):
        anthro.make_body(good, mass_kg=0.0)
    with pytest.raises(ValueError, match="no length"):
        anthro.make_body(np.where(np.arange(21)[:, None] == WRISTS[0], 0.0, good))
