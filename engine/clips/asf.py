"""Acclaim skeletons (.asf), read strictly: bones with direction, length, axis and degrees of freedom, and who hangs on
whom."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from engine.clips.tracks import numbers, read_lines
from engine.core.errors import BadInput

ROTATIONS, TRANSLATIONS = {"rx": "X", "ry": "Y", "rz": "Z"}, {"tx": 0, "ty": 1, "tz": 2}


@dataclass
class Bone:
    """One bone of the skeleton; the root is one of no length."""

    name: str
    line: int
    direction: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    length: float = 0.0
    axis_deg: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    axis_order: str = "XYZ"
    dof: list[str] = field(default_factory=list)  # channel names in the AMC's order
    parent: str | None = None


@dataclass
class Skeleton:
    """What an .asf file says."""

    bones: dict[str, Bone]
    length_unit: float
    degrees: bool
    root_position: list[float]


def read_skeleton(path: Path) -> Skeleton:
    """The bones of an .asf file, each with its parent."""
    sections = _sections(path)
    length_unit, degrees = _units(sections, path)
    root = _root(sections, path)
    bones = {"root": root}
    for bone in _bones(sections, path, degrees):
        if bone.name in bones:
            raise bad(path, bone.line, f"a second bone called {bone.name!r}", "different names")
        bones[bone.name] = bone
    _link(bones, sections, path)
    return Skeleton(bones, length_unit, degrees, root.direction)


def bad(path: Path, line: int, found: str, expected: str) -> BadInput:
    """One complaint about one line of an .asf or .amc file."""
    return BadInput(
        "asf" if path.suffix.lower() == ".asf" else "amc", f"found {found}, expected {expected}", f"{path}:{line}"
    )


Line = tuple[int, list[str]]


def _sections(path: Path) -> dict[str, list[Line]]:
    """{":root": [(line number, words) ...], ...}; comments and empty lines left out; a section's own line comes
    first."""
    sections: dict[str, list[Line]] = {}
    current: list[Line] | None = None
    for number, text in enumerate(read_lines(path), start=1):
        words = text.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0].startswith(":"):
            current = sections.setdefault(words[0].lower(), [])
        elif current is None:
            raise bad(path, number, repr(words[0][:40]), "a section such as :units")
        current.append((number, words))
    for needed in (":units", ":root", ":bonedata", ":hierarchy"):
        if needed not in sections:
            raise BadInput("asf", f"found no {needed} section, expected one", str(path))
    return sections


def _units(sections: dict[str, list[Line]], path: Path) -> tuple[float, bool]:
    length, degrees = 1.0, True
    for number, words in sections[":units"][1:]:
        if words[0] == "length":
            length = numbers(words[1:2], f"{path}:{number}")[0] if len(words) == 2 else 0.0
            if length <= 0.0:
                raise bad(path, number, " ".join(words), "length and one number above zero")
        elif words[0] == "angle":
            degrees = words[1:] != ["rad"]
    return length, degrees


def _root(sections: dict[str, list[Line]], path: Path) -> Bone:
    """The root as a bone; its `direction` carries the position at which the skeleton was drawn."""
    root = Bone("root", sections[":root"][0][0])
    for number, words in sections[":root"][1:]:
        where = f"{path}:{number}"
        if words[0] == "order":
            root.dof = [word.lower() for word in words[1:]]
        elif words[0] == "axis":
            root.axis_order = _axis_order(words[1:], path, number)
        elif words[0] == "position":
            root.direction = _three(words[1:], path, number)
        elif words[0] == "orientation":
            root.axis_deg = _three(words[1:], path, number)
        else:
            raise BadInput("asf", f"found {words[0]!r}, expected order, axis, position or orientation", where)
    if sorted(root.dof) != sorted([*ROTATIONS, *TRANSLATIONS]):
        raise bad(path, root.line, f"root order {' '.join(root.dof)!r}", "TX TY TZ RX RY RZ in some order")
    return root


def _three(words: list[str], path: Path, number: int) -> list[float]:
    if len(words) != 3:
        raise bad(path, number, f"{len(words)} numbers", "three")
    return numbers(words, f"{path}:{number}")


def _axis_order(words: list[str], path: Path, number: int) -> str:
    order = words[0].upper() if len(words) == 1 else ""
    if sorted(order) != ["X", "Y", "Z"]:
        raise bad(path, number, repr(" ".join(words)[:40]), "an axis order such as XYZ")
    return order


def _bones(sections: dict[str, list[Line]], path: Path, degrees: bool) -> list[Bone]:
    bones: list[Bone] = []
    inside = False
    for number, words in sections[":bonedata"][1:]:
        if words[0] == "begin":
            bones.append(Bone("", number))
            inside = True
        elif words[0] == "end":
            _check_bone(bones[-1] if inside else None, path, number)
            inside = False
        elif not inside:
            raise bad(path, number, repr(words[0][:40]), "begin")
        else:
            _bone_line(bones[-1], words, path, number)
    if inside:
        raise bad(path, bones[-1].line, "a bone that does not end", "begin ... end")
    if not degrees:
        for bone in bones:
            bone.axis_deg = [float(np.degrees(angle)) for angle in bone.axis_deg]
    return bones


def _check_bone(bone: Bone | None, path: Path, number: int) -> None:
    if bone is None:
        raise bad(path, number, "end", "begin first")
    if not bone.name:
        raise bad(path, number, "a bone without a name", "name and a word")
    if abs(np.linalg.norm(bone.direction) - 1.0) > 1e-2:
        raise bad(path, bone.line, f"bone {bone.name!r} with direction {bone.direction}", "a direction of length one")


def _bone_line(bone: Bone, words: list[str], path: Path, number: int) -> None:
    key, rest = words[0], words[1:]
    if key == "name" and len(rest) == 1:
        bone.name = rest[0]
    elif key == "direction":
        bone.direction = _three(rest, path, number)
    elif key == "length" and len(rest) == 1:
        bone.length = numbers(rest, f"{path}:{number}")[0]
    elif key == "axis":
        bone.axis_deg, bone.axis_order = _three(rest[:3], path, number), _axis_order(rest[3:], path, number)
    elif key == "dof":
        bone.dof = [word.lower() for word in rest]
        unknown = [word for word in bone.dof if word not in ROTATIONS]
        if unknown or len(set(bone.dof)) != len(bone.dof):
            raise bad(path, number, f"dof {' '.join(rest)!r}", "rx, ry, rz, each at most once")
    elif key not in ("id", "limits", "bodymass", "cofmass") and not key.startswith("("):
        raise bad(path, number, repr(" ".join(words)[:40]), "id, name, direction, length, axis, dof or limits")


def _link(bones: dict[str, Bone], sections: dict[str, list[Line]], path: Path) -> None:
    for number, words in sections[":hierarchy"][1:]:
        if words in (["begin"], ["end"]):
            continue
        for name in words:
            if name not in bones:
                raise bad(path, number, f"unknown bone {name!r}", "one from :bonedata")
        for child in words[1:]:
            if bones[child].parent is not None or child == "root":
                raise bad(path, number, f"a second parent for {child!r}", "one")
            bones[child].parent = words[0]
    for bone in bones.values():
        if bone.parent is None and bone.name != "root":
            raise bad(path, bone.line, f"bone {bone.name!r} outside the :hierarchy", "every bone in it")


def parents_first(skeleton: Skeleton, path: Path) -> list[Bone]:
    """The bones in an order in which every parent comes before its children."""
    ordered = [skeleton.bones["root"]]
    for bone in ordered:  # grows while we walk it
        ordered.extend(child for child in skeleton.bones.values() if child.parent == bone.name)
    if len(ordered) != len(skeleton.bones):
        raise BadInput("asf", "found bones that hang on each other in a ring, expected a tree from root", str(path))
    return ordered
