"""Lines that are shown for a few seconds: where a file went, what could not be done."""

from __future__ import annotations

from dataclasses import dataclass, field

SHOWN_S, ALARM_S = 5.0, 9.0
MOST = 4


@dataclass
class Toast:
    text: str
    alarm: bool
    left_s: float


@dataclass
class Toasts:
    """The latest few."""

    lines: list[Toast] = field(default_factory=list)

    def say(self, text: str, *, alarm: bool = False) -> None:
        """The same line again only stays longer."""
        self.lines = [line for line in self.lines if line.text != text][-MOST + 1 :]
        self.lines.append(Toast(text, alarm, ALARM_S if alarm else SHOWN_S))

    def fade(self, passed_s: float) -> None:
        for line in self.lines:
            line.left_s -= passed_s
        self.lines = [line for line in self.lines if line.left_s > 0.0]
