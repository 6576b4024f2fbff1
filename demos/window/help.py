"""Every key of the window, once: the help shows this table, and `demos.play` obeys it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from engine.render.ui.widgets import Ui


class KeyRow(NamedTuple):
    """`keys`: names as engine.render.events has them, `ctrl-` before where held with it; none: done with the mouse."""

    shown: str
    does: str
    action: str = ""
    keys: tuple[str, ...] = ()


GROUPS: dict[str, tuple[KeyRow, ...]] = {
    "Time": (
        KeyRow("Space", "pauses, goes on", "pause", ("space",)),
        KeyRow(",  .  arrows", "single ticks back, ahead", "step", (".", "right")),
        KeyRow("", "", "step_back", (",", "left")),
        KeyRow("-  =", "slower, faster", "slower", ("-",)),
        KeyRow("", "", "faster", ("=",)),
        KeyRow("S", "slow motion at the blow", "slow_motion", ("s",)),
        KeyRow("Backspace", "back to the start", "restart", ("backspace",)),
        KeyRow("End", "to the live edge", "live", ("end",)),
        KeyRow("timeline", "click jumps, drag scrubs"),
    ),
    "Throwing": (
        KeyRow("F, Ctrl-click", "throws; hold for speed"),
        KeyRow("T", "sends the panel's threat", "send", ("t",)),
        KeyRow("A", "auto-fire, on and off", "auto_fire", ("a",)),
    ),
    "Looking": (
        KeyRow("drag", "orbits; right or Shift drag pans"),
        KeyRow("wheel", "zooms"),
        KeyRow("X", "everybody into the picture"),
        KeyRow("double click", "selects a character"),
        KeyRow("V", "the camera follows, or stays", "follow", ("v",)),
        KeyRow("G", "ghosts of the three poses", "ghosts", ("g",)),
        KeyRow("L", "labels, on and off", "labels", ("l",)),
        KeyRow("Tab", "panels, on and off", "panels", ("tab",)),
    ),
    "Keeping": (
        KeyRow("P", "screenshot", "screenshot", ("p",)),
        KeyRow("R", "films until R again", "film", ("r",)),
        KeyRow("Ctrl-S", "saves the run as a scenario", "scenario", ("ctrl-s",)),
        KeyRow("Ctrl-R", "saves the run as a recording", "recording", ("ctrl-r",)),
        KeyRow("drop a file", "plays a .bvh or .amc"),
        KeyRow("F1", "this; Escape closes it", "help", ("f1",)),
        KeyRow("", "", "close", ("escape",)),
    ),
}
ACTIONS = {key: row.action for rows in GROUPS.values() for row in rows for key in row.keys}
KEY_WIDTH = 92.0


def draw_help(ui: Ui) -> None:
    """Every row, in the groups."""
    for title, rows in GROUPS.items():
        ui.heading(title)
        for row in rows:
            if row.shown:
                ui.pair(row.shown, row.does, KEY_WIDTH)
