"""How a number of a shape follows the intensity: not everything changes at the same pace (section 6)."""

from __future__ import annotations


def late(intensity: float, start: float) -> float:
    """0 up to a start, then in earnest: 1 at intensity 1, no kink at the start, straight on past 1."""
    if intensity <= start:
        return 0.0
    t = (intensity - start) / (1.0 - start)
    return t * t if t <= 1.0 else 2.0 * t - 1.0


def early(intensity: float) -> float:
    """Most of it soon: half at 0.3, 1 at 1, levelling off towards 1.4 beyond."""
    a = abs(intensity)
    return (1.0 if intensity >= 0.0 else -1.0) * 1.4 * a / (a + 0.4)


def soft_positive(intensity: float, width: float = 0.15) -> float:
    """max(intensity, 0) with a rounded corner: what only one sign of the intensity has."""
    if intensity <= -width:
        return 0.0
    if intensity >= width:
        return intensity
    return (intensity + width) ** 2 / (4.0 * width)
