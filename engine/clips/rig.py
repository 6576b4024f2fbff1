"""Which joint of a file is which part of a person, told from the tree and from the few names that every convention has.

Knees, feet, elbows, hands and head are known by name; everything else by where it hangs: the pelvis is where the legs
meet, the chest where the arms meet, an upper arm is what carries a forearm, a collar bone what lies between chest and
upper arm."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from engine.clips.tracks import Tracks, ancestors
from engine.core.errors import BadInput

KNEE = {"leg", "shin", "tibia", "knee", "lowerleg", "lowleg", "calf", "shank"}
FOOT = {"foot", "ankle"}
TOE = {"toe", "toes", "toebase", "ball"}
ELBOW = {"forearm", "lowerarm", "lowarm", "elbow", "radius", "arm_lower"}
HAND = {"hand", "wrist", "fingerbase", "handbase"}
HEAD = {"head", "skull"}
SIDES = {"left": 0, "right": 1, "l": 0, "r": 1}


@dataclass(frozen=True)
class Rig:
    """Rows of `Tracks` by their part of the body. Pairs are (left, right); a path runs from the trunk outwards."""

    pelvis: int
    spine: tuple[int, ...]  # what lies above the pelvis, up to the joint that carries the arms
    neck: tuple[int, ...]  # what lies above that, up to the head; empty if the file has no head
    collar: tuple[int | None, int | None]
    shoulder: tuple[int, int]
    elbow: tuple[int, int]
    forearm: tuple[int, int]  # the last joint that turns with the forearm: it knows pronation
    wrist: tuple[int | None, int | None]
    hip: tuple[int, int]
    knee: tuple[int, int]
    ankle: tuple[int, int]
    toe: tuple[int | None, int | None]


def part_of(name: str) -> tuple[int | None, str]:
    """The side (0 left, 1 right, None) and the bare part that a joint's name tells: "mixamorig:LeftUpLeg" -> (0,
    "upleg")."""
    bare = name.rsplit(":", 1)[-1]
    spaced = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", re.sub(r"[^A-Za-z0-9]+", " ", bare))
    words = spaced.lower().split()
    for at in (0, -1):
        if len(words) > 1 and words[at] in SIDES:
            side = SIDES[words[at]]
            return side, re.sub(r"\d+$", "", "".join(words[1:] if at == 0 else words[:-1]))
    joined = "".join(words)
    # lfemur, rShin without a capital: the letter counts if what is left is a part we know
    if joined[:1] in ("l", "r") and joined[1:] in KNEE | FOOT | TOE | ELBOW | HAND:
        return SIDES[joined[0]], joined[1:]
    for word, side in (("left", 0), ("right", 1)):
        if joined.startswith(word):
            return side, re.sub(r"\d+$", "", joined[len(word) :])
    return None, re.sub(r"\d+$", "", joined)


def find_rig(tracks: Tracks, where: Path) -> Rig:
    """The parts of the body among the joints of a file. BadInput names what could not be found and what there is."""
    named = Named(tracks, tuple(part_of(name) for name in tracks.names), where)
    knee, elbow = (named.needed(KNEE, 0), named.needed(KNEE, 1)), (named.needed(ELBOW, 0), named.needed(ELBOW, 1))
    pelvis, chest = _meet(tracks, knee), _meet(tracks, elbow)
    spine = [row for row in reversed(ancestors(tracks, chest)) if row not in ancestors(tracks, pelvis)]
    if not spine:
        raise named.bad("arms and legs on the same joint", "a spine between them")
    collar, shoulder, forearm, wrist = zip(*(_arm(named, elbow[side], side, chest) for side in (0, 1)), strict=True)
    hip, ankle, toe = zip(*(_leg(named, knee[side], side) for side in (0, 1)), strict=True)
    neck = _neck(named, chest)
    return Rig(pelvis, tuple(spine), neck, collar, shoulder, elbow, forearm, wrist, hip, knee, ankle, toe)


@dataclass(frozen=True)
class Named:
    """A file's joints with what their names tell."""

    tracks: Tracks
    parts: tuple[tuple[int | None, str], ...]
    where: Path

    def needed(self, names: set[str], side: int) -> int:
        """The first joint of that side and name; BadInput if there is none."""
        for row, part in enumerate(self.parts):
            if part[0] == side and part[1] in names:
                return row
        listed = ", ".join(self.tracks.names[:12]) + (" ..." if len(self.tracks.names) > 12 else "")
        raise self.bad(f"joints {listed}", f"a {('left', 'right')[side]} {' or '.join(sorted(names)[:3])} among them")

    def below(self, start: int, names: set[str], side: int | None) -> list[int]:
        """The joints of that side and name that hang on another."""
        fitting = [row for row, part in enumerate(self.parts) if part[0] == side and part[1] in names and row != start]
        return [row for row in fitting if start in ancestors(self.tracks, row)]

    def bad(self, found: str, expected: str) -> BadInput:
        return BadInput("clip-skeleton", f"found {found}, expected {expected}", str(self.where))


