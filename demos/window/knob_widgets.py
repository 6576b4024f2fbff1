"""Groups of constants as widgets, for the panels Rules and Timing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from demos.window.constants import Knob, knobs

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui


def draw_groups(ui: Ui, session: Session, groups: Sequence[tuple[str, str]], open_groups: int = 1) -> None:
    """Each (group, title) as a part that unfolds, with a way back to the defaults where something was changed."""
    changed = session.changed_settings()
    for number, (group, title) in enumerate(groups):
        mine = [knob for knob in knobs()[group] if knob.setting in changed or knob.name in changed]
        mark = f"  ({len(mine)} changed)" if mine else ""
        if not ui.folded(f"{title}{mark}###{group}", open=number < open_groups):
            continue
        with ui.scope(group):
            for knob in knobs()[group]:
                _draw(ui, session, knob, _value(knob, changed))
            if mine and ui.button("As in the thesis"):
                session.forget_settings(group)


def _value(knob: Knob, changed: dict[str, Any]) -> Any:
    """As it is shown now: a scenario may say angles in degrees or radians."""
    if knob.setting in changed:
        return changed[knob.setting]
    if knob.name not in changed:
        return knob.default
    raw = changed[knob.name]
    if knob.kind == "angle":
        return math.degrees(raw)
    if knob.kind == "triple":
        return [math.degrees(angle) for angle in raw]
    return raw


def _draw(ui: Ui, session: Session, knob: Knob, value: Any) -> None:
    wanted = value
    if knob.kind == "word":
        wanted = ui.choice(knob.label, value, knob.options, help=knob.help)
    elif knob.kind == "switch":
        wanted = ui.toggle(knob.label, value, help=knob.help)
    elif knob.kind == "whole":
        wanted = ui.whole(knob.label, int(value), int(knob.low), int(knob.high), knob.unit, help=knob.help)
    elif knob.kind == "triple":
        wanted = [_slider(ui, knob, f"{knob.label} {axis}", angle, 0) for axis, angle in zip("XYZ", value, strict=True)]
        wanted = value if list(wanted) == list(value) else wanted
    else:
        digits = 1 if knob.kind == "angle" else _digits(knob.high - knob.low)
        wanted = _slider(ui, knob, knob.label, value, digits)
    if wanted != value:
        session.change_setting(knob.setting, wanted)


def _slider(ui: Ui, knob: Knob, label: str, value: float, digits: int) -> float:
    return ui.slider(
        label, float(value), knob.low, knob.high, knob.unit, digits=digits, loose=True, help=knob.help
    )  # fmt: skip


def _digits(span: float) -> int:
    """Enough to tell a hundredth of the way apart."""
    return max(0, min(6, 2 - math.floor(math.log10(span))))
