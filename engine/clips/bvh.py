"""Biovision hierarchy files (.bvh), read strictly: every line that is not what it should be is named, none is guessed
at."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from engine.clips.tracks import Tracks, numbers, read_lines
from engine.core.errors import BadInput
from engine.maths import rotations

CHANNEL = re.compile(r"([XYZ])(position|rotation)$", re.IGNORECASE)


@dataclass
class Joint:
    """One joint of the hierarchy while it is being read."""

    name: str
    parent: int
    line: int
    offset: list[float] | None = None
    channels: list[tuple[str, str]] | None = None  # ("X", "position") ...
    tip: list[float] | None = None


@dataclass
class Reading:
    """The file's lines and how far we are, so that every complaint can say where."""

    path: Path
    lines: list[str]
    at: int = 0
    joints: list[Joint] = field(default_factory=list)

    def words(self) -> list[str]:
        """The words of the next line that has any; a complaint if the file ends."""
        while self.at < len(self.lines):
            self.at += 1
            words = self.lines[self.at - 1].split()
            if words:
                return words
        raise self.bad("the end of the file", "more lines")

    def bad(self, found: str, expected: str) -> BadInput:
        return BadInput("bvh", f"found {found}, expected {expected}", self.where())

    def where(self) -> str:
        return f"{self.path}:{min(self.at, len(self.lines))}"


def read_bvh(path: str | Path) -> Tracks:
    """The joints, channels and frames of one .bvh file. BadInput names file, line, what was found and what was
    expected."""
    path = Path(path)
    reading = Reading(path, read_lines(path))
    _read_hierarchy(reading)
    frames, frame_s = _read_motion_header(reading)
    values = _read_frames(reading, frames, sum(len(joint.channels or ()) for joint in reading.joints))
    root, turns = _split_channels(reading, values)
    joints = reading.joints
    return Tracks(
        format="bvh",
        names=tuple(joint.name for joint in joints),
        parents=np.array([joint.parent for joint in joints]),
        offsets=np.array([joint.offset for joint in joints], float),
        root=root,
        rotations=turns,
        fps=_frames_per_second(frame_s),
        tips={row: np.array(joint.tip) for row, joint in enumerate(joints) if joint.tip is not None},
    )


def _read_hierarchy(reading: Reading) -> None:
    words = reading.words()
    if words != ["HIERARCHY"]:
        raise reading.bad(repr(" ".join(words)[:40]), "the word HIERARCHY")
    words = reading.words()
    if words[0] != "ROOT":
        raise reading.bad(repr(" ".join(words)[:40]), "ROOT and a name")
    _open_joint(reading, words, parent=-1)
    stack = [0]  # the joint whose block we are in; -1 for an End Site
    while stack:
        words = reading.words()
        _read_block_line(reading, words, stack)


def _open_joint(reading: Reading, words: list[str], parent: int) -> None:
    name = " ".join(words[1:])
    if not name:
        raise reading.bad(f"{words[0]} without a name", f"{words[0]} and a name")
    if name in {joint.name for joint in reading.joints}:
        raise reading.bad(f"a second joint called {name!r}", "different names")
    reading.joints.append(Joint(name, parent, reading.at))
    _expect_open_brace(reading)


def _expect_open_brace(reading: Reading) -> None:
    words = reading.words()
    if words != ["{"]:
        raise reading.bad(repr(" ".join(words)[:40]), "{")


def _read_block_line(reading: Reading, words: list[str], stack: list[int]) -> None:
    """One line inside a joint's braces: its OFFSET, its CHANNELS, a child, an End Site, or the closing brace."""
    joint = reading.joints[stack[-1]]
    if words[0] == "}" and len(words) == 1:
        if joint.offset is None or joint.channels is None:
            missing = "OFFSET" if joint.offset is None else "CHANNELS"
            raise reading.bad(f"the end of joint {joint.name!r}", f"its {missing} first")
        stack.pop()
    elif words[0] == "OFFSET":
        joint.offset = _three(reading, words)
    elif words[0] == "CHANNELS":
        joint.channels = _channels(reading, words)
    elif words[0] == "JOINT":
        _open_joint(reading, words, parent=stack[-1])
        stack.append(len(reading.joints) - 1)
    elif words[:2] == ["End", "Site"]:
        _expect_open_brace(reading)
        joint.tip = _three(reading, reading.words())
        words = reading.words()
        if words != ["}"]:
            raise reading.bad(repr(" ".join(words)[:40]), "} after the End Site's OFFSET")
    else:
        raise reading.bad(repr(" ".join(words)[:40]), "OFFSET, CHANNELS, JOINT, End Site or }")