def _arm(named: Named, elbow: int, side: int, chest: int) -> tuple[int | None, int, int, int | None]:
    """Collar bone, upper arm, last turning joint of the forearm, wrist."""
    parents = named.tracks.parents
    shoulder = int(parents[elbow])
    if shoulder == chest:
        raise named.bad(f"{named.tracks.names[elbow]} on the chest itself", "an upper arm between them")
    # of several hands and wrists the last is the one that the palm turns with
    hands = named.below(elbow, HAND, side)
    wrist = hands[-1] if hands else None
    collar = int(parents[shoulder]) if parents[shoulder] != chest else None
    return collar, shoulder, int(parents[wrist]) if wrist is not None else elbow, wrist


def _leg(named: Named, knee: int, side: int) -> tuple[int, int, int | None]:
    """Thigh, foot, toe."""
    feet = named.below(knee, FOOT, side)
    if not feet:
        raise named.bad(f"nothing called foot or ankle below {named.tracks.names[knee]}", "one")
    toes = named.below(feet[0], TOE, side)
    return int(named.tracks.parents[knee]), feet[0], toes[0] if toes else None


def _meet(tracks: Tracks, pair: tuple[int, int]) -> int:
    """The lowest joint that carries both."""
    right = ancestors(tracks, pair[1])
    return next(row for row in ancestors(tracks, pair[0]) if row in right)


def _neck(named: Named, chest: int) -> tuple[int, ...]:
    """The joints above the chest up to the head."""
    heads = named.below(chest, HEAD, None)
    if not heads:
        return ()
    below = ancestors(named.tracks, chest)
    return tuple(row for row in reversed(ancestors(named.tracks, heads[0])) if row not in below)


def restore_dropped_bones(tracks: Tracks, rig: Rig) -> Tracks:
    """Puts back the two bones that a common converter from Acclaim to BVH loses, so that neck and hands are where they
    belong.

    It writes the thorax and the last third of the forearm with no length (neck and shoulders then lie 12 cm too low).
    Their rotations are all there; their lengths follow from their neighbours: the thorax is as long as the bone below
    it, and the forearm's last third half as long as its first two."""
    offsets = tracks.offsets.copy()
    notes = list(tracks.notes)
    chest = rig.spine[-1]
    above = [row for row, parent in enumerate(tracks.parents) if parent == chest]
    if len(above) > 1 and not offsets[above].any() and offsets[chest].any():
        offsets[above] = offsets[chest]
        notes.append(f"bone {tracks.names[chest]} has no length; given that of the bone below it")
    for wrist in rig.wrist:
        if wrist is not None and not offsets[wrist].any():
            carrier = int(tracks.parents[wrist])
            offsets[wrist] = 0.5 * offsets[carrier]
            notes.append(f"bone {tracks.names[carrier]} has no length; given half that of the forearm before it")
    return (
        replace(tracks, offsets=offsets, notes=tuple(notes)) if not np.array_equal(offsets, tracks.offsets) else tracks
    )
