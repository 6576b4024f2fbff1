"""A user's hand without a window: a `Ui` whose widgets are set by their labels, and which notes what was drawn."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class HandUi:
    """`wanted`: label -> value to set it to, or True to click it. `seen`: label -> value it had. `said`: all words."""

    def __init__(self, **wanted: Any):
        self.wanted = {label.replace("_", " "): value for label, value in wanted.items()}
        self.seen: dict[str, Any] = {}
        self.said: list[str] = []
        self.open_all = True

    def _value(self, label: str, value: Any) -> Any:
        self.seen[label] = value
        return self.wanted.get(label, value)

    def slider(self, label, value, low, high, unit="", **_) -> float:
        assert isinstance(value, int | float)
        assert low < high, label
        return self._value(label, value)

    def whole(self, label, value, low, high, unit="", **_) -> int:
        assert isinstance(value, int)
        return self._value(label, value)

    def toggle(self, label, on, **_) -> bool:
        assert isinstance(on, bool)
        return self._value(label, on)

    def choice(self, label, chosen, options, **_) -> str:
        wanted = self._value(label, chosen)
        assert wanted == chosen or wanted in options
        return wanted

    def entry(self, label, text, hint="") -> str:
        return self._value(label, text)

    def button(self, label, **_) -> bool:
        self.seen[label] = False
        return bool(self.wanted.get(label, False))

    def item(self, label, chosen, detail="") -> bool:
        self.seen[label] = chosen
        return bool(self.wanted.get(label, False))

    def folded(self, title, open=False, help="") -> bool:
        self.said.append(title)
        return self.open_all

    def heading(self, text) -> None:
        self.said.append(text)

    def text(self, text, **_) -> None:
        self.said.append(text)

    def pair(self, left, right, left_width) -> None:
        self.said.append(f"{left}: {right}")

    def gap(self) -> None: ...

    def beside(self) -> None: ...

    @contextmanager
    def scope(self, name) -> Iterator[None]:
        yield

    @contextmanager
    def area(self, *_, **__) -> Iterator[None]:
        yield
