"""`brace pose`: the promised JSON, errors that fall, and wrong words in one line."""

import json
import math

import numpy as np
import pytest
from PIL import Image

from demos.cli import main

CASE = ("pose", "--clip", "sway", "--at", "1.0", "--azimuth", "30", "--elevation", "5", "--speed", "26")
FIELDS = {
    "controls", "controls_initial", "case", "support_m", "com_m", "com_wanted_m", "error", "error_initial", "solver",
    "pose", "threat",
}  # fmt: skip
TERMS = {"balance", "hands", "torso", "pelvis_height", "feet", "total"}
CONTROLS = {"lean", "turn", "recoil", "reach_left", "reach_right", "swivel_left", "swivel_right"}


def pose(capsys, *words):
    assert main([*CASE, "--json", *words]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_report_has_what_scripts_rely_on(capsys):
    found = pose(capsys)
    assert found.keys() >= FIELDS
    assert found["controls"].keys() == found["controls_initial"].keys() == CONTROLS
    assert found["error"].keys() >= TERMS
    assert found["error_initial"].keys() == found["error"].keys()
    assert found["solver"].keys() >= {"name", "iterations", "evaluations", "milliseconds"}
    assert found["pose"].keys() == found["com_m"].keys() == {"clip", "rules", "sustained"}
    assert found["threat"].keys() >= {"direction", "position_m", "velocity_mps", "ttc_s"}
    assert found["solver"]["milliseconds"] > 0.0


def test_balance_is_found_where_it_is_wanted(capsys):
    found = pose(capsys)
    assert found["error"]["total"] < found["error_initial"]["total"]
    assert found["error"]["balance"] < found["error_initial"]["balance"]
    assert math.dist(found["com_m"]["sustained"][:2], found["com_wanted_m"]) < 0.02


def test_the_threat_comes_from_where_it_was_said(capsys):
    """Azimuth 30 is ahead and to the left of somebody who faces +X, so it travels back and to the right."""
    x, y, _ = pose(capsys)["threat"]["direction"]
    assert math.degrees(math.atan2(-y, -x)) == pytest.approx(30, abs=6)


def test_a_constant_can_be_changed(capsys):
    wanted = [pose(capsys, "--set", f"balance.brace_m={brace}") for brace in (0.0, 0.1)]
    assert math.dist(wanted[0]["com_wanted_m"], wanted[1]["com_wanted_m"]) == pytest.approx(0.1, abs=1e-6)


def test_a_stance_is_worn_under_the_clip(capsys):
    plain, hunched, word, none = (
        pose(capsys, *words)
        for words in ((), ("--stance", "posture:-1"), ("--stance", "hunched"), ("--stance", "posture:0"))
    )
    heads = [found["pose"]["clip"]["joints_m"]["head"] for found in (plain, hunched)]
    assert heads[1][0] > heads[0][0] + 0.05  # over the toes of somebody who faces +X
    for foot in ("left_ankle", "right_ankle"):
        assert hunched["pose"]["clip"]["joints_m"][foot] == pytest.approx(plain["pose"]["clip"]["joints_m"][foot])
    assert hunched["stance"] == {"set_name": "posture", "intensity": -1.0}
    assert word["pose"] == hunched["pose"]
    assert none["pose"] == plain["pose"]
    assert plain["stance"] is None


def test_a_pose_and_a_run_agree_on_what_a_stance_makes_of_it(capsys):
    """The same threat in a scenario: the pose that the simulation works out is that of the command."""
    from behaviours.components import Phase, Reaction, Sustained
    from behaviours.scenario import check_scenario
    from behaviours.simulation import Simulation
    from engine.body.kinematics import joints_of
    from engine.body.skeleton import WRISTS, Pose
    from engine.clips.library import find_clip

    person = {"clip": "sway", "start_s": 0.0, "startle": False, "boldness": -0.5}
    threat = {"azimuth_deg": 30.0, "elevation_deg": 5.0, "speed_mps": 26.0, "perceived_s": 1.0}
    stanced = person | {"stance": {"set": "posture", "intensity": -0.8}}
    run = Simulation(
        check_scenario({"version": 1, "duration_s": 2.0, "character": [stanced], "threat": [threat]}),
        lambda spec: find_clip(spec.clip),
    )
    while run.world[Reaction].phase[0] == Phase.PLAY:
        run.step()
    s = run.world[Sustained]
    body = run.world.assets.bodies[0]
    ran = joints_of(body, Pose(s.root_m[0].copy(), s.rotations[0].copy()))[0][list(WRISTS)]
    said = pose(capsys, "--stance", "posture:-0.8", "--boldness", "-0.5")["pose"]["sustained"]["joints_m"]
    assert np.abs(ran - [said["left_wrist"], said["right_wrist"]]).max() < 0.03  # a tick apart, and two searches


def test_words_show_every_term(capsys):
    assert main(CASE) == 0
    out = capsys.readouterr().out
    assert all(word in out for word in TERMS | CONTROLS)


def test_a_picture_is_drawn(brace, tmp_path):
    assert brace(*CASE, "-o", "pose.png").returncode == 0
    with Image.open(tmp_path / "pose.png") as picture:
        assert picture.size == (1200, 900)
        few = picture.convert("P", palette=Image.Palette.ADAPTIVE).convert("RGB")
    colours = {pixel for _, pixel in few.getcolors()}
    assert any(red > 200 and 90 < green < 190 and blue < 90 for red, green, blue in colours)  # the thesis's orange


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--target", "hed"], 2),
        (["--kind", "footbal"], 2),
        (["--size", "1.5"], 2),
        (["--elevation", "90"], 2),
        (["--speed", "0"], 2),
        (["--at", "-1"], 2),
        (["--clip", "nowhere.bvh"], 2),
        (["--set", "balance.brce_m=1"], 2),
        (["--set", "balance.brace_m"], 2),
        (["--stance", "postur:1"], 2),
        (["--stance", "posture:much"], 2),
        (["--stance", "posture:nan"], 2),
        (["--stance", "posture:-2.5"], 2),
        (["--boldness", "1.5"], 2),
        (["-o", "pose.jpg"], 2),
        (["-o", "nowhere/pose.png"], 3),
    ],
)
def test_what_cannot_be_done_is_one_line(words, code, capsys):
    assert main([*CASE, *words]) == code
    err = capsys.readouterr().err
    assert err.startswith("error[")
    assert err.count("\n") == 1
