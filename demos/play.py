"""A scenario to play with: what each key does, throwing at what is under the cursor, going back in time.

It is a `Show` for `engine.render.loop`: events come in, ticks are run, a scene goes out. It never asks what time it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from behaviours.components import Character, Phase, Posture, Reaction
from behaviours.playing import body_of
from behaviours.simulation import Simulation, apply_command
from demos.stage import GHOSTS, floor_under, pelvis_m, scene_of, shown_pose
from engine.body.capsules import body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.core.clock import TICK_RATE_HZ, Clock
from engine.core.journal_file import save_journal
from engine.core.timeline import Timeline
from engine.maths.ballistics import GRAVITY_MPS2
from engine.maths.shapes import ray_capsule
from engine.render.camera import Camera, ray_through
from engine.render.capture import write_png
from engine.render.events import CTRL, LEFT_BUTTON, Event, Key, MouseButton, MouseMove
from engine.render.scene import FloorStyle, Scene

RATES = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0)
SLOWEST_MPS, FASTEST_MPS, FULL_HOLD_S = 12.0, 30.0, 0.8  # how hard a throw is, by how long it was held
HELD_AHEAD_M = 0.5  # a ball leaves the hand this far in front of the eye
FARTHEST_M = 50.0
HELP = (
    "Space pause   , . or arrows step   - = speed   Backspace restart",
    "drag orbit   right drag pan   wheel zoom   X centre",
    "F or Ctrl-click throw at the cursor (hold for speed)",
    "G ghosts   R save recording   P screenshot   F1 help",
)


class Play:
    """The state of the window that is not the world's: the clock, the cursor, what is held down."""

    def __init__(self, simulation: Simulation, timeline: Timeline, picture: Callable[[], np.ndarray], folder: Path):
        """`picture` gives the last frame, for screenshots; those and recordings go into `folder`."""
        self.world, self.timeline, self.picture, self.folder = simulation.world, timeline, picture, folder
        self.clock = Clock()
        self.ghosts: tuple[str, ...] = ()
        self.floor = FloorStyle("gym")
        self.help = True
        self.cursor_px = (0.0, 0.0)
        self.held_s: float | None = None  # how long a throw has been held
        self.notice, self.notice_s = "", 0.0

    # --- the loop's three questions ------------------------------------------------------------------------------

    def handle(self, events: list[Event], camera: Camera, size_px: tuple[int, int]) -> None:
        for event in events:
            if isinstance(event, MouseMove):
                self.cursor_px = (event.x_px, event.y_px)
            elif isinstance(event, MouseButton) and event.button == LEFT_BUTTON:
                self.cursor_px = (event.x_px, event.y_px)
                if event.pressed and event.modifiers & CTRL:
                    self.held_s = 0.0
                elif not event.pressed:
                    self._let_go(camera, size_px)
            elif isinstance(event, Key) and event.name == "f" and not event.modifiers:
                if event.action == "press":
                    self.held_s = 0.0
                elif event.action == "release":
                    self._let_go(camera, size_px)
            elif isinstance(event, Key) and event.action != "release":
                self._press(event.name)

    def advance(self, passed_s: float) -> None:
        if self.held_s is not None:
            self.held_s += passed_s
        self.notice_s = max(0.0, self.notice_s - passed_s)
        for _ in range(self.clock.ticks_due(passed_s)):
            self.timeline.advance()

    def scene(self) -> Scene:
        scene = scene_of(self.world, 1.0 if self.clock.paused else self.clock.alpha, self.ghosts)
        scene.floor = floor_under(scene, self.floor.style)
        scene.captions.append(("top-left", self._status()))
        if self.help:
            scene.captions.append(("bottom-left", "\n".join(HELP)))
        if self.notice_s > 0.0:
            scene.captions.append(("top-right", self.notice))
        return scene

    def centre_m(self) -> np.ndarray:
        """What the camera keeps up with: the first character, at chest height."""
        x, y, _ = pelvis_m(self.world, int(self.world.rows(Character)[0]))
        return np.array([x, y, 0.95])

    # --- keys ----------------------------------------------------------------------------------------------------

    def _press(self, name: str) -> None:
        keys = {
            "space": self._pause,
            ".": lambda: self._step(1),
            "right": lambda: self._step(1),
            ",": lambda: self._step(-1),
            "left": lambda: self._step(-1),
            "-": lambda: self._change_rate(-1),
            "=": lambda: self._change_rate(1),
            "backspace": self._restart,
            "g": self._toggle_ghosts,
            "r": self._save_recording,
            "p": self._save_picture,
            "f1": self._toggle_help,
        }
        if name in keys:
            keys[name]()

    def _pause(self) -> None:
        self.clock.paused = not self.clock.paused

    def _step(self, ticks: int) -> None:
        self.clock.paused = True
        if ticks > 0:
            self.clock.step(ticks)
        else:
            self.timeline.step_back(-ticks)

    def _change_rate(self, by: int) -> None:
        nearest = min(range(len(RATES)), key=lambda i: abs(RATES[i] - self.clock.rate))
        self.clock.rate = RATES[min(max(nearest + by, 0), len(RATES) - 1)]

    def _restart(self) -> None:
        self.timeline.seek(self.timeline.first_tick)

    def _toggle_ghosts(self) -> None:
        self.ghosts = () if self.ghosts else GHOSTS

    def _toggle_help(self) -> None:
        self.help = not self.help

    def _save_recording(self) -> None:
        path = _free_name(self.folder, "recording", ".brace")
        save_journal(self.timeline.journal, path)
        self._say(f"saved {path.name}")

    def _save_picture(self) -> None:
        path = _free_name(self.folder, "screenshot", ".png")
        write_png(path, self.picture())
        self._say(f"saved {path.name}")

    def _say(self, notice: str) -> None:
        self.notice, self.notice_s = notice, 3.0

    def _status(self) -> str:
        row = int(self.world.rows(Character)[0])
        phase = Phase(int(self.world[Reaction].phase[row])).name.lower().replace("_", " ")
        words = [f"{self.world.tick / TICK_RATE_HZ:.2f} s", phase]
        if self.clock.paused:
            words.append("paused")
        elif self.clock.rate != 1.0:
            words.append(f"{self.clock.rate:g} x")
        if self.held_s is not None:
            words.append(f"throw {throw_speed_mps(self.held_s):.0f} m/s")
        return "   ".join(words)

    # --- throwing ------------------------------------------------------------------------------------------------

    def _let_go(self, camera: Camera, size_px: tuple[int, int]) -> None:
        """Throws, if a throw was being held."""
        if self.held_s is None:
            return
        speed_mps, self.held_s = throw_speed_mps(self.held_s), None
        eye, ray = ray_through(camera, self.cursor_px, size_px)
        row, target = under_cursor(self.world, eye, ray)
        start = eye + HELD_AHEAD_M * ray
        self.timeline.command({
            "do": "throw",
            "at": int(np.flatnonzero(self.world.rows(Character) == row)[0]),
            "position_m": start.tolist(),
            "velocity_mps": velocity_to(start, target, speed_mps).tolist(),
        })  # fmt: skip
        self.clock.paused = False


