"""Our BVH reader against another library, on every way in which such files are written, and on every way they break."""

from __future__ import annotations

import numpy as np
import pybvh
import pytest

from engine.clips.bvh import read_bvh
from engine.clips.tracks import world_of
from engine.core.errors import BadInput
from tests.clips.people import swing_arms, write_person

SHARED = ["01_01", "02_01", "07_04", "11_01_daz", "13_26", "135_04_daz"]


def assert_agrees_with_pybvh(path):
    """Every joint's place in every frame, within rounding."""
    tracks, other = read_bvh(path), pybvh.read_bvh_file(str(path))
    assert list(tracks.names) == list(other.joint_names)
    assert tracks.fps == pytest.approx(1.0 / other.frame_time, rel=2e-3)
    positions, _ = world_of(tracks)
    size = np.abs(tracks.offsets).max()
    np.testing.assert_allclose(positions, other.joint_positions(), atol=1e-6 * size)


def test_places_agree_with_pybvh(tmp_path):
    roots = np.random.default_rng(3).normal(size=(9, 3))
    assert_agrees_with_pybvh(write_person(tmp_path / "a.bvh", swing_arms(9), roots=roots, unit=100.0))


@pytest.mark.parametrize("name", SHARED)
def test_real_files_agree_with_pybvh(shared_mocap, name):
    assert_agrees_with_pybvh(shared_mocap / "bvh" / f"{name}.bvh")


def test_line_ends_make_no_difference(tmp_path):
    poses = swing_arms(4)
    plain = read_bvh(write_person(tmp_path / "lf.bvh", poses))
    for newline in ("\r\n", "\r", "\n\n"):
        other = read_bvh(write_person(tmp_path / "other.bvh", poses, newline=newline))
        np.testing.assert_array_equal(other.rotations, plain.rotations)
    mixed = tmp_path / "mixed.bvh"
    lines = (tmp_path / "lf.bvh").read_bytes().split(b"\n")
    mixed.write_bytes(b"".join(line + (b"\r\n" if k % 3 else b"\n") for k, line in enumerate(lines)))
    np.testing.assert_array_equal(read_bvh(mixed).rotations, plain.rotations)


def test_tabs_and_a_byte_order_mark_are_read(tmp_path):
    path = write_person(tmp_path / "a.bvh", swing_arms(2))
    marked = tmp_path / "marked.bvh"
    marked.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"Frames: ", b"Frames:\t").replace(b"  ", b"\t"))
    np.testing.assert_array_equal(read_bvh(marked).rotations, read_bvh(path).rotations)


def test_colons_in_names_are_kept(tmp_path):
    path = write_person(tmp_path / "a.bvh", swing_arms(2), prefix="mixamorig:")
    assert read_bvh(path).names[0] == "mixamorig:Hips"


def test_whole_rates_written_with_few_digits_are_whole(tmp_path):
    for written, fps in ((".0083333", 120.0), ("0.033333", 30.0), ("0.04166667", 24.0), ("0.0333667", 29.97)):
        path = write_person(tmp_path / "a.bvh", swing_arms(2))
        text = path.read_text().replace("Frame Time: 0.01666667", f"Frame Time: {written}")
        path.write_text(text)
        assert read_bvh(path).fps == pytest.approx(fps, rel=1e-6 if fps != 29.97 else 1e-3)


def test_joints_with_six_channels_are_read_if_their_bones_stay(tmp_path):
    path = write_person(tmp_path / "a.bvh", swing_arms(2))
    plain = read_bvh(path)
    lines = path.read_text().split("\n")
    at = next(k for k, line in enumerate(lines) if "JOINT Spine1" in line)
    lines[at + 3] = lines[at + 3].replace("3 Z", "6 Xposition Yposition Zposition Z")
    for k in (-3, -2):
        values = lines[k].split()
        lines[k] = " ".join(values[:9] + ["0.0", "0.18", "0.0"] + values[9:])
    path.write_text("\n".join(lines))
    np.testing.assert_array_equal(read_bvh(path).rotations, plain.rotations)
    lines[-2] = lines[-2].replace("0.18 ", "0.38 ", 1)
    path.write_text("\n".join(lines))
    with pytest.raises(BadInput) as bad:
        read_bvh(path)
    assert "'Spine1' sliding along Y" in bad.value.line()


