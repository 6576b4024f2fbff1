"""Every figure of the sources draws from the running system: seen whole, in the thesis's colours, with its words."""

from __future__ import annotations

import colorsys
import json
import math
import os
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from demos.figures import FIGURES, find_figure
from engine.core.errors import BadInput
from tests.conftest import ROOT

# hues of the thesis's colours, degrees, as the lit mannequin shows them
HUES = {"blue": (205, 230), "yellow": (44, 62), "orange": (16, 41), "red": (350, 368)}
COLOURS = {
    "1.1": "blue orange red", "1.2": "blue yellow orange red", "2.1": "blue", "3.1": "", "3.2": "blue yellow",
    "3.3": "blue yellow", "3.4": "blue yellow", "3.5": "blue yellow", "3.6": "blue yellow", "3.7": "yellow",
    "3.8": "yellow", "3.9": "yellow orange", "3.10": "orange", "3.11": "orange", "3.12": "blue orange",
    "4.1": "blue orange red", "5.1": "orange", "5.2": "blue orange red", "sweep": "orange",
    "stance-1": "", "stance-3": "", "stance-4": "blue", "stance-5": "", "stance-6": "red", "stance-7": "red",
    "stance-8": "blue red", "stance-meets-threat": "blue orange",
}  # fmt: skip
WORDS = {
    "1.1": ["clip", "blends", "sustained pose", "simulated"],
    "1.2": ["clip", "rules alone", "sustained pose", "simulated", "COM"],
    "2.1": ["theta", "mathbf{F}", "mathbf{T}"],
    "3.1": ["pelvis", "left clavicle", "right toe", "hinge", "$X$", "$Y$", "$Z$"],
    "3.2": ["position, right to left", "size, small to large", "speed, slow to fast", "22.8 m/s", "29.7 m/s"],
    "3.3": ["lean away", "lean control", "input", "output", "neck", "pelvis"],
    "3.4": ["turn away", "turn control", "all together"],
    "3.5": ["recoil", "recoil control", "clavicle, raised"],
    "3.6": ["block", "line of approach", "palm from shoulder"],
    "3.7": ["left, ", "right, ", "line of approach"],
    "3.8": ["shoulder", "elbow", "wrist", "70°", "10°"],
    "3.9": ["in balance: braced", "out of balance", "rules alone"],
    "3.10": ["case 1", "case 2", "case 3", "COM_{cur}", "COM_{des}", "10 cm"],
    "3.11": ["from behind", "from the front"],
    "3.12": ["clip", "impact to the head", "impact to the pelvis", "impact between", "W_"],
    "4.1": ["startle", "sustained", "return", "physical simulation", "time to contact"],
    "5.1": ["22.8 m/s", "29.7 m/s", "TTC"],
    "5.2": ["the same motion", "a new motion, mild", "a new motion, extreme"],
    "sweep": ["size 0", "size 1", "22.8 m/s", "29.7 m/s", "right", "left"],
    "stance-1": ["plain", "beauty line", "eager", "reluctant", "wrist off by 0.0 mm"],
    "stance-3": ["abdomen  X Y Z", "collar bone  Y Z", "knee  X", "= 48 degrees of freedom"],
    "stance-4": ["desired value", "basin", "wall", "flat basin", "steep sides", "asymmetric"],
    "stance-5": ["hunched", "tired", "relaxed", "over-erect"],
    "stance-6": ["recoil, mild", "coronal LargeS, sagittal SmallC", "collars Y opposed, Z aligned"],
    "stance-7": ["0.3", "0.6", "1.0", "1.3"],
    "stance-8": ["root hip", "free hip", "root ankle", "free ankle", "A", "B", "C", "hip vector as asked for"],
    "stance-meets-threat": ["timid", "tired", "alert", "proud", "boldness", "cm off", "nothing comes"],
}
FROM_SWAY_ALONE = ("1.1", "3.2", "3.9", "3.10", "5.2", "stance-meets-threat")