def throw_speed_mps(held_s: float) -> float:
    """From a lob at once to a spike at full hold."""
    return SLOWEST_MPS + (FASTEST_MPS - SLOWEST_MPS) * min(held_s / FULL_HOLD_S, 1.0)


def under_cursor(world, eye: np.ndarray, ray: np.ndarray) -> tuple[int, np.ndarray]:
    """Whom a ray from the eye meets first, and where (3,); else who is nearest to it, and the point beside them."""
    nearest_m, nearest_row = math.inf, -1
    for row in world.rows(Character, Posture):
        body = body_of(world, row)
        capsules = body_capsules(body)
        ends = capsules_at(capsules, *joints_of(body, shown_pose(world, row)))
        for (start, end), radius in zip(ends, capsules.radius_m, strict=True):
            away_m = ray_capsule(eye, ray, start, end, radius, FARTHEST_M)
            if away_m < nearest_m:
                nearest_m, nearest_row = away_m, int(row)
    if nearest_row >= 0:
        return nearest_row, eye + nearest_m * ray
    rows = [int(row) for row in world.rows(Character, Posture)]
    depths = {row: max(1.0, float(np.sum((pelvis_m(world, row) - eye) * ray))) for row in rows}
    beside = {row: float(np.sum((eye + depths[row] * ray - pelvis_m(world, row)) ** 2)) for row in rows}
    row = min(rows, key=beside.__getitem__)
    return row, eye + depths[row] * ray


def velocity_to(start: np.ndarray, target: np.ndarray, speed_mps: float) -> np.ndarray:
    """The velocity that takes a ball without drag from start to target in the time that the straight way would take."""
    way = target - start
    flight_s = max(float(np.sqrt(np.sum(way * way))) / speed_mps, 1e-3)
    return way / flight_s - 0.5 * np.array(GRAVITY_MPS2) * flight_s


def _free_name(folder: Path, stem: str, ending: str) -> Path:
    """`stem-1.ending`, or the next number that is not taken."""
    number = 1
    while (folder / f"{stem}-{number}{ending}").exists():
        number += 1
    return folder / f"{stem}-{number}{ending}"


def play_of(simulation: Simulation, journal, picture: Callable[[], np.ndarray], folder: Path) -> Play:
    """A Play whose every tick and throw is recorded and can be gone back to."""
    timeline = Timeline(simulation.world, simulation.step, apply_command, journal)
    return Play(simulation, timeline, picture, folder)
