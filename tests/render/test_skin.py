"""The smooth figure: one closed skin, hands with fingers, weights that bend without pinching, the same on the GPU."""

from __future__ import annotations

import functools
import os

import numpy as np
import pytest

from engine.body import skeleton as sk
from engine.body.anthropometry import make_body, standard_body
from engine.body.kinematics import joints_of
from engine.body.skeleton import Pose
from engine.maths import quaternion, rotations
from engine.render import mesh_cache
from engine.render.adaptive import graded_mesh
from engine.render.camera import frame_all, orbit_camera, project
from engine.render.mannequin import mannequin_mesh, rest_positions, stature_m
from engine.render.mesh_cache import cached_mesh, mesh_key
from engine.render.occlusion import occluders
from engine.render.scene import FloorStyle, Scene, extent_points
from engine.render.sculpture.hand import HAND_M, hand
from engine.render.skinning import moved_by_skin, world_from_rest
from engine.render.surface import ball
from tests.render.people import PROTECT, STAND, WALK, person

SIZE = (320, 240)
BODY = standard_body()


@functools.cache
def _skin(coarser: float = 2.0):
    return mannequin_mesh(BODY, coarser)


def _posed(turns: dict[int, tuple], coarser: float = 2.0) -> np.ndarray:
    """(V, 3) the skin with joints turned from the identity pose, the pelvis at the origin."""
    local = np.tile(quaternion.IDENTITY, (sk.JOINT_COUNT, 1))
    for joint, turn in turns.items():
        local[joint] = turn
    positions, orientations = joints_of(BODY, Pose(np.zeros(3), local))
    return _carried(_skin(coarser), BODY, positions, orientations)


def _carried(mesh, body, positions, orientations) -> np.ndarray:
    places = world_from_rest(rest_positions(body), positions, orientations)
    return moved_by_skin(
        mesh.positions.astype(float), mesh.normals.astype(float), mesh.joints, mesh.weights, places, orientations
    )[0]


def _directed_sides(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How often each side of a triangle is walked each way: the two agree where nothing is open."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    ways = [np.sort(sides[:, a] * 10**7 + sides[:, 1 - a]) for a in (0, 1)]
    return ways[0], ways[1]


def _volume(positions: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6.0)


@pytest.mark.parametrize("body", [BODY, standard_body(1.55, "female")])
@pytest.mark.parametrize("coarser", [2.0, 2.8])
def test_the_skin_is_one_closed_surface_with_a_persons_volume(body, coarser):
    mesh = mannequin_mesh(body, coarser)
    there, back = _directed_sides(mesh.triangles)
    assert (there == back).all()
    assert np.isfinite(mesh.positions).all()
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0, abs=1e-4)
    weight_kg = body.part_mass_kg.sum()
    assert 0.65 < _volume(mesh.positions, mesh.triangles) * 1000.0 / weight_kg < 1.25  # people float, barely


def test_graded_cells_leave_no_crack_and_keep_a_balls_shape():
    small_above = lambda points: np.where(points[:, 2] > 0.05, 0.01, 0.04)  # noqa: E731
    mesh = graded_mesh(ball((0.0, 0.0, 0.0), 0.2), small_above, 0.08, 3)
    there, back = _directed_sides(mesh.triangles)
    assert (there == back).all()
    assert _volume(mesh.vertices, mesh.triangles) == pytest.approx(4 / 3 * np.pi * 0.2**3, rel=0.03)
    assert np.linalg.norm(mesh.vertices, axis=1) == pytest.approx(0.2, abs=1e-4)
    assert (mesh.vertices[:, 2] > 0.06).sum() > 4 * (mesh.vertices[:, 2] < -0.06).sum()


def test_it_has_the_bodys_stature_and_stands_on_its_soles():
    heights, rest = _skin().positions[:, 2], rest_positions(BODY)
    assert np.ptp(heights) == pytest.approx(stature_m(BODY), abs=0.02)
    assert heights.min() == pytest.approx(rest[sk.LEFT_ANKLE][2] + BODY.sole_m[0, :4, 2].min(), abs=0.004)
    tips = _skin().positions[_skin().joints[:, 0] == sk.LEFT_WRIST]
    fingertip = rest[sk.LEFT_WRIST] + BODY.fingertip_m[0]
    assert tips[:, 2].min() == pytest.approx(fingertip[2], abs=0.02)


