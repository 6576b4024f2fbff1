"""Where the two sources meet (specification S9): the same threats met by characters that stand there differently.

A character a column: its stance is worn under the walk (top row) and under the protective pose; how bold it is colours
what it makes of the ball. A threat a row. Feet, balance and bracing obey the same rules in every cell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.wearing import worn_by
from demos.figures.meeting import Meeting, arriving, balance_of, meet, posed
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look, Strip
from engine.body.kinematics import com_of
from engine.body.skeleton import Pose
from engine.clips.clip import Clip
from engine.render.scene import CLIP_BLUE, SUSTAINED_ORANGE, Ball, Scene

LOOK = Look(-48.0, 8.0)
TIME_S, PITCH_M = 0.1, 1.45
LEFT = 130.0  # width of the column of words
ROW_GAP = 26.0


class Temper(NamedTuple):
    """A character: the stance that it wears, and how bold it is."""

    word: str
    stance: str
    intensity: float
    boldness: float


class Thrown(NamedTuple):
    """A threat of the rows."""

    words: str
    azimuth_deg: float
    elevation_deg: float
    speed_mps: float
    size: float
    target: str


TEMPERS = (
    Temper("timid", "posture", -0.5, -0.6),
    Temper("tired", "posture", -0.9, 0.2),
    Temper("alert", "interest", 0.7, 0.0),
    Temper("proud", "posture", 1.0, 1.0),
)
THREATS = (
    Thrown("to the head,\nfrom ahead,\n26 m/s", 10.0, 8.0, 26.0, 0.5, "head"),
    Thrown("to the head,\nfrom the left,\n29 m/s", 60.0, 10.0, 29.0, 0.5, "head"),
    Thrown("to the belly,\nfrom the right,\n23 m/s", -35.0, 5.0, 23.0, 0.5, "pelvis"),
)


def draw(press: Press) -> Sheet:
    clip = press.clip("walk", "stand")
    rows = [[met(clip, temper, thrown) for temper in TEMPERS] for thrown in THREATS]
    strips = [_strip(press, [_alone(m) for m in rows[0]])]
    strips += [_strip(press, [_meeting(m) for m in row]) for row in rows]
    sheet = Sheet(34.0 + sum(strip.size[1] + ROW_GAP for strip in strips), press.scale)
    y = 34.0
    for temper, x in zip(TEMPERS, _columns(strips[0]), strict=True):
        sheet.text(x, 4, temper.word, BODY + 2, align="center", bold=True)
    for k, strip in enumerate(strips):
        sheet.picture(strip, LEFT, y)
        words = "walks,\nnothing comes" if k == 0 else THREATS[k - 1].words
        sheet.text(10, y + 0.45 * strip.size[1], words, BODY, valign="center")
        notes = [stance_words(temper) for temper in TEMPERS] if k == 0 else [balance_words(m) for m in rows[k - 1]]
        for x, note in zip(_columns(strip), notes, strict=True):
            sheet.text(x, y + strip.size[1] + 1, note, SMALL, "faint", "center")
        y += strip.size[1] + ROW_GAP
    return sheet


def met(clip: Clip, temper: Temper, thrown: Thrown) -> Meeting:
    """One cell."""
    worn = worn_by(clip.body, temper.stance, temper.intensity)
    return meet(
        clip, TIME_S, thrown.azimuth_deg, thrown.elevation_deg, thrown.speed_mps, thrown.size, thrown.target,
        worn=worn, boldness=temper.boldness,
    )  # fmt: skip


def stance_words(temper: Temper) -> str:
    """What the top row says below a character."""
    bold = f", boldness {number(temper.boldness, 1)}" if temper.boldness else ""
    return f"{temper.stance} {number(temper.intensity, 1)}{bold}"


def balance_words(meeting: Meeting) -> str:
    """What a cell says of its balance."""
    off_m = np.hypot(*(com_of(meeting.body, meeting.found.sustained)[:2] - meeting.found.com_wanted_m))
    return f"balance {number(100.0 * float(off_m), 1)} cm off"


def _strip(press: Press, scenes: list[Scene]) -> Strip:
    return press.strip(scenes, LOOK, 1000.0 - LEFT, PITCH_M, shadows=False)


def _columns(strip: Strip) -> list[float]:
    return [LEFT + strip.at(k, (0.0, 0.0, 0.0))[0] for k in range(len(TEMPERS))]


def _alone(meeting: Meeting) -> Scene:
    return Scene([posed(meeting.body, meeting.clip, CLIP_BLUE)])


def _meeting(meeting: Meeting) -> Scene:
    """The protective pose over the origin, the ball about to be met."""
    found, ball = meeting.found, arriving(meeting)
    shift = found.sustained.root_m * (1.0, 1.0, 0.0)
    pose = Pose(found.sustained.root_m - shift, found.sustained.rotations)
    wanted_m = found.com_wanted_m - shift[:2]
    return Scene(
        [posed(meeting.body, pose, SUSTAINED_ORANGE)],
        [Ball(ball.position_m - shift, ball.radius_m)],
        [balance_of(meeting.body, pose, found.feet.held, SUSTAINED_ORANGE, wanted_m)],
    )
