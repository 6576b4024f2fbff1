"""The penalty of figure 4, against SciPy's Hermite splines, and the three features that the paper asks of it."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from behaviours.stance import penalty
from behaviours.stance.penalty import Side

lengths = st.floats(0.01, 2.0).map(lambda x: round(x, 6))
heights = st.floats(0.0, 3.0).map(lambda x: round(x, 6))


@st.composite
def rows(draw):
    sides = []
    for _ in range(2):
        basin, low = draw(lengths), draw(heights)
        sides.append(Side(basin, low, basin + draw(lengths), low + draw(heights)))
    return penalty.row(draw(st.floats(-2.0, 2.0).map(lambda x: round(x, 6))), *sides)


@given(rows(), st.floats(-6.0, 6.0).map(lambda x: round(x, 9)))
def test_zero_only_at_the_wanted_value_and_never_less(row, value):
    assert penalty.penalty_of(row, row[0]) == 0.0
    assert penalty.penalty_of(row, value) >= 0.0


@given(rows(), st.floats(0.0, 5.0).map(lambda x: round(x, 9)), heights, st.sampled_from((1.0, -1.0)))
def test_never_falls_on_the_way_out(row, far, more, way):
    nearer = penalty.penalty_of(row, row[0] + way * far)
    assert penalty.penalty_of(row, row[0] + way * (far + more)) >= nearer - 1e-9


@given(rows(), st.sampled_from((1.0, -1.0)))
def test_smooth_where_the_pieces_meet(row, way):
    basin, _, far, _ = row[5:9] if way > 0 else row[1:5]
    assume(far - basin > 0.02 and basin > 0.02)
    for place in (0.0, basin, far):
        step = 1e-6
        values = [penalty.penalty_of(row, row[0] + way * (place + k * step)) for k in (-1, 0, 1)]
        curvature = (values[2] - 2.0 * values[1] + values[0]) / step**2
        steepest = max(
            row[2] / row[1] ** 2,
            row[6] / row[5] ** 2,
            *((row[k + 3] - row[k + 1]) / (row[k + 2] - row[k]) ** 2 for k in (1, 5)),
        )
        assert abs(curvature) < 20.0 * steepest + 1.0  # a kink would be a thousand times that


def test_the_pieces_are_cubic_hermite():
    row = penalty.row(0.5, Side(0.2, 0.1, 1.0, 2.0))
    slopes = [0.0, 2 * 0.1 / 0.2, 2 * (1.9 / 0.8) - 1.0]
    reference = CubicHermiteSpline([0.0, 0.2, 1.0], [0.0, 0.1, 2.0], slopes)
    for stray in np.linspace(0.0, 1.0, 21):
        for way in (1, -1):
            assert penalty.penalty_of(row, 0.5 + way * stray) == pytest.approx(float(reference(stray)), abs=1e-12)


def test_flat_basin_steep_wall_and_a_favoured_side():
    row = penalty.row(0.0, Side(0.5, 0.0, 0.6, 1.0), Side(0.01, 0.0, 0.02, 1.0))
    assert penalty.penalty_of(row, -0.4) == 0.0
    assert penalty.penalty_of(row, -0.7) > 1.0
    assert penalty.penalty_of(row, 0.1) > 10.0


@pytest.mark.parametrize("side", [Side(0.0, 0.0, 1.0, 1.0), Side(0.5, 0.0, 0.5, 1.0), Side(0.1, 0.5, 1.0, 0.2)])
def test_a_side_that_is_none_is_refused(side):
    with pytest.raises(ValueError, match="expected 0 < basin < far"):
        penalty.row(0.0, side)
