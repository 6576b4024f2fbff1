"""All the real motion capture there is: it stands upright on the floor, its limbs bend the right way, its feet stand
when seen to.

The ranges of frames in which feet were seen to stand were found by another program and looked at as pictures; they are
good to about five frames, in the file's own numbering."""

from __future__ import annotations

import functools
import re

import numpy as np
import pytest

from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, ELBOWS, HEAD, HIPS, KNEES, PELVIS, SHOULDERS
from engine.body.support import sole_points
from engine.clips.contacts import runs
from engine.clips.importing import import_clip
from engine.maths import rotations

# fmt: off
AMC = ["01_01", "02_01", "02_03", "02_05", "05_02", "07_04", "11_01", "135_04",
       "14_02", "14_31", "14_37", "16_01", "16_08", "16_17", "16_33", "49_18"]
BVH = ["01_01", "02_01", "07_04", "11_01_daz", "135_04_daz", "13_26"]
# fmt: on
FILES = [f"asfamc/{name}.amc" for name in AMC] + [f"bvh/{name}.bvh" for name in BVH]
# a foot that rolls over its edge (karate) dips half its width
SOLE_WITHIN_M = 0.04
TOLERANCE_FRAMES = 5


# every file is imported once, whichever tests of it run in this process
imported = functools.cache(import_clip)


@pytest.fixture(params=FILES)
def real(request, shared_mocap):
    return request.param, imported(shared_mocap / request.param), shared_mocap


def test_it_is_a_person_standing_up(real):
    _, clip, _ = real
    places, _ = joints_of(clip.body, clip.pose)
    assert 1.55 < clip.report.height_m < 1.85
    assert 0.78 < clip.report.leg_length_m < 0.90
    head_over_feet = places[:, HEAD, 2] - places[:, list(ANKLES), 2].min(axis=1)
    # one of them sits for most of his clip
    assert np.percentile(head_over_feet, 90) > 0.75 * clip.report.height_m
    assert np.percentile(head_over_feet, 1) > 0.3 * clip.report.height_m
    assert places[0, PELVIS, :2] == pytest.approx([0, 0], abs=1e-9)
    assert float(rotations.heading(clip.pose.rotations[0, PELVIS])) == pytest.approx(0.0, abs=1e-9)


def test_soles_of_standing_feet_are_on_the_floor(real):
    _, clip, _ = real
    places, turned = joints_of(clip.body, clip.pose)
    soles = np.array([sole_points(clip.body, p, q) for p, q in zip(places, turned, strict=True)])
    lowest = soles[..., 2].min(axis=2)
    assert clip.planted.any()
    assert np.abs(np.median(lowest[clip.planted])) < 0.02
    assert np.percentile(np.abs(lowest[clip.planted]), 90.0) < SOLE_WITHIN_M
    assert lowest.min() > -0.08  # toes pointed in the air before a landing


def test_left_is_left_and_limbs_bend_the_right_way(real):
    _, clip, _ = real
    places, turned = joints_of(clip.body, clip.pose)
    back = rotations.about_z(-rotations.heading(turned[:, PELVIS]))
    for pair in (HIPS, SHOULDERS):
        across = rotations.rotate(back, places[:, pair[0]] - places[:, pair[1]])
        assert np.median(across[:, 1]) > 0.1
    bones = rotations.rotate(clip.pose.rotations[:, [*ELBOWS, *KNEES]], np.array([0.0, 0.0, -1.0]))
    bend = np.arccos(np.clip(-bones[..., 2], -1.0, 1.0))
    bent = bend > np.radians(35.0)
    assert (bones[:, :2, 0][bent[:, :2]] > 0.0).all()
    assert (bones[:, 2:, 0][bent[:, 2:]] < 0.0).all()
    # of a good bend, what is not about Y
    assert np.abs(np.degrees(np.arctan2(bones[..., 1], np.abs(bones[..., 0]))))[bent].max() < 1.0


def test_only_files_with_an_added_rest_pose_lose_frames(real):
    name, clip, _ = real
    expected = 4 if "daz" in name else 1 if name.endswith(".bvh") else 0
    assert clip.report.rest_frames_dropped == expected


def test_standing_feet_are_found_where_they_were_seen(real):
    """Inside every range seen, five frames off its ends, both feet do what was seen in 95 frames of 100."""
    name, clip, folder = real
    wrong = seen = 0
    for feet, first, last in ranges_seen(folder / "README.md", name, clip.report.rest_frames_dropped):
        inside = slice(max(0, first + TOLERANCE_FRAMES if first > 0 else 0), last + 1 - TOLERANCE_FRAMES)
        doubtful = name == "asfamc/49_18.amc" and feet == (True, True)  # its own note: a toe that hangs low, no stand
        if not doubtful:
            wrong += (clip.planted[inside] != feet).any(axis=1).sum()
            seen += len(clip.planted[inside])
    assert seen > 0
    assert wrong <= 0.05 * seen


def ranges_seen(readme, name, dropped):
    """((left, right), first, last) in kept frames for every range in the table's row of that file."""
    row = next(line for line in readme.read_text().splitlines() if line.startswith(f"| {name} |"))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    for feet, cell in (((True, True), cells[8]), ((True, False), cells[9]), ((False, True), cells[10])):
        for first, last in re.findall(r"(\d+)-(\d+)", cell):
            yield feet, int(first) - dropped, int(last) - dropped


def test_the_ends_of_steps_are_found_to_five_frames(shared_mocap):
    """Of the ends of all single-support ranges seen, over every file: half within 2 frames, nine in ten within 8."""
    off = []
    for name in FILES:
        clip = imported(shared_mocap / name)
        for feet, first, last in ranges_seen(shared_mocap / "README.md", name, clip.report.rest_frames_dropped):
            if feet == (True, True):
                continue
            found = runs((clip.planted == feet).all(axis=1))
            best = max(found, key=lambda run: min(run[1], last) - max(run[0], first), default=None)
            assert best is not None, (name, first, last)
            off += [abs(best[0] - first)] * (first > 2) + [abs(best[1] - last)] * (last < clip.frames - 3)
    off = np.array(off)
    assert len(off) > 100
    assert np.median(off) <= 2
    assert np.percentile(off, 80) <= TOLERANCE_FRAMES
    assert np.percentile(off, 90) <= 8