def test_every_weight_set_is_whole_and_left_and_right_agree():
    mesh = _skin()
    assert mesh.weights.sum(axis=1) == pytest.approx(1.0, abs=1e-5)
    assert (np.diff(mesh.weights, axis=1) <= 1e-6).all()
    each = np.zeros((len(mesh.weights), sk.JOINT_COUNT))
    np.put_along_axis(each, mesh.joints.astype(int), mesh.weights, axis=1)
    totals = each.sum(axis=0)
    assert totals == pytest.approx(totals[sk.MIRRORED], rel=0.04)
    for joint in range(sk.JOINT_COUNT):
        assert each[:, joint].max() > 0.6, sk.JOINTS[joint]
    assert set(mesh.joints[mesh.positions[:, 2] > rest_positions(BODY)[sk.HEAD][2] + 0.05, 0]) == {sk.HEAD}


def test_a_longer_forearm_lengthens_the_skin_there():
    offset = BODY.offset_m.copy()
    offset[sk.LEFT_WRIST] *= 1.2
    longer = mannequin_mesh(make_body(offset), 2.0)
    grown = [np.abs(mesh.positions[mesh.joints[:, 0] == sk.LEFT_WRIST, 2]).max() for mesh in (longer, _skin())]
    assert grown[0] - grown[1] == pytest.approx(0.2 * np.linalg.norm(BODY.offset_m[sk.LEFT_WRIST]), abs=0.015)


def test_a_skeleton_with_shoulders_at_its_neck_does_not_shrug():
    """The skin over the shoulders rises by less than half of what the joints do, and a neck still shows."""
    offset = BODY.offset_m.copy()
    offset[[*sk.SHOULDERS], 2] += 0.10
    tops = []
    for body in (BODY, make_body(offset)):
        mesh, rest = mannequin_mesh(body, 2.0), rest_positions(body)
        beside = np.abs(mesh.positions[:, 1] - rest[sk.LEFT_SHOULDER][1]) < 0.03
        tops.append(mesh.positions[beside, 2].max() - rest[sk.HEAD][2])
    assert tops[1] < -0.06  # the chin is above
    assert 0.0 < tops[1] - tops[0] < 0.06


def test_a_hand_has_four_fingers_apart_and_a_thumb():
    shape = hand(np.array([0.0, 0.0, -HAND_M]), -1.0)
    across = np.linspace(-0.09, 0.09, 721)
    for along, fingers in ((0.35, 1), (0.72, 4), (0.80, 4)):
        x, y = np.meshgrid(across, np.linspace(-0.08, 0.03, 111))
        inside = shape.field(np.stack([x.ravel(), y.ravel(), np.full(x.size, -along * HAND_M)], axis=1)) < 0.0
        seen = inside.reshape(x.shape).any(axis=0)
        assert np.count_nonzero(np.diff(seen.astype(int)) == 1) == fingers
    thumb = shape.field(np.array([(0.0525, -0.021, -0.10)]))
    assert thumb < 0.0


def test_the_face_looks_ahead_and_shoes_are_below():
    mesh = _skin()
    head = mesh.positions[mesh.joints[:, 0] == sk.HEAD]
    glass = mesh.positions[mesh.paint_m[:, 1] < 0.0]
    assert glass[:, 0].min() > head[:, 0].min() + 0.10
    assert abs(head[head[:, 0].argmax()][1]) < 0.01  # the nose
    shoes = mesh.positions[mesh.paint_m[:, 2] < 0.0]
    assert shoes[:, 2].max() < rest_positions(BODY)[sk.LEFT_ANKLE][2] + 0.06
    assert len(shoes) > 60


def test_a_turn_of_everything_turns_the_skin_rigidly():
    turn = quaternion.from_rotation_vector((0.4, -0.7, 1.1))
    expected = rotations.rotate(np.array(turn), _skin().positions.astype(float))
    assert _posed({sk.PELVIS: turn}) == pytest.approx(expected, abs=1e-5)


def test_halfway_between_two_bones_the_skin_turns_half_as_far_about_the_joint():
    point, normal = np.array([[0.04, 0.0, 0.0]]), np.array([[1.0, 0.0, 0.0]])
    joints, weights = np.array([[sk.LEFT_KNEE, sk.LEFT_HIP, 0, 0]]), np.array([[0.5, 0.5, 0.0, 0.0]])
    turns = np.tile(quaternion.IDENTITY, (sk.JOINT_COUNT, 1))
    turns[sk.LEFT_KNEE] = quaternion.about_y(2.0)
    moved, turned = moved_by_skin(point, normal, joints, weights, np.zeros((sk.JOINT_COUNT, 3)), turns)
    half = quaternion.about_y(1.0)
    assert moved[0] == pytest.approx(quaternion.rotate(half, tuple(point[0])), abs=1e-9)
    assert turned[0] == pytest.approx(quaternion.rotate(half, tuple(normal[0])), abs=1e-9)


