"""The head: it must be plain where it looks."""

from __future__ import annotations

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.render.sculpture.parts import SHELL, VISOR, Part
from engine.render.surface import Shape, blend, both_sides, carve, ellipsoid, taper

ENLARGED = 1.04  # a little large, as sculptors make it: it carries the expression


def head_parts(body: Body) -> list[Part]:
    """The head; a dark visor for eyes."""
    head, whole = skull_and_face(body)
    return [
        Part(sk.HEAD, SHELL, whole, 0.0118, 0.018),
        Part(sk.HEAD, VISOR, visor(head, body.head_top_m), 0.006, 0.009),
    ]


def skull_and_face(body: Body) -> tuple[Shape, Shape]:
    """Skull, face and jaw with brow and chin; the same with nose and ears. In the head's frame."""
    crown = body.head_top_m

    def at(forward: float, left: float, below: float) -> np.ndarray:
        return crown + np.array([forward, left, -below]) * ENLARGED

    skull = ellipsoid(at(-0.006, 0, 0.092), _large(0.098, 0.077, 0.092))
    face = taper(at(0.034, 0, 0.112), at(0.050, 0, 0.176), ENLARGED * 0.061, ENLARGED * 0.039, flat=(1.0, 0.97, 1.0))
    jaw = taper(at(0.004, 0, 0.155), at(0.058, 0, 0.196), ENLARGED * 0.052, ENLARGED * 0.023, flat=(1.0, 0.96, 1.0))
    brow = ellipsoid(at(0.080, 0, 0.082), _large(0.013, 0.052, 0.010))
    nose = taper(at(0.088, 0, 0.124), at(0.102, 0, 0.149), ENLARGED * 0.008, ENLARGED * 0.011)
    ears = both_sides(ellipsoid(at(-0.008, 0.074, 0.118), _large(0.019, 0.010, 0.030)))
    head = blend(0.02, blend(0.03, skull, face, jaw), brow)
    return head, blend(0.012, head, nose, ears)


def visor(head: Shape, crown: np.ndarray) -> Shape:
    """Glass that lies on the face, a few millimetres thick, within the outline of the lens."""
    glass = Shape(lambda points: head.field(points) - 0.0036, head.low - 0.004, head.high + 0.004)
    return carve(0.006, glass, lambda points: -outside_lens(points, crown))


def outside_lens(points: np.ndarray, crown: np.ndarray) -> np.ndarray:
    """(N, 3) -> (N,) positive outside the outline, which wraps the eyes from temple to temple, rising over the nose."""
    place = (points - crown) / ENLARGED
    middle, half_height, half_width = -0.112, 0.0255, 0.0765
    over_nose = 0.009 * np.exp(-np.minimum((place[:, 1] / 0.016) ** 2, 40.0))
    height = half_height - np.where(place[:, 2] < middle, over_nose, 0.0)
    lens = ((place[:, 1] / half_width) ** 4 + ((place[:, 2] - middle) / height) ** 4) ** 0.25
    return np.maximum((lens - 1.0) * half_height, 0.015 - place[:, 0])


def _large(*lengths: float) -> np.ndarray:
    return ENLARGED * np.array(lengths)
