"""`brace stance`: its report, its JSON, its pictures, its refusals."""

import json

import numpy as np
import pytest
from PIL import Image

from behaviours.stance import sequence
from behaviours.stance.footprints import stand
from behaviours.stance.solve import solve_stance
from demos.cli import main
from demos.stance_pictures import foot_motion_m, there_and_back
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ANKLES, JOINTS

KEYS = {
    "set", "intensity", "states", "amplitudes", "penalties", "cycles", "evaluations", "milliseconds", "wrist_error_m",
    "foot_error_m", "com_m", "support_m", "pose",
}  # fmt: skip


def report_of(capsys, *words):
    assert main(["stance", *words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_json_has_what_the_interfaces_say(capsys):
    report = report_of(capsys, "reach-eager", "--intensity", "0.8", "--reach-right", "0.5,-0.2,1.2")
    assert report.keys() >= KEYS
    assert report["set"] == "reach-eager"
    assert report["intensity"] == 0.8
    assert set(report["amplitudes"]) == {"coronal", "sagittal", "transverse", "collar_y", "collar_z", "abdomen_x"}
    assert report["penalties"].keys() >= {"sagittal", "reach_right"}
    assert set(report["pose"]["joints_m"]) == set(report["pose"]["rotations_wxyz"]) == set(JOINTS)
    assert report["pose"]["joints_m"]["right_wrist"] == pytest.approx([0.5, -0.2, 1.2], abs=1e-3)
    assert report["wrist_error_m"]["right"] < 1e-3
    assert max(report["foot_error_m"].values()) < 1e-4
    assert np.hypot(*np.subtract(report["com_m"][:2], report["com_wanted_m"])) < 2e-3
    assert report["milliseconds"] > 0.0


def test_a_word_of_alberts_is_the_posture_it_stands_for(capsys):
    hunched, posture = report_of(capsys, "hunched"), report_of(capsys, "posture", "--intensity", "-1")
    assert hunched["pose"] == posture["pose"]


def test_the_object_is_what_it_turns_from(capsys):
    left, right = (report_of(capsys, "recoil-mild", "--object", f"1,{y},1.2") for y in (0.5, -0.5))
    assert left["pose"]["joints_m"]["head"][1] == pytest.approx(-right["pose"]["joints_m"]["head"][1], abs=1e-6)
    assert left["pose"]["joints_m"]["head"][1] < -0.02


def test_words_for_people(capsys):
    assert main(["stance", "slovenly", "--width", "0.3"]) == 0
    said = capsys.readouterr().out
    assert "sagittal SmallC" in said
    assert "limits      kept" in said


def test_the_list_names_every_set(capsys):
    from behaviours.stance.shape_sets import SETS

    assert main(["stance", "--list"]) == 0
    said = capsys.readouterr().out
    assert all(name in said for name in SETS)


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["poster"], "posture"), ([], "expected a SET"), (["posture", "--object", "1,2"], "three numbers"),
        (["posture", "--object", "a,b,c"], "three numbers"), (["posture", "--intensity", "nan"], "finite"),
        (["posture", "--height", "9"], "metres"), (["posture", "--width", "-1"], "metres"),
        (["posture", "-o", "x.jpg"], ".png"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_and_code_2(capsys, words, found):
    assert main(["stance", *words]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert found in said


def test_nowhere_to_write_is_code_3(capsys, tmp_path):
    assert main(["stance", "posture", "-o", str(tmp_path / "none" / "x.png")]) == 3


def test_a_picture_of_front_and_side(tmp_path, capsys):
    path = tmp_path / "stance.png"
    assert main(["stance", "recoil-strong", "--object", "1,0.4,1.3", "-o", str(path)]) == 0
    picture = np.asarray(Image.open(path).convert("L"), float)
    half = picture.shape[1] // 2
    front, side = picture[:, :half], picture[:, half:]
    assert picture.shape == (720, 960)
    assert front.std() > 5
    assert np.abs(front - side).mean() > 1


def test_a_film_of_getting_there(tmp_path, capsys):
    path = tmp_path / "stance.gif"
    assert main(["stance", "slovenly", "-o", str(path)]) == 0
    with Image.open(path) as film:
        assert film.n_frames > 60


def test_one_stance_after_the_other_is_filmed_on_feet_that_stay(tmp_path, capsys):
    path = tmp_path / "moods.gif"
    assert main(["stance", "interest", "--object", "0.8,0.3,1.2", "--then", "recoil-mild", "-o", str(path)]) == 0
    with Image.open(path) as film:
        assert film.n_frames > 120
    moved_mm = float(capsys.readouterr().out.split("feet move by ")[1].split(" mm")[0])
    assert moved_mm < 0.1


def test_another_width_is_stepped_to_and_back():
    body = standard_body()
    narrow, wide = (solve_stance(body, "posture", 0.2, feet=stand(body, width_m=m)) for m in (0.15, 0.42))
    frames = list(sequence.frames(body, *there_and_back(body, [narrow, wide])))
    widths_m = [float(np.ptp([frame.joints_m[ankle][1] for ankle in ANKLES])) for frame in frames]
    assert max(widths_m) == pytest.approx(0.42, abs=0.01)
    assert (widths_m[0], widths_m[-1]) == pytest.approx((0.15, 0.15), abs=1e-3)
    assert all(frame.planted.any() for frame in frames)
    assert foot_motion_m(frames) < 1e-4  # of feet that stand


@pytest.mark.parametrize("width", [0.12, 0.42])
def test_the_crouch_is_played_on_any_width_and_no_foot_moves(capsys, width):
    assert main(["stance", "--crouch", "--width", str(width), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["width_m"] == width
    assert found["foot_motion_m"] < 1e-4
    assert found["seconds"] > 5.0


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["posture", "--then", "hunched"], "needs a film"), (["posture", "--then", "hunch", "-o", "x.gif"], "hunched"),
        (["posture", "--then", "hunched:much", "-o", "x.gif"], "SET:X"),
        (["posture", "--then", "hunched:1:9", "-o", "x.gif"], "up to 1.5"),
        (["posture", "--crouch"], "instead of a SET"), (["--crouch", "-o", "x.png"], "film"),
        (["none.toml"], "cannot be read"),
    ],
)  # fmt: skip
def test_a_sequence_that_cannot_be_is_one_line(capsys, words, found):
    assert main(["stance", *words]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert found in said