@pytest.mark.parametrize(
    ("joint", "turn", "kept"),
    [
        (sk.LEFT_WRIST, quaternion.about_z(2.6), 0.9),
        (sk.LEFT_ELBOW, quaternion.about_y(-2.4), 0.8),
        (sk.LEFT_KNEE, quaternion.about_y(2.3), 0.8),
        (sk.LEFT_SHOULDER, quaternion.about_z(1.6), 0.8),
    ],
)
def test_no_joint_is_wrung_out_like_a_sweets_wrapper(joint, turn, kept):
    """How far the skin around a joint stays from the joint when it is turned as far as it goes."""
    mesh, at = _skin(), rest_positions(BODY)[joint]
    share = ((mesh.joints == joint) * mesh.weights).sum(axis=1)
    around = (share > 0.2) & (share < 0.8)
    rest_m = np.linalg.norm(mesh.positions[around] - at, axis=1)
    moved_m = np.linalg.norm(_posed({joint: turn})[around] - at, axis=1)
    assert around.sum() > 20
    assert (moved_m / rest_m).min() > kept
    assert (moved_m / rest_m).max() < 1.15


@pytest.mark.parametrize("turns", [PROTECT, WALK])
def test_the_shader_puts_the_skin_where_the_formula_says(renderer, turns):
    """The outline on the screen against vertices carried by numpy."""
    figure = person(turns)
    scene = Scene(figures=[figure], floor=FloorStyle(shown=False))
    camera = frame_all(orbit_camera((0.0, 0.0, 0.9), 40.0, 8.0, 4.0), extent_points(scene), SIZE)
    renderer.draw(scene, camera, SIZE)
    seen = renderer.read_rgb().astype(int)
    renderer.draw(Scene(floor=scene.floor), camera, SIZE)
    covered = np.abs(seen - renderer.read_rgb()).max(axis=2) > 6
    pixels = project(camera, _carried(_skin(), BODY, figure.positions, figure.orientations), SIZE)[0]
    for axis in (0, 1):
        there = np.flatnonzero(covered.any(axis=axis))
        assert there[0] == pytest.approx(pixels[:, axis].min(), abs=1.6)
        assert there[-1] + 1 == pytest.approx(pixels[:, axis].max(), abs=1.6)
    x, y = pixels.astype(int).T
    inside = covered[np.clip(y, 0, SIZE[1] - 1), np.clip(x, 0, SIZE[0] - 1)]
    assert inside.mean() > 0.93  # the rest lies on the outline's own pixels


def test_capsules_that_hide_the_sky_follow_the_joints():
    figure = person(STAND)
    spans = occluders([figure])[0].reshape(-1, 2, 4)
    assert len(spans) == 16
    for joint in (sk.LEFT_ELBOW, sk.RIGHT_KNEE, sk.BACK):
        assert np.linalg.norm(spans[:, :, :3] - figure.positions[joint], axis=2).min() == pytest.approx(0.0, abs=1e-9)
    assert (spans[:, 0, 3] > 0.02).all()
    assert spans[:, 0, 3].max() < 0.15


def test_a_mesh_is_sculpted_once_and_read_back_the_same(tmp_path, monkeypatch):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache"))
    first = cached_mesh(BODY, 2.8)
    made = []
    monkeypatch.setattr(mesh_cache, "mannequin_mesh", lambda *wishes: made.append(wishes) or _skin(2.8))
    again = cached_mesh(BODY, 2.8)
    assert not made
    for kept, fresh in zip(again, first, strict=True):
        assert (kept == fresh).all()
    assert cached_mesh(standard_body(1.6), 2.8) is not None
    assert len(made) == 1


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 half a file"])
def test_a_spoilt_or_unwritable_cache_costs_time_only(tmp_path, monkeypatch, damage):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(mesh_cache, "mannequin_mesh", lambda *wishes: _skin(2.8))
    folder = tmp_path / "cache" / "meshes"
    folder.mkdir(parents=True)
    (folder / f"{mesh_key(BODY, 2.8, 'smooth')}.npz").write_bytes(damage)
    assert len(cached_mesh(BODY, 2.8).triangles) > 1000
    assert len(os.listdir(folder)) == 1
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache" / "meshes" / os.listdir(folder)[0] / "no folder"))
    assert len(cached_mesh(BODY, 2.8).triangles) > 1000


def test_an_unknown_style_names_those_there_are():
    with pytest.raises(ValueError, match="smooth, jointed"):
        mannequin_mesh(BODY, 1.0, "cubist")
