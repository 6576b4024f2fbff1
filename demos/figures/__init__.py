"""Figures of the sources, drawn from the running system; `brace figure NAME -o FILE`.

To add one: copy the module of a neighbour, change what it draws, and give it a row in FIGURES. A figure is a module
with one function, `draw(press) -> Sheet`; what figures share is in `stills` (photographs), `meeting` (poses), `take`
(runs) and `sheet` (paper).
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, NamedTuple

from engine.core.errors import BadInput

if TYPE_CHECKING:
    from demos.figures.press import Press
    from demos.figures.sheet import Sheet


class Entry(NamedTuple):
    """One figure of the list."""

    name: str  # the thesis's number, the stance paper's after `stance-`, or a word
    module: str
    shows: str


FIGURES = (
    Entry("1.1", "one_anticipation", "one anticipation, from the clip to the sustained pose and back"),
    Entry("1.2", "four_stages", "the four stages at the instant of impact"),
    Entry("2.1", "eccentricity", "the angle between facing and threat"),
    Entry("3.1", "hierarchy", "the joints, and the identity pose with its axes"),
    Entry("3.2", "rules_vary", "position, size and speed of the threat vary: the rules alone"),
    Entry("3.3", "lean", "what goes into the lean rule and what comes out"),
    Entry("3.4", "turn", "what goes into the turn rule and what comes out"),
    Entry("3.5", "recoil", "what goes into the recoil rule and what comes out"),
    Entry("3.6", "block", "what goes into the block rule and what comes out"),
    Entry("3.7", "reach", "both arms reach for the line of approach, from above"),
    Entry("3.8", "swivel", "the elbow's swivel angle"),
    Entry("3.9", "static_balance", "rules and sustained pose: in balance before, and out of it"),
    Entry("3.10", "three_cases", "the three cases of balancing and bracing"),
    Entry("3.11", "from_behind", "a threat from behind, two views"),
    Entry("3.12", "torso_impacts", "clip, head, pelvis, and between"),
    Entry("4.1", "timing", "the timing schematic with the running durations"),
    Entry("5.1", "speeds", "sustained poses just before impact, slow to fast"),
    Entry("5.2", "filmstrips", "back to the same motion, or into a new one, mild and extreme"),
    Entry("sweep", "sweep", "azimuth, speed and size, two of each: eight sustained poses"),
    Entry("stance-1", "stance_reaching", "four reach postures that satisfy the same constraint"),
    Entry("stance-3", "stance_freedoms", "the degrees of freedom of the full skeleton"),
    Entry("stance-4", "stance_penalty", "the penalty: a desired value and four cubic Hermite pieces"),
    Entry("stance-5", "stance_postures", "a continuous range of postures, Alberts' thirteen words"),
    Entry("stance-6", "stance_reactions", "reactions to an object: two recoils, two kinds of interest"),
    Entry("stance-7", "stance_intensities", "four intensities of the strong recoil"),
    Entry("stance-8", "stance_lower_body", "where the free hip can be, and the place that is taken"),
    Entry("stance-meets-threat", "stance_meets_threat", "the same threats met by four characters, each in its stance"),
)


def names() -> list[str]:
    """All figures, in the order of the sources."""
    return [entry.name for entry in FIGURES]


def find_figure(name: str) -> Entry:
    """The figure of that name. BadInput lists them all, nearest first."""
    for entry in FIGURES:
        if name in (entry.name, entry.module):
            return entry
    from demos.cli import nearest

    raise BadInput("figure", f"unknown figure {name!r}; {nearest(name, names())}")


def draw_figure(name: str, press: Press) -> Sheet:
    """Draws one; a line at its foot names the clips that the embedded one stood in for."""
    press.missing.clear()
    sheet = importlib.import_module(f"demos.figures.{find_figure(name).module}").draw(press)
    if press.missing:
        note = f"drawn with the embedded clip; {', '.join(press.missing)} not fetched"
        sheet.text(0.7 * sheet.width, sheet.height - 5, note, 9, "faint", "center", "bottom")
    return sheet
