"""The phases of fig. 4.1 as the window shows them: a colour each, and words."""

from __future__ import annotations

from behaviours.components import Phase
from demos.stage import PHASE_COLOURS
from engine.render.scene import BLEND_GREY, RULES_YELLOW, SUSTAINED_ORANGE

COLOURS = {
    **PHASE_COLOURS,
    Phase.STARTLE: RULES_YELLOW,
    Phase.PROTECT: SUSTAINED_ORANGE,
    Phase.HOLD: SUSTAINED_ORANGE,
    Phase.RECOVER_RETURN: tuple(0.6 * grey + 0.4 for grey in BLEND_GREY),
    Phase.STOPPED: (0.2, 0.2, 0.2),
}
WORDS = {
    Phase.PLAY: "plays its clip",
    Phase.STARTLE: "startles",
    Phase.PROTECT: "protects itself",
    Phase.HOLD: "holds, missed",
    Phase.RESPOND: "is struck",
    Phase.RECOVER_BLEND: "recovers",
    Phase.RECOVER_RETURN: "returns to its clip",
    Phase.DOWN: "is down",
    Phase.STOPPED: "has stopped",
}
