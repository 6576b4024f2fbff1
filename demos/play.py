"""The window on a scenario: events come in, time passes, a scene and its panels go out. Which key does what stands in
`demos.window.help`, what there is to act on in `demos.window.session`.

It is a `Show` and a `Layer` for `engine.render.loop`, and never asks what time it is.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from behaviours.scenario_spec import Scenario
from demos.stage import floor_under, scene_of
from demos.window.help import ACTIONS, draw_help
from demos.window.keeping import Keeper
from demos.window.marks import draw_marks
from demos.window.panels import Panel, Remembering, make_panels
from demos.window.plots import draw_plots
from demos.window.session import Session
from demos.window.status import draw_offer, draw_status, draw_toasts
from demos.window.throwing import character_under, throw_speed_mps
from demos.window.timeline_bar import HEIGHT, TimelineBar
from engine.render.camera import Camera, off_centre
from engine.render.events import CTRL, LEFT_BUTTON, Drop, Event, Key, MouseButton, MouseMove
from engine.render.scene import FloorStyle, Scene

if TYPE_CHECKING:
    from engine.render.ui.widgets import Ui

PANEL_WIDTH, MARGIN = 300.0, 10.0
PLOT_WIDTH = 230.0
COVERING_HALF_LIFE_S = 0.1
TIMELINE_HEIGHT = HEIGHT + 20.0


class Play:
    """The window's own state: which panel is open, what is held down, what is being kept."""

    def __init__(self, session: Session):
        self.session = session
        self.keeper = Keeper(session)
        self.floor = FloorStyle("gym")
        self.help = False
        self.tab = "Threat"
        self.held_s: float | None = None  # how long a throw has been held
        self.timeline = TimelineBar()
        self.scale = 1.0  # pixels of the picture for a point of the panels
        self._covered: tuple[float, ...] = (0.0, 0.0)  # at the right and at the bottom, points, eased
        self._panels: list[Panel] | None = None
        self._kept: dict[str, Any] = {}  # what panels remember from the last time, by title

    @property
    def panels(self) -> list[Panel]:
        """Made when they are first needed: some import much."""
        if self._panels is None:
            self._panels = make_panels()
            for panel in self._panels:
                kept = self._kept.get(panel.title)
                if isinstance(panel, Remembering) and isinstance(kept, dict):
                    panel.remember(kept)
        return self._panels

    @property
    def panel(self) -> Panel | None:
        """The one that is open; none while panels are away."""
        if not self.session.view.panels or self._panels is None:
            return None
        return next((panel for panel in self._panels if panel.title == self.tab), self._panels[0])

    # --- what the loop asks --------------------------------------------------------------------------------------

    def handle(self, events: list[Event], camera: Camera, size_px: tuple[int, int]) -> None:
        session = self.session
        session.camera, session.size_px = camera, size_px
        for event in events:
            if isinstance(event, (MouseMove, MouseButton)):
                session.cursor_px = (event.x_px, event.y_px)
            if isinstance(event, MouseButton) and event.button == LEFT_BUTTON:
                self._button(event)
            elif isinstance(event, Key) and event.name == "f" and not event.modifiers:
                self._hold(event.action)
            elif isinstance(event, Key) and event.action != "release":
                self._press(event)
            elif isinstance(event, Drop):
                self._drop(event.paths)

    def advance(self, passed_s: float) -> None:
        if self.held_s is not None:
            self.held_s += passed_s
        view, weight = self.session.view, 1.0 - 0.5 ** (passed_s / COVERING_HALF_LIFE_S)
        covered = (
            PANEL_WIDTH + MARGIN if view.panels or self.help else 0.0,
            TIMELINE_HEIGHT + MARGIN if view.timeline else 0.0,
        )
        self._covered = tuple(now + weight * (to - now) for now, to in zip(self._covered, covered, strict=True))
        self.session.advance(passed_s)

    def scene(self) -> Scene:
        session = self.session
        alpha = 1.0 if session.paused else session.clock.alpha
        scene = scene_of(session.world, alpha, session.view.ghosts)
        scene.floor = floor_under(scene, self.floor.style)
        draw_marks(scene, session)
        drawn_into = getattr(self.panel, "drawn_into", None)
        if drawn_into:
            drawn_into(scene, session)
        return scene

    def centre_m(self) -> np.ndarray | None:
        """What the camera goes along with; None to stay."""
        return self.session.centre_m() if self.session.view.follow else None

    def framed(self, camera: Camera, size_px: tuple[int, int]) -> Camera:
        """The character in the middle of what panels and timeline leave free."""
        return off_centre(camera, 0.5 * self._covered[0] * self.scale, 0.5 * self._covered[1] * self.scale, size_px)

    def take(self, events: list[Event]) -> list[Event]:
        """The open panel's part of the events that no widget took."""
        handle = getattr(self.panel, "handle", None)
        if handle is None:
            return events
        for event in events:
            if isinstance(event, (MouseMove, MouseButton)):
                self.session.cursor_px = (event.x_px, event.y_px)
        return [event for event in events if not handle(event, self.session)]

    def keep(self, picture: Callable[[], np.ndarray], passed_s: float) -> None:
        """The picture is drawn and nothing lies on it yet: the moment for screenshots and films."""
        self.keeper.keep(picture, passed_s)

    def draw(self, ui: Ui) -> None:
        """Everything that lies on the picture."""
        session, view = self.session, self.session.view
        draw_status(ui, self, MARGIN)
        draw_offer(ui, session, MARGIN)
        bottom = ui.height - MARGIN
        if view.timeline:
            bottom -= TIMELINE_HEIGHT
            with ui.area("time", MARGIN, bottom, ui.width - 2 * MARGIN, TIMELINE_HEIGHT):
                self.timeline.draw(ui, session)
            bottom -= MARGIN
        if view.plots and ui.height > 420.0:
            with ui.area("plots", MARGIN, bottom - 182.0, PLOT_WIDTH, 182.0, mouse=False):
                draw_plots(ui, session)
        if self.help:
            with ui.area("help", ui.width - PANEL_WIDTH - MARGIN, MARGIN, PANEL_WIDTH, bottom - MARGIN):
                draw_help(ui)
        elif view.panels:
            self._draw_panel(ui, bottom)
        taken = PANEL_WIDTH + MARGIN if view.panels or self.help else 0.0
        draw_toasts(ui, session, ui.width - MARGIN - taken, MARGIN)

    def _draw_panel(self, ui: Ui, bottom: float) -> None:
        with ui.area("panels", ui.width - PANEL_WIDTH - MARGIN, MARGIN, PANEL_WIDTH, bottom - MARGIN):
            self.tab = ui.tabs([panel.title for panel in self.panels], self.tab)
            ui.gap()
            panel = self.panel
            if panel:
                with ui.scrolled(panel.title):
                    panel.draw(ui, self.session)

    # --- what the user does --------------------------------------------------------------------------------------

    def _button(self, event: MouseButton) -> None:
        """Ctrl holds a throw; a double click selects."""
        if event.pressed and event.modifiers & CTRL:
            self.held_s = 0.0
        elif event.pressed and event.clicks == 2:
            met = character_under(self.session.world, *self.session.ray())
            if met:
                rows = [int(row) for row in self.session.rows()]
                self.session.selected = rows.index(met[0])
        elif not event.pressed:
            self._let_go()

    def _hold(self, action: str) -> None:
        if action == "press":
            self.held_s = 0.0
        elif action == "release":
            self._let_go()

    def _let_go(self) -> None:
        """Throws, if a throw was being held."""
        if self.held_s is not None:
            held_s, self.held_s = self.held_s, None
            self.session.throw(throw_speed_mps(held_s))

    def _press(self, event: Key) -> None:
        action = ACTIONS.get(("ctrl-" if event.modifiers & CTRL else "") + event.name)
        if action:
            self._act(action)

    def _act(self, action: str) -> None:
        session, view = self.session, self.session.view
        deeds: dict[str, Callable[[], Any]] = {
            "pause": session.pause,
            "step": lambda: session.step(1),
            "step_back": lambda: session.step(-1),
            "slower": lambda: session.change_rate(-1),
            "faster": lambda: session.change_rate(1),
            "restart": session.restart,
            "live": lambda: session.seek(session.run.last_tick),
            "send": session.send,
        }
        if action in deeds:
            deeds[action]()
        elif action in ("screenshot", "film", "scenario", "recording"):
            session.ask(action)
        elif action in ("panels", "follow", "labels"):
            setattr(view, action, not getattr(view, action))
        elif action == "ghosts":
            view.ghost_clip = view.ghost_rules = view.ghost_sustained = not view.ghosts
        elif action == "slow_motion":
            session.slow_motion.enabled = not session.slow_motion.enabled
            session.say(f"slow motion at the blow: {'on' if session.slow_motion.enabled else 'off'}")
        elif action == "auto_fire":
            session.auto_fire = not session.auto_fire
        elif action == "help":
            self.help = not self.help
        elif action == "close":
            self.help = False

    def _drop(self, paths: tuple[str, ...]) -> None:
        """The first file is played; what was shown stays where it cannot be."""
        path = str(Path(paths[0]).resolve())
        if self.session.play_clip(path):
            self.session.dropped = [path, *(other for other in self.session.dropped if other != path)]
            self.session.say(f"plays {Path(path).name}")

    # --- from one start to the next ------------------------------------------------------------------------------

    def memory(self) -> dict[str, Any]:
        """What the user's settings keep, panels' own included."""
        session = self.session
        own = dict(self._kept)
        own |= {panel.title: panel.memory() for panel in self._panels or () if isinstance(panel, Remembering)}
        return {
            "view": vars(session.view),
            "tab": self.tab,
            "size": [round(side / self.scale) for side in self.session.size_px],
            "slow_motion": session.slow_motion.enabled,
            "auto_fire_s": session.auto_fire_s,
            "auto_vary": session.auto_vary,
            "panels": own,
        }

    def remember(self, kept: dict[str, Any]) -> None:
        """The same, back again; what does not fit is passed over."""
        from demos.window.memory import taken_over

        taken_over(self.session.view, kept.get("view"))
        taken_over(self.session.slow_motion, {"enabled": kept.get("slow_motion")})
        taken_over(self.session, {key: kept.get(key) for key in ("auto_fire_s", "auto_vary")})
        taken_over(self, {"tab": kept.get("tab")})
        panels = kept.get("panels")
        self._kept = panels if isinstance(panels, dict) else {}


def play_of(
    scenario: Scenario, folder: Path, save_in: Path, stopwatch: Callable[[], float] = time.perf_counter
) -> Play:
    """A window's play of a scenario; see `Session`. BadInput or EnvironmentTrouble where its clips cannot be found."""
    return Play(Session(scenario, folder, save_in, stopwatch))
