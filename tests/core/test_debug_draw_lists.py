"""The marks that behaviours leave for the picture."""

from __future__ import annotations

import numpy as np

from engine.core.debug_draw import DebugDraw

RED = (1.0, 0.0, 0.0)


def test_marks_are_plain_arrays_with_colours():
    draw = DebugDraw()
    draw.line((0, 0, 0), (1, 0, 0), RED, "path")
    draw.polyline([(0, 0, 0), (0, 0, 1), (0, 1, 1)])
    draw.arrow((0, 0, 0), (0, 0, 1), (0.0, 1.0, 0.0, 0.5))
    draw.point((1, 2, 3), 0.05)
    draw.label((1, 2, 3), "head")
    ends_m = [line.points_m.tolist() for line in draw.lines]
    assert ends_m == [[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 0, 1]], [[0, 0, 1], [0, 1, 1]]]
    assert [line.colour.tolist() for line in draw.lines] == [[1, 0, 0, 1], [1, 1, 1, 1], [1, 1, 1, 1]]
    assert draw.arrows[0].points_m.tolist() == [[0, 0, 0], [0, 0, 1]]
    assert draw.arrows[0].colour.tolist() == [0, 1, 0, 0.5]
    assert (draw.points[0].radius_m, draw.points[0].position_m.tolist()) == (0.05, [1, 2, 3])
    assert draw.labels[0].text == "head"


def test_a_polygon_on_the_ground_and_one_that_has_collapsed():
    draw = DebugDraw()
    draw.polygon([(0, 0), (1, 0), (1, 1)], layer="support")
    assert draw.polygons[0].points_m.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    draw.polygon([(0, 0), (1, 0)])
    assert (len(draw.polygons), len(draw.lines)) == (1, 1)
    draw.polygon([(0, 0)])
    draw.polygon(np.zeros((0, 2)))
    assert (len(draw.polygons), len(draw.lines)) == (1, 1)


def test_a_mark_does_not_follow_the_state_that_it_was_taken_from():
    draw, position_m = DebugDraw(), np.zeros(3)
    draw.point(position_m)
    draw.line(position_m, position_m)
    position_m[:] = 9
    assert not draw.points[0].position_m.any()
    assert not draw.lines[0].points_m.any()


def test_layers_are_shown_and_hidden_by_name():
    draw = DebugDraw()
    draw.point((0, 0, 0), layer="com")
    draw.line((0, 0, 0), (1, 1, 1), layer="support")
    draw.label((0, 0, 0), "x", layer="com")
    assert draw.layers() == ["com", "support"]
    shown = draw.only(["com"])
    assert (len(shown.points), len(shown.lines), len(shown.labels)) == (1, 0, 1)
    draw.clear()
    assert draw.layers() == []
    assert len(shown.points) == 1
