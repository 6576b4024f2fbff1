"""What is shown beside the character: one switch each, all plain data that the user's settings keep."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class View:
    """The switches of the View panel, and those that have a key."""

    panels: bool = True
    timeline: bool = True
    plots: bool = True
    follow: bool = True  # the camera goes along with the character
    ghost_clip: bool = False
    ghost_rules: bool = False
    ghost_sustained: bool = False
    com: bool = True
    support: bool = True
    path: bool = True  # where a ball that has been noticed will go
    forces: bool = False
    labels: bool = False

    @property
    def ghosts(self) -> tuple[str, ...]:
        """The names of `demos.stage.GHOSTS` that are switched on."""
        return tuple(name for name in ("clip", "rules", "sustained") if getattr(self, f"ghost_{name}"))
