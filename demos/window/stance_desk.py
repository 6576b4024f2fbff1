"""What the Stance panel works on, without a window: a stance by set, intensity and object, or by every parameter.

The character of it stands over the origin of its own frame, facing +X; points are metres ahead, left and up of there.
Whatever is set above (set, intensity, points) makes the shape anew; whatever is set below fine-tunes the shape that is
there (section 3: the animator can always switch to the low-level interface).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from behaviours.stance import footprints
from behaviours.stance.around import look_around
from behaviours.stance.shape import ALLOWED, RANGES, Shape, changed, within
from behaviours.stance.shape_file import SavedShape, read_shape, shape_text
from behaviours.stance.shape_sets import SETS, shape_of
from behaviours.stance.solve import StanceResult, solve_shape
from engine.body.skeleton import Body
from engine.core.files import write_atomically

POINTS = {"object_m": "Object", "reach_left_m": "Left wrist's target", "reach_right_m": "Right wrist's target"}
START_M = {"object_m": (0.9, 0.4, 1.25), "reach_left_m": (0.42, 0.25, 1.3), "reach_right_m": (0.42, -0.25, 1.3)}
FARTHEST_M = 3.0


class StanceDesk:
    """One stance being worked on."""

    def __init__(self) -> None:
        self.set_name, self.intensity = "posture", 0.6
        self.points_m = {name: np.array(place) for name, place in START_M.items()}
        self.used = {"object_m": False, "reach_left_m": False, "reach_right_m": False}
        self.tuned: Shape | None = None  # the shape where it is not that of the set any more
        self._solved: tuple[object, Body, StanceResult] | None = None

    # --- above: set, intensity, points ---------------------------------------------------------------------------

    def choose_set(self, name: str) -> None:
        """Another set, as much of it as it was made for; with what it is about, if it needs that."""
        entry = SETS[name]
        self.set_name, self.tuned = name, None
        self.intensity = min(max(self.intensity, entry.low), entry.high)
        if entry.needs_object:
            self.used["object_m"] = True
        if name.startswith("reach") and not self.reaching:
            self.used["reach_right_m"] = True

    def change_intensity(self, value: float) -> None:
        self.intensity, self.tuned = value, None

    def use(self, name: str, wanted: bool) -> None:
        """Whether one of POINTS is there."""
        self.used[name], self.tuned = wanted, None

    def move(self, name: str, place_m) -> None:
        """One of POINTS goes elsewhere, not into the ground nor out of sight. Fine tuning stays."""
        x, y, z = np.clip(np.asarray(place_m, float), -FARTHEST_M, FARTHEST_M)
        self.points_m[name] = np.array([x, y, max(z, 0.02)])

    @property
    def reaching(self) -> bool:
        return self.used["reach_left_m"] or self.used["reach_right_m"]

    @property
    def intensities(self) -> tuple[float, float]:
        """What the slider offers: the set's own range, and half of it beyond (section 6, extrapolation)."""
        entry = SETS[self.set_name]
        return 1.5 * entry.low, 1.5 * entry.high

    # --- below: every parameter ----------------------------------------------------------------------------------

    def shape(self, body: Body) -> Shape:
        """The shape as it is now."""
        return self.tuned if self.tuned is not None else self.shape_of_set(body)

    def shape_of_set(self, body: Body) -> Shape:
        """What set, intensity and points make."""
        reaching = (self.used["reach_left_m"], self.used["reach_right_m"])
        around = look_around(body, footprints.stand(body), self._looked_at(), reaching)
        return shape_of(self.set_name, self.intensity, around)

    def tune(self, body: Body, name: str, value) -> None:
        """One state or number of the shape; numbers are held in their ranges."""
        allowed = value if name in ALLOWED else within(name, float(value))
        self.tuned = changed(self.shape(body), **{name: allowed})

    def solve(self, body: Body) -> StanceResult:
        """The stance, solved anew only where something changed."""
        wanted, points = self.shape(body), {name: tuple(self.points_m[name]) for name in POINTS if self.used[name]}
        key = (wanted, tuple(points.items()))
        if self._solved is None or self._solved[0] != key or self._solved[1] is not body:
            reach = (points.get("reach_left_m"), points.get("reach_right_m"))
            result = solve_shape(body, wanted, reach_m=reach, look_at_m=self._looked_at())
            self._solved = (key, body, result)
        return self._solved[2]

    def _looked_at(self):
        """The object; where there is none, a wrist's target."""
        return next((self.points_m[name] for name in POINTS if self.used[name]), None)

    # --- files ---------------------------------------------------------------------------------------------------

    def save(self, body: Body, path: Path) -> None:
        """As TOML, whole or not at all. EnvironmentTrouble where it cannot be."""
        points = {name: (float(x), float(y), float(z)) for name, (x, y, z) in self.points_m.items() if self.used[name]}
        write_atomically(path, shape_text(SavedShape(self.shape(body), points)).encode())

    def load(self, path: Path) -> None:
        """A file's shape and points, fine-tuned from then on. BadInput, and nothing changed, where it is none."""
        saved = read_shape(path)
        held = {name: within(name, value) for name, value in saved.shape.numbers._asdict().items()}
        self.tuned = changed(saved.shape, **held)
        for name in POINTS:
            self.used[name] = name in saved.points
            if name in saved.points:
                self.move(name, saved.points[name])


def in_groups() -> dict[str, tuple[str, ...]]:
    """The numbers of a shape by the part of the body: every one once."""
    parts = {
        "Torso": ("coronal", "sagittal", "transverse", "collar", "abdomen"),
        "Pelvis, legs and balance": ("pelvis", "balance", "knee", "rise", "width"),
        "Left arm": ("arm_out_left", "arm_forward_left", "arm_turn_left", "elbow_left", "swivel_left", "palm_left"),
        "Right arm": (
            "arm_out_right", "arm_forward_right", "arm_turn_right", "elbow_right", "swivel_right", "palm_right",
        ),
        "Head": ("gaze",),
    }  # fmt: skip
    return {part: tuple(name for name in RANGES if name.startswith(begins)) for part, begins in parts.items()}
