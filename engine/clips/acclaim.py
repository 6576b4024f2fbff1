"""Acclaim motion (.amc) on its skeleton (.asf), read strictly.

An ASF bone turns about its *start*; `direction` and `length` say where it ends, and its `axis` gives the frame in which
the AMC's angles are meant: local rotation = C M C^-1, with C from `axis` and M from the angles, both applied in the
order of their letters (x first). So every bone becomes a joint at its start whose rest orientation is the world's."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine.clips.asf import ROTATIONS, TRANSLATIONS, Bone, Skeleton, bad, parents_first, read_skeleton
from engine.clips.tracks import Tracks, numbers, read_lines
from engine.core.errors import BadInput
from engine.maths import rotations

# the rate of the whole CMU database; the format has no place to say it
FRAMES_PER_SECOND = 120.0
INCH_M = 0.0254


def read_acclaim(amc: str | Path, asf: str | Path) -> Tracks:
    """One motion on its skeleton. BadInput names file, line, what was found and what was expected."""
    amc, asf = Path(amc), Path(asf)
    skeleton = read_skeleton(asf)
    bones = parents_first(skeleton, asf)
    channels = read_channels(amc, skeleton)
    row_of = {bone.name: row for row, bone in enumerate(bones)}
    ends = np.array([np.array(bone.direction) * bone.length for bone in bones])
    parents = np.array([row_of[bone.parent] if bone.parent else -1 for bone in bones])
    is_leaf = ~np.isin(np.arange(len(bones)), parents)
    return Tracks(
        format="asf/amc",
        names=tuple(bone.name for bone in bones),
        parents=parents,
        offsets=np.where((parents >= 0)[:, None], ends[parents], 0.0),
        root=_root_path(skeleton, channels),
        rotations=np.stack([_turns(bone, channels[bone.name], skeleton.degrees) for bone in bones], axis=1),
        fps=FRAMES_PER_SECOND,
        tips={int(row): ends[row] for row in np.flatnonzero(is_leaf)},
        scale_to_m=INCH_M / skeleton.length_unit,
    )


def find_asf(amc: Path) -> Path:
    """The skeleton that belongs to a motion: SUBJECT_TRIAL.amc has SUBJECT.asf beside it, else the same stem, else the
    only one there."""
    beside = sorted(path for path in amc.parent.glob("*") if path.suffix.lower() == ".asf")
    for stem in (amc.stem, amc.stem.rsplit("_", 1)[0]):
        for path in beside:
            if path.stem == stem:
                return path
    if len(beside) == 1:
        return beside[0]
    found = f"{len(beside)} .asf files, none of that name" if beside else "no .asf file beside it"
    raise BadInput("asf-missing", f"found {found}, expected {amc.stem.rsplit('_', 1)[0]}.asf", str(amc))


def read_channels(path: Path, skeleton: Skeleton) -> dict[str, np.ndarray]:
    """The numbers of an .amc file: bone name -> (F, its channels), as written. Bones without dof get (F, 0)."""
    lines, number = read_lines(path), 0
    wanted = {name: len(bone.dof) for name, bone in skeleton.bones.items() if bone.dof}
    values: dict[str, list[list[float]]] = {name: [] for name in wanted}
    frame = 0
    for number, text in enumerate(lines, start=1):
        words = text.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0].startswith(":"):
            _check_keyword(words, skeleton, path, number)
        elif len(words) == 1 and words[0].isdigit():
            _check_complete(values, frame, path, number)
            frame += 1
            if int(words[0]) != frame:
                raise bad(path, number, f"frame number {words[0]}", f"{frame}")
        else:
            _use_bone_line(words, wanted, values, frame, path, number)
    _check_complete(values, frame, path, number)
    if frame == 0:
        raise BadInput("amc", "found no frame, expected at least one", str(path))
    return {name: np.array(values[name]) if name in values else np.zeros((frame, 0)) for name in skeleton.bones}


def _check_keyword(words: list[str], skeleton: Skeleton, path: Path, number: int) -> None:
    keyword = words[0].upper()
    if (keyword == ":RADIANS" and skeleton.degrees) or (keyword == ":DEGREES" and not skeleton.degrees):
        raise bad(path, number, keyword, "the same angle unit as in the .asf")


def _use_bone_line(
    words: list[str], wanted: dict[str, int], values: dict[str, list[list[float]]], frame: int, path: Path, number: int
) -> None:
    name = words[0]
    if name not in wanted:
        raise bad(path, number, f"unknown bone {name[:40]!r}", "a bone of the .asf that has dof")
    if frame == 0:
        raise bad(path, number, f"bone {name!r} before the first frame number", "1")
    if len(values[name]) == frame:
        raise bad(path, number, f"bone {name!r} twice in frame {frame}", "once")
    if len(words) - 1 != wanted[name]:
        raise bad(path, number, f"{len(words) - 1} numbers for {name!r}", f"{wanted[name]}, as its dof says")
    values[name].append(numbers(words[1:], f"{path}:{number}"))


def _check_complete(values: dict[str, list[list[float]]], frame: int, path: Path, number: int) -> None:
    """After a frame every bone with dof has had its line."""
    for name, rows in values.items():
        if len(rows) < frame:
            raise bad(path, number, f"frame {frame} ending without {name!r}", "a line for every bone with dof")


def _root_path(skeleton: Skeleton, channels: dict[str, np.ndarray]) -> np.ndarray:
    columns = [skeleton.bones["root"].dof.index(name) for name in TRANSLATIONS]
    return channels["root"][:, columns] + np.array(skeleton.root_position)


def _turns(bone: Bone, values: np.ndarray, degrees: bool) -> np.ndarray:
    """Local rotations (F, 4) of one bone: C M C^-1."""
    letters = [(ROTATIONS[name], k) for k, name in enumerate(bone.dof) if name in ROTATIONS]
    angles = np.radians(values) if degrees else values
    motion = _applied_in_order([letter for letter, _ in letters], angles[:, [k for _, k in letters]])
    # the axis angles are always written x y z, whatever the order in which they are applied
    axis = np.radians([bone.axis_deg["XYZ".index(letter)] for letter in bone.axis_order])
    frame = _applied_in_order(list(bone.axis_order), axis)
    return rotations.multiply(rotations.multiply(frame, motion), rotations.conjugate(frame))


def _applied_in_order(letters: list[str], angles_rad: np.ndarray) -> np.ndarray:
    """Rotations about fixed axes, the first letter applied first: the product the other way round."""
    return rotations.from_euler("".join(reversed(letters)), angles_rad[..., ::-1])
