"""Slow motion that begins by itself just before a blow and ends after it."""

from __future__ import annotations

from behaviours.components import Character, Phase, Reaction
from engine.core.clock import TICK_RATE_HZ, ticks

SLOWEST = 0.1  # of real time
LEAD_S, AFTER_S = 0.10, 0.12  # of the run's time, before the expected contact and after the one that came
HALF_LIFE_S = 0.06  # real seconds in which half of a change of speed is made


class SlowMotion:
    """`enabled` switches it; `share` is how fast time passes now, eased."""

    def __init__(self, enabled: bool = True):
        self.enabled = enabled
        self.share = 1.0

    def ease(self, world, passed_s: float) -> float:
        """Real time has passed; returns the share of it that counts."""
        wanted = SLOWEST if self.enabled and is_near_contact(world) else 1.0
        self.share += (wanted - self.share) * (1.0 - 0.5 ** (passed_s / HALF_LIFE_S))
        if abs(self.share - wanted) < 0.01:
            self.share = wanted
        return self.share


def is_near_contact(world) -> bool:
    """Whether anybody is about to be hit, or has just been. Says the same whenever this tick is come to."""
    r, lead = world[Reaction], ticks(LEAD_S)
    for row in world.rows(Character, Reaction):
        phase, due = Phase(int(r.phase[row])), int(r.contact[row]) - world.tick
        if phase in (Phase.STARTLE, Phase.PROTECT) and not r.flinches[row] and -lead <= due <= lead:
            return True
        if phase in (Phase.RESPOND, Phase.RECOVER_BLEND, Phase.DOWN) and r.struck[row]:
            since = world.tick - int(r.since[row])
            if phase == Phase.RESPOND and since <= AFTER_S * TICK_RATE_HZ:
                return True
    return False
