"""The jointed figure and the sculptor's tools: closed surfaces, the subject's own proportions, left and right alike."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.body import skeleton as sk
from engine.body.anthropometry import make_body, standard_body
from engine.render.mannequin import (
    REFERENCE_STATURE_M,
    mannequin_mesh,
    mannequin_parts,
    rest_positions,
    scaled,
    stature_m,
)
from engine.render.surface import ball, blend, carve, ellipsoid, half_space, mesh, taper, without_buried


def _area_and_volume(piece) -> tuple[float, float]:
    a, b, c = (piece.vertices[piece.triangles[:, k]] for k in range(3))
    crossed = np.cross(b - a, c - a)
    return 0.5 * np.linalg.norm(crossed, axis=1).sum(), (a * crossed).sum() / 6.0


def _closed(piece) -> bool:
    """Every side of every triangle is met by as many neighbours going the other way."""
    sides = np.concatenate([piece.triangles[:, [0, 1]], piece.triangles[:, [1, 2]], piece.triangles[:, [2, 0]]])
    there = {tuple(side): count for side, count in zip(*np.unique(sides, axis=0, return_counts=True), strict=True)}
    return all(there.get((b, a)) == count for (a, b), count in there.items())


def test_a_meshed_ball_has_a_balls_area_volume_and_normals():
    piece = mesh(ball((0.1, -0.2, 0.3), 0.25), 0.02)
    area, volume = _area_and_volume(piece)
    assert area == pytest.approx(4 * math.pi * 0.25**2, rel=0.01)
    assert volume == pytest.approx(4 / 3 * math.pi * 0.25**3, rel=0.01)  # positive: triangles face outwards
    assert piece.normals == pytest.approx((piece.vertices - (0.1, -0.2, 0.3)) / 0.25, abs=1e-3)


def test_a_taper_is_two_balls_and_the_cone_that_touches_both():
    shape = taper((0, 0, 0), (0, 0, 1.0), 0.3, 0.1)
    slope = math.asin(0.2)  # of the cone's side
    on_side = np.array([0.3 * math.cos(slope), 0, 0.3 * math.sin(slope)])
    along = np.array([-math.sin(slope), 0, math.cos(slope)])
    points = np.array([(0, 0, -0.3), (0, 0, 1.1), on_side, on_side + 0.5 * along])
    assert shape.field(points) == pytest.approx(np.zeros(4), abs=1e-3)


def test_blends_only_add_and_cuts_only_remove():
    one, other = ball((0, 0, 0), 0.2), ellipsoid((0.25, 0, 0), (0.2, 0.1, 0.1), 2.5)
    points = np.random.default_rng(2).uniform(-0.5, 0.5, (500, 3))
    both = blend(0.1, one, other)
    assert (both.field(points) <= np.minimum(one.field(points), other.field(points)) + 1e-12).all()
    flat = carve(0.02, one, half_space((0, 0, -0.1), (0, 0, 1)))
    assert (flat.field(points) >= one.field(points) - 1e-12).all()
    assert mesh(flat, 0.02).vertices[:, 2].min() == pytest.approx(-0.1, abs=0.003)


def test_burying_drops_only_what_lies_inside():
    piece = mesh(ball((0, 0, 0), 0.2), 0.02)
    kept = without_buried(piece, [ball((0.2, 0, 0), 0.15)])
    assert 0 < len(kept.vertices) < len(piece.vertices)
    assert (ball((0.2, 0, 0), 0.15).field(kept.vertices) > -0.03).all()


@pytest.mark.parametrize("body", [standard_body(), standard_body(1.55, "female"), standard_body(1.95)])
@pytest.mark.parametrize("coarser", [1.0, 2.0])
def test_every_part_is_closed_and_where_its_field_says(body, coarser):
    for part in mannequin_parts(scaled(body, REFERENCE_STATURE_M / stature_m(body))):
        piece = mesh(part.shape, min(coarser * part.cell_m, part.coarsest_m))
        assert _closed(piece)
        assert _area_and_volume(piece)[1] > 0
        assert np.abs(part.shape.field(piece.vertices)).max() < 2e-4
        assert np.isfinite(piece.normals).all()


@pytest.mark.parametrize("height_m", [1.5, 1.75, 2.0])
def test_it_is_as_tall_as_the_body_and_stands_on_its_soles(height_m):
    body = standard_body(height_m)
    heights = mannequin_mesh(body, style="jointed").positions[:, 2]
    assert stature_m(body) == pytest.approx(height_m, abs=0.02)
    assert np.ptp(heights) == pytest.approx(height_m, abs=0.02)
    rest = rest_positions(body)
    soles = rest[sk.LEFT_ANKLE][2] + body.sole_m[0, :4, 2].min()
    assert heights.min() == pytest.approx(soles, abs=0.003)


def test_proportions_are_a_persons():
    body = standard_body()
    mesh_ = mannequin_mesh(body, style="jointed")
    where, joint = mesh_.positions, mesh_.joints[:, 0]
    width = {
        name: np.ptp(where[np.isin(joint, rows), 1])
        for name, rows in {"trunk": (2,), "hips": (0, 13, 17), "head": (4,)}.items()
    }
    shoulders = np.ptp(where[np.isin(joint, (6, 10)), 1])
    assert 0.40 < shoulders < 0.52
    assert width["head"] < width["hips"] < shoulders
    head_m = np.ptp(where[(joint == sk.HEAD), 2])
    assert 7.0 < 1.75 / head_m < 8.2  # heads to a figure: artists draw seven and a half


def test_the_face_looks_ahead():
    mesh_ = mannequin_mesh(standard_body(), style="jointed")
    head = mesh_.positions[mesh_.joints[:, 0] == sk.HEAD]
    visor = mesh_.positions[mesh_.paint_m[:, 1] < 0]
    nose = head[head[:, 0].argmax()]
    assert abs(nose[1]) < 0.008
    assert visor[:, 0].min() > head[:, 0].min() + 0.10
    assert visor[:, 2].min() < nose[2] + 0.04 < visor[:, 2].max() + 0.04


def test_left_and_right_are_mirror_images():
    parts = mannequin_parts(standard_body())
    for part in parts:
        there = [p for p in parts if (p.joint, p.material) == (sk.MIRRORED[part.joint], part.material)]
        mirrored = mesh(part.shape, part.cell_m).vertices * (1, -1, 1)
        assert min(np.abs(other.shape.field(mirrored)).max() for other in there) < 2e-4


def test_a_longer_forearm_makes_a_longer_forearm_and_nothing_else():
    body = standard_body()
    offset = body.offset_m.copy()
    offset[sk.LEFT_WRIST] *= 1.2
    longer, before = (_spans(mannequin_mesh(made, style="jointed")) for made in (make_body(offset), body))
    for joint in range(sk.JOINT_COUNT):
        assert longer[joint][2] == pytest.approx(before[joint][2] * (1.2 if joint == sk.LEFT_ELBOW else 1.0), rel=0.06)


def test_coarser_meshes_have_far_fewer_triangles_and_the_same_outline():
    fine, coarse = (mannequin_mesh(standard_body(), coarser, "jointed") for coarser in (1.0, 1.8))
    assert len(coarse.triangles) < 0.4 * len(fine.triangles)
    assert _spans(coarse) == pytest.approx(_spans(fine), rel=0.07)


def test_joints_have_balls_that_the_next_bone_turns_in():
    body = standard_body()
    mesh_ = mannequin_mesh(body, style="jointed")
    for joint in (*sk.ELBOWS, *sk.KNEES, *sk.ANKLES, *sk.WRISTS):
        near = mesh_.positions[(mesh_.joints[:, 0] == joint) & (mesh_.paint_m[:, 0] < 0)]
        distances = np.linalg.norm(near - rest_positions(body)[joint], axis=1)
        assert np.ptp(distances) < 0.012


def _spans(mesh_) -> np.ndarray:
    """(21, 3) sizes of what each joint carries, metres."""
    return np.array([np.ptp(mesh_.positions[mesh_.joints[:, 0] == joint], axis=0) for joint in range(sk.JOINT_COUNT)])