def print_figures(folder: Path, names, **environment) -> Path:
    """Draws them into the folder in a process of its own: no two tests' graphics contexts may meet."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "tests" / "figures" / "print_figures.py"), str(folder), *names],
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def printed(tmp_path_factory) -> Path:
    """All figures, from the clips that are here."""
    return print_figures(tmp_path_factory.mktemp("figures"), [entry.name for entry in FIGURES])


def pixels(folder: Path, name: str) -> np.ndarray:
    return np.asarray(Image.open(folder / f"{name}.png").convert("RGB"))


def words(folder: Path, name: str) -> str:
    return "\n".join(json.loads((folder / f"{name}.json").read_text())["words"])


def share_of_hue(picture: np.ndarray, low_deg: float, high_deg: float) -> float:
    """The share of a picture in strong colours of these hues."""
    inked = picture[np.ptp(picture.astype(int), axis=-1) > 90] / 255.0
    hues = [360.0 * colorsys.rgb_to_hsv(*rgb)[0] for rgb in inked]
    return sum(low_deg <= hue <= high_deg or low_deg <= hue + 360.0 <= high_deg for hue in hues) / picture[..., 0].size


def test_every_figure_has_its_row_here():
    assert [entry.name for entry in FIGURES] == list(WORDS) == list(COLOURS)


@pytest.mark.parametrize("name", WORDS)
def test_a_figure_is_drawn_on_white_paper(printed, name):
    picture = pixels(printed, name)
    inked = (picture < 235).any(axis=-1).mean()
    assert 0.02 < inked < 0.7
    rim = np.concatenate([picture[0], picture[-1]])
    assert np.median(rim) == 255


@pytest.mark.parametrize("name", COLOURS)
def test_a_figure_has_the_colours_of_the_thesis(printed, name):
    picture = pixels(printed, name)
    for colour in COLOURS[name].split():
        assert share_of_hue(picture, *HUES[colour]) > 5e-4, colour


@pytest.mark.parametrize("name", WORDS)
def test_a_figure_says_what_it_shows(printed, name):
    text = words(printed, name)
    for word in WORDS[name]:
        assert word in text, word
    assert "nan" not in text.lower()


def test_stills_know_where_things_are(printed):
    probe = json.loads((printed / "stills.json").read_text())
    assert probe["paper"] == 255
    for seen, said in zip(probe["seen"], probe["said"], strict=True):
        assert math.dist(seen, said) < 1.0  # a pixel and a half


def test_a_figure_is_the_same_each_time(printed):
    assert (printed / "again.png").read_bytes() == (printed / f"{FIGURES[0].name}.png").read_bytes()


def test_the_numbers_of_the_lean_panel_add_up(printed):
    """Greatest rotation times control times the component of the travel, from what is written on the panel alone."""
    written = words(printed, "3.3").replace("\N{MINUS SIGN}", "-").split("\n")
    after = dict(pairwise(written))
    dx, dy, _ = (float(part) for part in after["travel $\\vec{D}$"].strip("()").split(","))
    control = float(after["lean control"])
    neck = [float(part.rstrip("°")) for part in written[len(written) - 1 - written[::-1].index("neck") + 1].split(", ")]
    assert neck == pytest.approx([-dy * 50 * control, dx * 50 * control], abs=0.5)


def test_the_timing_is_that_of_a_run(printed):
    """The durations on the schematic against the phases that a simulation goes through."""
    from behaviours.scenario import check_scenario
    from behaviours.simulation import Simulation
    from engine.clips.library import find_clip

    threat = {"azimuth_deg": 0.0, "elevation_deg": 10.0, "speed_mps": 26.0, "perceived_s": 0.5}
    run = Simulation(
        check_scenario({"version": 1, "duration_s": 2.2, "character": [{"clip": "sway"}], "threat": [threat]}),
        lambda spec: find_clip(spec.clip), observe=True,
    )  # fmt: skip
    for _ in range(run.ticks):
        run.step()
    phases = {phase["name"]: 1000.0 * (phase["to_s"] - phase["from_s"]) for phase in run.report()["phases"]}
    written = [float(word) for word in re.findall(r"^\d+$", words(printed, "4.1"), re.MULTILINE)]
    ran = [phases[name] for name in ("startle", "protect", "respond", "recover_blend", "recover_return")]
    # contact is a matter of geometry: a palm is met before the ball's centre would reach the target
    assert written[0] == pytest.approx(ran[0], abs=9.0)
    assert written[2:] == pytest.approx(ran[2:], abs=9.0)
    assert written[0] + written[1] == pytest.approx(ran[0] + ran[1], abs=45.0)


def test_figures_need_no_fetched_clip(tmp_path):
    folder = print_figures(tmp_path, FROM_SWAY_ALONE, BRACE_CACHE=str(tmp_path / "empty"))
    for name in FROM_SWAY_ALONE:
        assert "drawn with the embedded clip; walk" in words(folder, name)
        assert 0.02 < (pixels(folder, name) < 235).any(axis=-1).mean() < 0.7


def test_an_unknown_figure_is_met_with_all_of_them_nearest_first():
    with pytest.raises(BadInput) as caught:
        find_figure("swep")
    assert caught.value.message.startswith("unknown figure 'swep'; expected one of sweep, ")
    assert all(entry.name in caught.value.message for entry in FIGURES)