def break_line(path, containing, replacement, occurrence=0):
    """Replaces the text of the nth line that contains something; returns that line's number."""
    lines = path.read_text().split("\n")
    at = [k for k, line in enumerate(lines) if containing in line][occurrence]
    lines[at] = replacement(lines[at]) if callable(replacement) else replacement
    path.write_text("\n".join(lines))
    return at + 1


BREAKS = [
    ("HIERARCHY", "HIERARHCY", "found 'HIERARHCY', expected the word HIERARCHY"),
    ("ROOT", "JOINT Hips", "expected ROOT and a name"),
    ("JOINT Spine1", "JOINT", "found JOINT without a name"),
    ("JOINT Spine1", "JOINT Hips", "found a second joint called 'Hips'"),
    ("OFFSET", "OFFSET 0.0 1.0", "expected OFFSET and three numbers"),
    ("OFFSET", "OFFSET 0.0 x 1.0", "found 'x', expected a number"),
    ("OFFSET", "OFFSET 0.0 nan 1.0", "found 'nan', expected a finite number"),
    ("CHANNELS 3", "CHANNELS 3 Zrotation Yrotation", "expected CHANNELS, their count, and as many names"),
    ("CHANNELS 3", "CHANNELS 3 Zrotation Yrotation Wrotation", "found channel 'Wrotation'"),
    ("CHANNELS 3", "CHANNELS 3 Zrotation Zrotation Yrotation", "found the same channel twice"),
    ("MOTION", "MOTIONS", "expected OFFSET, CHANNELS, JOINT, End Site or }"),
    ("Frames:", "Frames: many", "expected Frames: and how many"),
    ("Frames:", "Frames: 0", "expected Frames: and how many (one or more)"),
    ("Frame Time:", "Frame Time: 0", "found a frame time of 0 s"),
    ("0.0000000 0.9400000", "0.0 0.94 0.0", "found 3 numbers in frame 0, expected 66, one for each channel"),
    ("0.0000000 0.9400000", lambda line: line.replace("0.94", "O.94"), "found 'O.9400000', expected a number"),
    ("0.0000000 0.9400000", lambda line: line.replace("0.94", "inf "), "expected a finite number"),
]


@pytest.mark.parametrize(("containing", "replacement", "message"), BREAKS)
def test_a_broken_line_is_named_by_file_and_number(tmp_path, containing, replacement, message):
    path = write_person(tmp_path / "broken.bvh", swing_arms(3))
    if containing == "MOTION":
        # a lost closing brace shows where the motion begins
        break_line(path, "}", "", occurrence=-1)
        number = break_line(path, containing, replacement)
    elif message.endswith("a finite number") and callable(replacement):
        number = break_line(path, containing, lambda line: "inf " + line.split(" ", 1)[1])
    else:
        number = break_line(path, containing, replacement)
    with pytest.raises(BadInput) as bad:
        read_bvh(path)
    assert message in bad.value.line()
    assert f"{path}:{number}:" in bad.value.line()
    assert "\n" not in bad.value.line()


def test_too_few_and_too_many_frames_are_named(tmp_path):
    path = write_person(tmp_path / "a.bvh", swing_arms(3))
    whole = path.read_text()
    path.write_text(whole.replace("Frames: 3", "Frames: 4"))
    with pytest.raises(BadInput, match="found 3 frames, expected the 4 that the file declares"):
        read_bvh(path)
    path.write_text(whole.replace("Frames: 3", "Frames: 2"))
    with pytest.raises(BadInput, match="found another line, expected the end after the 2 frames"):
        read_bvh(path)


def test_files_that_are_no_clip_at_all_are_refused(tmp_path):
    for name, content, message in (
        ("empty.bvh", b"", "found an empty file"),
        ("blank.bvh", b"\n \r\n", "found an empty file"),
        ("binary.bvh", b"\0\1\2", "found binary data"),
        ("cut.bvh", b"HIERARCHY\nROOT Hips\n{\n", "found the end of the file"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(BadInput, match=message):
            read_bvh(tmp_path / name)
    with pytest.raises(BadInput, match="found no readable file"):
        read_bvh(tmp_path / "nowhere.bvh")


def test_every_prefix_of_a_file_is_read_or_refused_in_one_line(tmp_path):
    whole = write_person(tmp_path / "whole.bvh", swing_arms(2)).read_text()
    cut = tmp_path / "cut.bvh"
    for length in range(0, len(whole) - 12, 97):
        cut.write_text(whole[:length])
        with pytest.raises(BadInput) as bad:
            read_bvh(cut)
        assert "\n" not in bad.value.line()