def _three(reading: Reading, words: list[str]) -> list[float]:
    if words[0] != "OFFSET" or len(words) != 4:
        raise reading.bad(repr(" ".join(words)[:60]), "OFFSET and three numbers")
    return numbers(words[1:], reading.where())


def _channels(reading: Reading, words: list[str]) -> list[tuple[str, str]]:
    if len(words) < 2 or not words[1].isdigit() or int(words[1]) != len(words) - 2:
        raise reading.bad(repr(" ".join(words)[:80]), "CHANNELS, their count, and as many names")
    named = []
    for word in words[2:]:
        match = CHANNEL.match(word)
        if not match:
            raise reading.bad(f"channel {word!r}", "Xposition ... Zrotation")
        named.append((match[1].upper(), match[2].lower()))
    if len(set(named)) != len(named):
        raise reading.bad("the same channel twice", "each channel once")
    return named


def _read_motion_header(reading: Reading) -> tuple[int, float]:
    words = reading.words()
    if words != ["MOTION"]:
        raise reading.bad(repr(" ".join(words)[:40]), "the word MOTION")
    words = reading.words()
    if len(words) != 2 or words[0] != "Frames:" or not words[1].isdigit() or int(words[1]) == 0:
        raise reading.bad(repr(" ".join(words)[:40]), "Frames: and how many (one or more)")
    frames = int(words[1])
    words = reading.words()
    if len(words) != 3 or words[:2] != ["Frame", "Time:"]:
        raise reading.bad(repr(" ".join(words)[:40]), "Frame Time: and seconds")
    frame_s = numbers(words[2:], reading.where())[0]
    if not 1e-4 < frame_s < 10.0:
        raise reading.bad(f"a frame time of {frame_s:g} s", "between 0.0001 and 10 s")
    return frames, frame_s


def _read_frames(reading: Reading, frames: int, channels: int) -> np.ndarray:
    values = np.empty((frames, channels))
    for frame in range(frames):
        try:
            words = reading.words()
        except BadInput:
            raise reading.bad(f"{frame} frames", f"the {frames} that the file declares") from None
        if len(words) != channels:
            raise reading.bad(f"{len(words)} numbers in frame {frame}", f"{channels}, one for each channel")
        values[frame] = numbers(words, reading.where())
    for extra in range(reading.at, len(reading.lines)):
        if reading.lines[extra].strip():
            reading.at = extra + 1
            raise reading.bad("another line", f"the end after the {frames} frames that the file declares")
    return values


def _split_channels(reading: Reading, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The root's path (F, 3) and every joint's rotation (F, J, 4); rotations multiply in the order in which they are
    listed."""
    root = np.tile(np.array(reading.joints[0].offset, float), (len(values), 1))
    turns = np.empty((len(values), len(reading.joints), 4))
    column = 0
    for row, joint in enumerate(reading.joints):
        channels = joint.channels or []
        block = values[:, column : column + len(channels)]
        column += len(channels)
        is_turn = np.array([kind == "rotation" for _, kind in channels], bool)
        order = "".join(axis for axis, kind in channels if kind == "rotation")
        turns[:, row] = rotations.from_euler(order, np.radians(block[:, is_turn])) if order else [1.0, 0.0, 0.0, 0.0]
        for k, (axis, kind) in enumerate(channels):
            if kind == "position":
                _use_position(reading, joint, "XYZ".index(axis), block[:, k], root)
    return root, turns


def _use_position(reading: Reading, joint: Joint, axis: int, column: np.ndarray, root: np.ndarray) -> None:
    """The root's path is kept. Elsewhere some programs repeat the OFFSET in every frame, or zero; a bone that truly
    moves is refused."""
    if joint.parent < 0:
        root[:, axis] = column
        return
    scale = max(np.abs(other.offset).max() for other in reading.joints[1:] if other.offset is not None)
    stays = [np.abs(column - rest).max() < 0.02 * scale for rest in (joint.offset[axis], 0.0)]  # type: ignore[index]
    if not any(stays):
        reading.at = joint.line
        raise reading.bad(f"joint {joint.name!r} sliding along {'XYZ'[axis]}", "bones of constant length")


def _frames_per_second(frame_s: float) -> float:
    """Whole rates written with few digits (.0083333, 0.033333) are that whole rate."""
    fps = 1.0 / frame_s
    return float(round(fps)) if abs(fps - round(fps)) < 2e-4 * fps else fps
