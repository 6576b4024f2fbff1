"""The threat that the Threat panel describes: what T and auto-fire send, and what changes re-run while paused."""

from __future__ import annotations

import random
from dataclasses import asdict, dataclass, fields
from typing import Any

from behaviours.perceive.threats import KINDS
from behaviours.scenario_spec import ThreatSpec


@dataclass
class ThreatDraft:
    """Words and ranges are those of a scenario's `[[threat]]`."""

    kind: str = "volleyball"
    target: str = "head"
    azimuth_deg: float = 30.0
    elevation_deg: float = 10.0
    speed_mps: float = 26.0
    size: float = 0.5
    size_means: str = "rule"
    drag: bool = False
    radius_m: float = KINDS["custom"].radius_m  # of a custom one
    mass_kg: float = KINDS["custom"].mass_kg

    def spec(self, at_character: int) -> dict[str, Any]:
        """What a scenario says, without what goes without saying."""
        given = asdict(self) | {"at_character": at_character}
        if self.kind != "custom":
            del given["radius_m"], given["mass_kg"]
        return ThreatSpec(**given).model_dump(mode="json", exclude_defaults=True)

    def varied(self, dice: random.Random) -> ThreatDraft:
        """Another like it: from anywhere ahead or beside, a little faster or slower."""
        given = asdict(self) | {
            "azimuth_deg": round(dice.uniform(-100.0, 100.0), 1),
            "elevation_deg": round(dice.uniform(0.0, 30.0), 1),
            "speed_mps": round(self.speed_mps * dice.uniform(0.85, 1.15), 1),
            "target": dice.choice(("head", "head", "torso", "pelvis")),
        }
        return ThreatDraft(**given)


def draft_of(spec: ThreatSpec) -> ThreatDraft:
    """What the panel shows for a scripted threat of a scenario."""
    given = {f.name: getattr(spec, f.name) for f in fields(ThreatDraft) if getattr(spec, f.name) is not None}
    return ThreatDraft(**given)
