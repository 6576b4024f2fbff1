"""The penalty on a value that strays from the wanted one (section 5.2, figure 4): four cubic Hermite pieces, two on
either side.

On each side the first piece is the basin, from the wanted value to the basin's edge; the second is the wall, from
there to the far point, beyond which the penalty goes on straight. Smooth everywhere; flat basin: height 0; a certain
value: narrow basin, high wall; one side favoured: unequal sides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


class Side(NamedTuple):
    """One side of a penalty, measured away from the wanted value, in the value's own unit."""

    basin: float  # how wide the basin is
    basin_height: float  # the penalty at its edge
    far: float  # where the wall ends, beyond the basin
    far_height: float  # the penalty there


# slots of a penalty row; each side takes four from LOW or HIGH on
WANTED, LOW, HIGH = 0, 1, 5
ROW = 9


def row(wanted: float, low: Side, high: Side | None = None) -> np.ndarray:
    """A penalty as the kernels take it, (9,); without `high` both sides are alike. ValueError names a side that is
    none.
    """
    high = low if high is None else high
    for name, side in (("low", low), ("high", high)):
        if not 0.0 < side.basin < side.far or not 0.0 <= side.basin_height <= side.far_height:
            raise ValueError(f"{name} side {side}: expected 0 < basin < far and 0 <= basin_height <= far_height")
    return np.array([wanted, *low, *high], float)


@inner_kernel
def hermite(start, start_slope, end, end_slope, width, t):
    """Cubic Hermite interpolation over a stretch of a width: value and slope at both ends, t in [0, 1] along it."""
    t2 = t * t
    t3 = t2 * t
    return (
        (2.0 * t3 - 3.0 * t2 + 1.0) * start
        + (t3 - 2.0 * t2 + t) * width * start_slope
        + (3.0 * t2 - 2.0 * t3) * end
        + (t3 - t2) * width * end_slope
    )


@njit(cache=True)
def penalty_of(row, value):
    """The penalty (figure 4) of a value; 0 at the wanted one, never less."""
    stray = value - row[WANTED]
    side = HIGH
    if stray < 0.0:
        stray, side = -stray, LOW
    basin, basin_height, far, far_height = row[side], row[side + 1], row[side + 2], row[side + 3]
    # the slopes of parabolas, held to what keeps a cubic from rising over its end and falling back (Fritsch and
    # Carlson 1980)
    wall = (far_height - basin_height) / (far - basin)
    basin_slope = min(2.0 * basin_height / basin, 3.0 * wall)
    far_slope = max(2.0 * wall - basin_slope, wall)
    if stray <= basin:
        return hermite(0.0, 0.0, basin_height, basin_slope, basin, stray / basin)
    if stray <= far:
        t = (stray - basin) / (far - basin)
        return hermite(basin_height, basin_slope, far_height, far_slope, far - basin, t)
    return far_height + far_slope * (stray - far)
