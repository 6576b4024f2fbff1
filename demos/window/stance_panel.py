"""The Stance panel (stance paper, 3): set, intensity and object above; every parameter below, with its range.

The stance stands beside the selected character. What it is about, and what its hands reach for, are dragged in the
picture. A shape is saved and loaded as TOML, and can be worn by the character.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from behaviours.stance.measures import measures
from behaviours.stance.shape import ALLOWED, RANGES, Numbers
from behaviours.stance.shape_sets import SETS
from behaviours.stance.solve import StanceResult
from demos.window.saving import free_name
from demos.window.stance_desk import FARTHEST_M, POINTS, StanceDesk, in_groups
from engine.core.debug_draw import DebugDraw
from engine.core.errors import BraceError
from engine.maths import quaternion, rotations
from engine.render.camera import ray_through
from engine.render.events import LEFT_BUTTON, Event, MouseButton, MouseMove
from engine.render.scene import Balance, Colour, Figure, Scene

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

STANCE: Colour = (0.62, 0.70, 0.80)
DOT_COLOURS = {"object_m": (0.85, 0.12, 0.10), "reach_left_m": (0.13, 0.46, 0.38), "reach_right_m": (0.13, 0.46, 0.38)}
DOT_M, GRIP_M = 0.045, 0.10  # radius of a dot, and how near to it the cursor has to look to grip it
BESIDE_M = 1.2  # to the right of the character, as it is seen
# shown while the first stance is worked out: its code is loaded, and right after set-up perhaps still to be compiled
FIRST = "Getting ready, once: a second, or right after set-up up to a minute."
LABELS = {"solve_abdomen": "Abdomen helps", "collar_y": "Collars, Y", "collar_z": "Collars, Z"}


class StancePanel:
    """A stance to explore, beside the character."""

    title = "Stance"

    def __init__(self) -> None:
        self.desk = StanceDesk()
        self.file = ""
        self._gripped: str | None = None
        self._place: tuple[np.ndarray, float] | None = None  # where it stands (2,), and its heading
        self._announced = False

    # --- widgets -------------------------------------------------------------------------------------------------

    def draw(self, ui: Ui, session: Session) -> None:
        if not self._announced:
            self._announced = True
            ui.text(FIRST)
            return
        self._stand_beside(session)
        self._draw_above(ui)
        self._draw_report(ui, session)
        self._draw_files(ui, session)
        ui.gap()
        self._draw_below(ui, session)

    def _draw_above(self, ui: Ui) -> None:
        desk = self.desk
        ui.heading("A shape set")
        chosen = ui.choice("Set", desk.set_name, tuple(SETS))
        if chosen != desk.set_name:
            desk.choose_set(chosen)
        ui.text(SETS[desk.set_name].meaning, faint=True)
        low, high = desk.intensities
        intensity = ui.slider("How much", desk.intensity, low, high, help="1 is a full instance; past it, extrapolated")
        if intensity != desk.intensity:
            desk.change_intensity(intensity)
        for name, words in POINTS.items():
            wanted = ui.toggle(words, desk.used[name], help="drag its dot in the picture")
            if wanted != desk.used[name]:
                desk.use(name, wanted)
            if desk.used[name] and ui.folded(f"{words}: where"):
                self._draw_point(ui, name, words)
        if desk.tuned is not None:
            ui.text("Fine-tuned below.", faint=True)
            if ui.button("Back to the set"):
                desk.tuned = None

    def _draw_point(self, ui: Ui, name: str, words: str) -> None:
        with ui.scope(name):
            place = self.desk.points_m[name]
            wanted = [
                ui.slider(f"{words}, {axis}", float(value), 0.0 if axis == "up" else -FARTHEST_M, FARTHEST_M, "m")
                for axis, value in zip(("ahead", "left", "up"), place, strict=True)
            ]
            if wanted != place.tolist():
                self.desk.move(name, wanted)

    def _draw_report(self, ui: Ui, session: Session) -> None:
        result = self.desk.solve(session.body)
        found = measures(session.body, result)
        words = [f"balance {1000.0 * found.balance_error_m:.1f} mm off, {100.0 * found.margin_m:.0f} cm inside"]
        words += [
            f"{side} wrist " + ("on its target" if miss < 1e-3 else f"{100.0 * miss:.1f} cm short of its target")
            for side, miss, on in zip(("left", "right"), result.wrist_error_m, result.plan.reaching, strict=True)
            if on
        ]
        if result.kept < 1.0:
            words.append(f"the legs allow {100.0 * result.kept:.0f} % of the lower body's wishes")
        ui.text("; ".join(words), faint=True, alarm=found.margin_m < 0.0)

    def _draw_files(self, ui: Ui, session: Session) -> None:
        if ui.button("Wear it", help="the selected character wears this shape under everything it does"):
            session.change_character(stance=self.worn(session))
        ui.beside()
        if ui.button("Stand here", help="beside the character as it is now"):
            self._place = None
        ui.beside()
        if ui.button("Save shape", help="a .toml that `brace stance` shows, too"):
            self._guarded(session, self.save)
        self.file = ui.entry("Shape file", self.file, "a shape's .toml")
        if ui.button("Load shape", enabled=bool(self.file)) and self.file:
            self._guarded(session, self.load)

    def _draw_below(self, ui: Ui, session: Session) -> None:
        desk, body = self.desk, session.body
        if ui.folded("States"):
            states = desk.shape(body).states._asdict()
            for name, allowed in ALLOWED.items():
                label = LABELS.get(name, name.replace("_", " ").capitalize())
                wanted = (
                    ui.toggle(label, bool(states[name]), help="the solver may tip the whole torso")
                    if name == "solve_abdomen"
                    else ui.choice(label, str(states[name]), tuple(str(word) for word in allowed))
                )
                if wanted != states[name]:
                    desk.tune(body, name, wanted)
        for part, names in in_groups().items():
            if ui.folded(part):
                for name in names:
                    self._draw_number(ui, session, name)

    def _draw_number(self, ui: Ui, session: Session, name: str) -> None:
        """Angles in degrees, as people say them."""
        span, now = RANGES[name], float(getattr(self.desk.shape(session.body).numbers, name))
        scale = 180.0 / math.pi if name.endswith("_rad") else 1.0
        unit = "deg" if name.endswith("_rad") else "m" if name.endswith("_m") else ""
        low, high = min(span.low, now), max(span.high, now)
        label = name.removesuffix("_rad").removesuffix("_m").replace("_", " ").capitalize()
        digits = 0 if unit == "deg" else 2
        wanted = ui.slider(label, scale * now, scale * low, scale * high, unit, digits=digits, help=span.meaning)
        if abs(wanted - scale * now) > 1e-9:
            self.desk.tune(session.body, name, wanted / scale)

    # --- what its buttons do -------------------------------------------------------------------------------------

    def worn(self, session: Session) -> dict:
        """The `stance` of a scenario's character: by its set where it is one's, else by its shape."""
        desk = self.desk
        if desk.tuned is None and not any(desk.used.values()) and abs(desk.intensity) <= 2.0:
            return {"set": desk.set_name, "intensity": desk.intensity}
        made = desk.shape(session.body)
        neutral = Numbers()._asdict()
        numbers = {name: value for name, value in made.numbers._asdict().items() if value != neutral[name]}
        return {"intensity": 1.0, "shape": {**made.states._asdict(), **numbers}}

    def save(self, session: Session) -> None:
        path = free_name(session.save_in, "stance", ".toml")
        self.desk.save(session.body, path)
        self.file = str(path)
        session.say(f"saved {path}")

    def load(self, session: Session) -> None:
        path = Path(self.file).expanduser()
        self.desk.load(path if path.is_absolute() else session.save_in / path)
        session.say(f"loaded {path}")

    def _guarded(self, session: Session, action) -> None:
        try:
            action(session)
        except BraceError as trouble:
            session.say(trouble.line(), alarm=True)

    # --- in the picture ------------------------------------------------------------------------------------------

    def drawn_into(self, scene: Scene, session: Session) -> None:
        """The stance, its balance, and a dot for each point."""
        if not self._announced:
            return
        self._stand_beside(session)
        result, body = self.desk.solve(session.body), session.body
        turn = self._turn()
        scene.figures.append(
            Figure(body, self.world_of(result.joints_m), rotations.multiply(turn, result.orientations), STANCE)
        )
        scene.balances.append(self._balance(body, result))
        scene.draw = scene.draw or DebugDraw()
        for name in POINTS:
            if self.desk.used[name]:
                scene.draw.point(self.world_of(self.desk.points_m[name]), DOT_M, DOT_COLOURS[name], "stance")

    def _balance(self, body, result: StanceResult) -> Balance:
        found = measures(body, result)
        corners = np.column_stack([found.support_m, np.zeros(len(found.support_m))])
        wanted = self.world_of((*result.plan.balance_m, 0.0))[:2]
        return Balance(self.world_of(corners)[:, :2], self.world_of(result.com_m), wanted, STANCE)

    def world_of(self, points_m) -> np.ndarray:
        """Points (..., 3) of the stance's frame in the world."""
        assert self._place is not None
        place, _ = self._place
        return rotations.rotate(self._turn(), np.asarray(points_m, float)) + (*place, 0.0)

    def frame_of(self, point_m) -> np.ndarray:
        """A world point (3,) in the stance's frame: the inverse of `world_of`."""
        assert self._place is not None
        away = np.asarray(point_m, float) - (*self._place[0], 0.0)
        return rotations.rotate(rotations.conjugate(self._turn()), away)

    def _turn(self) -> np.ndarray:
        assert self._place is not None
        return np.array(quaternion.about_z(self._place[1]))

    def _stand_beside(self, session: Session) -> None:
        if self._place is None:
            positions, orientations = session.frames(session.row)
            heading = float(quaternion.heading(orientations[0]))
            right, _, _ = session.camera.axes()
            self._place = (positions[0, :2] + BESIDE_M * right[:2], heading)

    def handle(self, event: Event, session: Session) -> bool:
        """A dot is gripped, dragged in the plane of the picture, and let go."""
        if self._place is None:
            return False
        if isinstance(event, MouseButton) and event.button == LEFT_BUTTON and not event.modifiers:
            was, self._gripped = self._gripped, self._under(event, session) if event.pressed else None
            return self._gripped is not None or (was is not None and not event.pressed)
        if isinstance(event, MouseMove) and self._gripped is not None:
            eye, way = ray_of(event, session)
            _, _, forward = session.camera.axes()
            here = self.world_of(self.desk.points_m[self._gripped])
            depth = float((here - eye) @ forward)
            self.desk.move(self._gripped, self.frame_of(eye + way * (depth / max(float(way @ forward), 1e-6))))
            return True
        return False

    def _under(self, event: MouseButton, session: Session) -> str | None:
        """The point whose dot was pressed on, the nearest if there are several."""
        eye, way = ray_of(event, session)
        found: list[tuple[float, str]] = []
        for name in POINTS:
            if self.desk.used[name]:
                away = self.world_of(self.desk.points_m[name]) - eye
                depth = float(away @ way)
                if depth > 0.0 and float(np.linalg.norm(away - depth * way)) < GRIP_M:
                    found.append((depth, name))
        return min(found)[1] if found else None

    # --- from one start to the next ------------------------------------------------------------------------------

    def memory(self) -> dict:
        return {"set": self.desk.set_name, "intensity": self.desk.intensity, "file": self.file}

    def remember(self, kept: dict) -> None:
        if kept.get("set") in SETS:
            self.desk.choose_set(kept["set"])
        intensity, (low, high) = kept.get("intensity"), self.desk.intensities
        if isinstance(intensity, int | float) and low <= intensity <= high:
            self.desk.change_intensity(float(intensity))
        if isinstance(kept.get("file"), str):
            self.file = kept["file"]


def ray_of(event: MouseButton | MouseMove, session: Session) -> tuple[np.ndarray, np.ndarray]:
    """Where an event looks: the cursor may have gone on since, within the same frame."""
    eye, way = ray_through(session.camera, (event.x_px, event.y_px), session.size_px)
    return np.asarray(eye), np.asarray(way)
