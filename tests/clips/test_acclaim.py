"""Our ASF/AMC reader against the same arithmetic done with plain matrices, and on every way such files break."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.clips.acclaim import find_asf, read_acclaim
from engine.clips.tracks import world_of
from engine.core.errors import BadInput

ASF = """# made for a test
:version 1.10
:name tester
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
   root is only a word here
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name femur
     direction 0.6 -0.8 0
     length 7.0
     axis 10 20 30 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
     id 2
     name tibia
     direction 0 -1 0
     length 7.5
     axis 40 50 -60 XYZ
    dof rx rz
  end
  begin
     id 3
     name foot
     direction 0 0 1
     length 2.0
     axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root femur
    femur tibia
    tibia foot
  end
"""
AMC = """#!OML:ASF somewhere
# one more comment, as some copies have
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 10 20 30
femur 5 15 25
tibia 35 45
2
root 1.5 2 3 11 21 31
tibia 36 46
femur 6 16 26
"""


@pytest.fixture
def files(tmp_path):
    (tmp_path / "01.asf").write_text(ASF)
    (tmp_path / "01_01.amc").write_text(AMC)
    return tmp_path / "01_01.amc", tmp_path / "01.asf"


def fixed_axes(degrees):
    """Rotation matrix about fixed x, then y, then z."""
    return Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()


def test_places_are_those_of_plain_matrices(files):
    tracks = read_acclaim(*files)
    positions, orientations = world_of(tracks)
    assert tracks.names == ("root", "femur", "tibia", "foot")
    for frame, (root, r, f, t) in enumerate([
        ((1, 2, 3), (10, 20, 30), (5, 15, 25), (35, 0, 45)),
        ((1.5, 2, 3), (11, 21, 31), (6, 16, 26), (36, 0, 46)),
    ]):  # fmt: skip
        femur_axis, tibia_axis = fixed_axes((10, 20, 30)), fixed_axes((40, 50, -60))
        world_femur = fixed_axes(r) @ femur_axis @ fixed_axes(f) @ femur_axis.T
        knee = np.array(root) + world_femur @ np.array([0.6, -0.8, 0]) * 7.0
        world_tibia = world_femur @ tibia_axis @ fixed_axes(t) @ tibia_axis.T
        ankle = knee + world_tibia @ np.array([0, -1, 0]) * 7.5
        np.testing.assert_allclose(positions[frame], [root, root, knee, ankle], atol=1e-12)
        turned = Rotation.from_quat(orientations[frame, 3], scalar_first=True).as_matrix()
        np.testing.assert_allclose(turned, world_tibia, atol=1e-12)


def test_the_unit_is_the_files_own_and_the_rate_is_the_databases(files):
    tracks = read_acclaim(*files)
    assert tracks.scale_to_m == pytest.approx(0.0254 / 0.45)
    assert tracks.fps == 120.0
    np.testing.assert_allclose(tracks.tips[3], [0, 0, 2.0])


@pytest.mark.parametrize("newline", ["\r\n", "\r"])
def test_line_ends_make_no_difference(files, newline):
    plain = read_acclaim(*files)
    for path in files:
        path.write_bytes(path.read_text().replace("\n", newline).encode())
    np.testing.assert_array_equal(read_acclaim(*files).rotations, plain.rotations)


def test_radians_say_the_same(files):
    plain = read_acclaim(*files)
    amc, asf = files
    asf.write_text(ASF.replace("angle deg", "angle rad").replace("axis 10 20 30", "axis " + rad("10 20 30"))
                   .replace("axis 40 50 -60", "axis " + rad("40 50 -60")))  # fmt: skip
    lines = AMC.replace(":DEGREES", ":RADIANS").split("\n")
    for k, line in enumerate(lines):
        words = line.split()
        if words and words[0] in ("root", "femur", "tibia"):
            kept = words[1:4] if words[0] == "root" else []
            lines[k] = " ".join([words[0], *kept, rad(" ".join(words[1 + len(kept) :]))])
    amc.write_text("\n".join(lines))
    np.testing.assert_allclose(read_acclaim(*files).rotations, plain.rotations, atol=1e-12)


def rad(degrees):
    return " ".join(f"{np.radians(float(word)):.15g}" for word in degrees.split())


AMC_BREAKS = [
    (":DEGREES", ":RADIANS", 4, "found :RADIANS, expected the same angle unit as in the .asf"),
    ("femur 5 15 25", "femur 5 15", 7, "found 2 numbers for 'femur', expected 3, as its dof says"),
    ("femur 5 15 25", "femur 5 15 x", 7, "found 'x', expected a number"),
    ("femur 5 15 25", "femur 5 15 nan", 7, "found 'nan', expected a finite number"),
    ("femur 5 15 25", "femur 5 15 25\nfemur 5 15 25", 8, "found bone 'femur' twice in frame 1"),
    ("femur 5 15 25", "fibula 5 15 25", 7, "found unknown bone 'fibula'"),
    ("femur 5 15 25", "foot 5", 7, "found unknown bone 'foot', expected a bone of the .asf that has dof"),
    ("tibia 35 45\n2", "2", 8, "found frame 1 ending without 'tibia'"),
    ("\n2\n", "\n3\n", 9, "found frame number 3, expected 2"),
    ("femur 6 16 26\n", "", 12, "found frame 2 ending without 'femur'"),
    ("1\nroot 1 2", "root 1 2", 5, "found bone 'root' before the first frame number"),
]


@pytest.mark.parametrize(("found", "put", "number", "message"), AMC_BREAKS)
def test_a_broken_motion_is_named_by_file_and_line(files, found, put, number, message):
    amc, asf = files
    amc.write_text(AMC.replace(found, put, 1))
    with pytest.raises(BadInput) as bad:
        read_acclaim(amc, asf)
    assert message in bad.value.line()
    assert f"{amc}:{number}:" in bad.value.line()


ASF_BREAKS = [
    (":units", ":unit", "found no :units section"),
    ("length 0.45", "length none", "found 'none', expected a number"),
    ("length 0.45", "length -1", "expected length and one number above zero"),
    ("order TX TY TZ RX RY RZ", "order TX TY TZ RX RY", "expected TX TY TZ RX RY RZ in some order"),
    ("axis 10 20 30 XYZ", "axis 10 20 30 XXZ", "expected an axis order such as XYZ"),
    ("axis 10 20 30 XYZ", "axis 10 20", "found 2 numbers, expected three"),
    ("dof rx ry rz", "dof rx ry l", "expected rx, ry, rz, each at most once"),
    ("dof rx ry rz", "dof rx rx", "expected rx, ry, rz, each at most once"),
    ("direction 0.6 -0.8 0", "direction 0.6 -0.9 0", "expected a direction of length one"),
    ("name tibia", "name femur", "found a second bone called 'femur'"),
    ("name tibia", "nickname tibia", "expected id, name, direction"),
    ("femur tibia", "femur fibula", "found unknown bone 'fibula', expected one from :bonedata"),
    ("tibia foot", "", "found bone 'foot' outside the :hierarchy"),
    ("tibia foot", "tibia foot femur", "found a second parent for 'femur'"),
    ("root femur", "foot femur", "found bones that hang on each other in a ring"),
    ("     id 2\n", "end\n", "found a bone without a name"),
]


@pytest.mark.parametrize(("found", "put", "message"), ASF_BREAKS)
def test_a_broken_skeleton_is_named(files, found, put, message):
    amc, asf = files
    asf.write_text(ASF.replace(found, put, 1))
    with pytest.raises(BadInput) as bad:
        read_acclaim(amc, asf)
    assert message in bad.value.line()
    assert str(asf) in bad.value.line()
    assert "\n" not in bad.value.line()


def test_a_motion_without_frames_is_refused(files):
    amc, asf = files
    amc.write_text(":FULLY-SPECIFIED\n:DEGREES\n")
    with pytest.raises(BadInput, match="found no frame"):
        read_acclaim(amc, asf)


def test_the_skeleton_beside_is_found_by_name_or_by_being_the_only_one(tmp_path):
    amc = tmp_path / "07_04.amc"
    with pytest.raises(BadInput, match=r"found no .asf file beside it, expected 07.asf"):
        find_asf(amc)
    (tmp_path / "other.asf").touch()
    assert find_asf(amc).name == "other.asf"
    (tmp_path / "another.asf").touch()
    with pytest.raises(BadInput, match=r"found 2 .asf files, none of that name"):
        find_asf(amc)
    (tmp_path / "07.asf").touch()
    assert find_asf(amc).name == "07.asf"
    (tmp_path / "07_04.ASF").touch()
    assert find_asf(amc).name == "07_04.ASF"
