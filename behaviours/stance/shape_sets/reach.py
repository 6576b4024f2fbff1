"""Reaching (section 7, figure 1): four ways to the same target. They differ in their states, not only in numbers.

Each works for one hand or both; with one, `hand` is the side it is on. Without a target they are stances like any
other.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, changed, evenly, shape
from behaviours.stance.shape_sets import beauty_line
from behaviours.stance.torso import ALIGNED, LARGE_C, LARGE_S, OPPOSED, SMALL_C

# a spine without an opinion: it gives wherever the hand needs it
LOOSE = {
    "coronal": evenly(0.5, 4.0),
    "sagittal": evenly(0.5, 4.0),
    "transverse": evenly(0.3, 1.2),
    "collar_y": evenly(0.15, 0.6),
    "collar_z": evenly(0.1, 0.5),
    "abdomen_x": evenly(0.3, 1.0),
}


def hand(around: Around) -> float:
    """+1 when the left hand alone reaches, -1 the right one, 0 both or none."""
    left, right = around.reaching
    return float(left) - float(right)


def plain(intensity: float, around: Around) -> Shape:
    """The solver's own solution: natural enough, and says nothing."""
    return shape(
        sagittal_class=LARGE_C,
        coronal_class=LARGE_C,
        collar_y=OPPOSED if hand(around) else ALIGNED,
        solve_abdomen=True,
        wishes=LOOSE,
        gaze=0.6 * min(abs(intensity), 1.0),
    )


def with_beauty_line(intensity: float, around: Around) -> Shape:
    base = beauty_line.shape_of(intensity, around)
    return changed(base, collar_y=OPPOSED, solve_abdomen=True, gaze=0.6 * min(abs(intensity), 1.0))


def eager(intensity: float, around: Around) -> Shape:
    """The body goes along with the hand: chest out, weight forward, elbow wide."""
    a, side = intensity, hand(around)
    return shape(
        sagittal_class=LARGE_S,
        coronal_class=LARGE_C,
        collar_y=OPPOSED if side else ALIGNED,
        collar_z=ALIGNED,
        solve_abdomen=True,
        sagittal=1.2 * a,
        coronal=-0.5 * around.left * a,
        transverse_rad=-0.35 * side * a,
        collar_y_rad=-0.2 * side * a,
        pelvis_x_rad=0.15 * a,
        pelvis_y_rad=-0.2 * side * a,
        knee_left_rad=0.1 * max(a, 0.0),
        knee_right_rad=0.1 * max(a, 0.0),
        balance_z=0.6 * around.ahead * a,
        balance_x=0.4 * around.left * a,
        swivel_left_rad=0.3 * a,
        swivel_right_rad=0.3 * a,
        gaze=0.85 * min(abs(a), 1.0),
    )


def reluctant(intensity: float, around: Around) -> Shape:
    """Only the hand goes: the back curls away, the weight stays behind, the elbow near the body, the head turned
    off.
    """
    a, side = intensity, hand(around)
    return shape(
        sagittal_class=SMALL_C,
        coronal_class=LARGE_C,
        collar_y=OPPOSED if side else ALIGNED,
        collar_z=OPPOSED if side else ALIGNED,
        solve_abdomen=True,
        sagittal=1.2 * a,
        coronal=0.7 * around.left * a,
        abdomen_x_rad=-0.15 * a,
        transverse_rad=0.3 * side * a,
        collar_y_rad=0.15 * side * a,
        balance_z=-0.6 * around.ahead * a,
        balance_x=-0.5 * around.left * a,
        pelvis_x_rad=-0.12 * a,
        knee_left_rad=max(0.25 * a, 0.0),
        knee_right_rad=max(0.25 * a, 0.0),
        swivel_left_rad=-0.3 * a,
        swivel_right_rad=-0.3 * a,
        gaze=0.3 * min(abs(a), 1.0),
    )
