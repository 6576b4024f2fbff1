"""A row (nv,): how fast something grows, by the velocities of a body. What stops and blows are reckoned in."""

from engine.maths.kernel import njit

MOST_ROWS = 48  # more stops than this at once are those of a body that is nowhere near a person's pose


@njit(cache=True)
def rate_of(row, qvel):
    """How fast what a row is of grows."""
    rate = 0.0
    for k in range(len(row)):
        rate += row[k] * qvel[k]
    return rate
