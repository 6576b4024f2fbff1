"""What a behaviour wants to show of what it believes: shapes in the world, as plain data, cleared by whoever draws.

Positions are world metres; colours are r, g, b, a in [0, 1]. A layer is a word ("com", "support") by which a panel can
show or hide a kind of marks.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

Colour = tuple[float, ...]  # r, g, b or r, g, b, a
WHITE: Colour = (1.0, 1.0, 1.0, 1.0)


class Line(NamedTuple):
    points_m: np.ndarray  # (2, 3)
    colour: np.ndarray  # (4,)
    layer: str


class Arrow(NamedTuple):
    points_m: np.ndarray  # (2, 3) tail, tip
    colour: np.ndarray
    layer: str


class Point(NamedTuple):
    position_m: np.ndarray  # (3,)
    radius_m: float
    colour: np.ndarray
    layer: str


class Polygon(NamedTuple):
    points_m: np.ndarray  # (N, 3), N >= 3, convex, in order
    colour: np.ndarray
    filled: bool
    layer: str


class Label(NamedTuple):
    position_m: np.ndarray  # (3,)
    text: str
    colour: np.ndarray
    layer: str


class DebugDraw:
    """The marks of one frame, in the order in which they were made."""

    def __init__(self) -> None:
        self.lines: list[Line] = []
        self.arrows: list[Arrow] = []
        self.points: list[Point] = []
        self.polygons: list[Polygon] = []
        self.labels: list[Label] = []

    def line(self, start_m: Any, end_m: Any, colour: Colour = WHITE, layer: str = "") -> None:
        self.lines.append(Line(_points((start_m, end_m)), _rgba(colour), layer))

    def polyline(self, points_m: Any, colour: Colour = WHITE, layer: str = "") -> None:
        """Lines from each point (N, 3) to the next: a path."""
        path = _points(points_m)
        for start_m, end_m in pairwise(path):
            self.line(start_m, end_m, colour, layer)

    def arrow(self, tail_m: Any, tip_m: Any, colour: Colour = WHITE, layer: str = "") -> None:
        self.arrows.append(Arrow(_points((tail_m, tip_m)), _rgba(colour), layer))

    def point(self, position_m: Any, radius_m: float = 0.02, colour: Colour = WHITE, layer: str = "") -> None:
        self.points.append(Point(_points((position_m,))[0], float(radius_m), _rgba(colour), layer))

    def polygon(self, points_m: Any, colour: Colour = WHITE, filled: bool = True, layer: str = "") -> None:
        """A convex polygon (N, 3) or, lying on the ground, (N, 2). Two corners make a line, fewer nothing."""
        corners = np.asarray(points_m, np.float64)
        if corners.shape[-1] == 2:
            corners = np.column_stack((corners, np.zeros(len(corners))))
        if len(corners) < 3:
            self.polyline(corners, colour, layer)
        else:
            self.polygons.append(Polygon(_points(corners), _rgba(colour), filled, layer))

    def label(self, position_m: Any, text: str, colour: Colour = WHITE, layer: str = "") -> None:
        self.labels.append(Label(_points((position_m,))[0], text, _rgba(colour), layer))

    def layers(self) -> list[str]:
        """Every layer that something was drawn on, sorted."""
        return sorted({mark.layer for marks in self._all() for mark in marks})

    def only(self, layers: Iterable[str]) -> DebugDraw:
        """The marks on these layers alone."""
        wanted, shown = frozenset(layers), DebugDraw()
        for marks, kept in zip(self._all(), shown._all(), strict=True):
            kept.extend(mark for mark in marks if mark.layer in wanted)
        return shown

    def clear(self) -> None:
        for marks in self._all():
            marks.clear()

    def _all(self) -> tuple[list[Any], ...]:
        return self.lines, self.arrows, self.points, self.polygons, self.labels


def _points(points_m: Any) -> np.ndarray:
    """(N, 3), copied: what is drawn must not change when the state that it was taken from does."""
    return np.array(points_m, np.float64).reshape(-1, 3)


def _rgba(colour: Colour) -> np.ndarray:
    return np.array(colour if len(colour) == 4 else (*colour, 1.0), np.float64)
