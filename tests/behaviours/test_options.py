"""What chapter 5 of the thesis varies: each can be said in a scenario and by an override, and changes the run."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Phase, Reaction
from behaviours.scenario import load_scenario, parse_scenario
from behaviours.settings import CHOICES, Settings
from behaviours.simulation import Simulation
from engine.clips.library import find_clip
from tests.behaviours.runs import events, phases, track_of

USUAL = """
seed = 3
duration_s = 2.2
library = ["sway", "kneel", "stand"]

[[character]]
clip = "sway"
start_s = 0.5

[[threat]]
target = "head"
perceived_s = 0.2
azimuth_deg = 40
elevation_deg = 10
speed_mps = 26.0
size = 0.5
"""

# option: what to override, and the same as lines of a scenario: (section, line)
OPTIONS = {
    "another motion": ("character.0.clip=stand", ("character", 'clip = "stand"')),
    "another frame of the motion": ("character.0.start_s=0.9", ("character", "start_s = 0.9")),
    "another frame of perception": ("threat.0.perceived_s=0.3", ("threat", "perceived_s = 0.3")),
    "a new motion": ("character.0.recover=new", ("character", 'recover = "new"')),
    "no startle": ("character.0.startle=false", ("character", "startle = false")),
    "no protection": ("character.0.protects=false", ("character", "protects = false")),
    "from the other side": ("threat.0.azimuth_deg=-40", ("threat", "azimuth_deg = -40")),
    "from higher": ("threat.0.elevation_deg=20", ("threat", "elevation_deg = 20")),
    "another target": ("threat.0.target=torso", ("threat", 'target = "torso"')),
    "larger": ("threat.0.size=0.9", ("threat", "size = 0.9")),
    "faster": ("threat.0.speed_mps=29", ("threat", "speed_mps = 29")),
    "size means the radius": ("threat.0.size_means=radius", ("threat", 'size_means = "radius"')),
    "size means the mass": ("threat.0.size_means=mass", ("threat", 'size_means = "mass"')),
    "what counts as fast": ("threat.0.speed_range_mps=[10, 30]", ("threat", "speed_range_mps = [10, 30]")),
    "a given time to contact": ("threat.0.ttc_s=0.5", ("threat", "ttc_s = 0.5")),
    "with drag": ("threat.0.drag=true", ("threat", "drag = true")),
    "a longer dynamic response": ("character.0.response_s=0.1", ("character", "response_s = 0.1")),
    "the other account of the time": ("settings.timing.ttc_model=text", ("settings.timing", 'ttc_model = "text"')),
    "angle-free": ("settings.timing.angle_free=true", ("settings.timing", "angle_free = true")),
    "slack": ("settings.timing.slack_share=0.15", ("settings.timing", "slack_share = 0.15")),
    "look-ahead": ("settings.timing.sustained_ahead_s=0.25", ("settings.timing", "sustained_ahead_s = 0.25")),
    "another objective": ("settings.objective.form=smoothed", ("settings.objective", 'form = "smoothed"')),
    "braced farther": ("settings.balance.brace_m=0.05", ("settings.balance", "brace_m = 0.05")),
    "the thesis's rule for knees": ("settings.blend.knee_rule=least", ("settings.blend", 'knee_rule = "least"')),
    "stiffer": ("settings.response.stiffness=2.0", ("settings.response", "stiffness = 2.0")),
    "a blow in an instant": ("settings.response.contact_s=0", ("settings.response", "contact_s = 0")),
    "a slower recovery": ("settings.recovery.part_one_s=0.4", ("settings.recovery", "part_one_s = 0.4")),
}


def find(spec):
    return find_clip(spec.clip, sex=spec.sex, body_mass_kg=spec.mass_kg)


def played(text: str, *overrides: str) -> Simulation:
    simulation = Simulation(parse_scenario(text, "test", overrides), find, observe=True)
    for _ in range(simulation.ticks):
        simulation.step()
    return simulation


def with_line(section: str, line: str) -> str:
    """The usual scenario with a line more in one of its sections, in place of one with the same key."""
    key = line.split("=")[0].strip()
    if section.startswith("settings"):
        return f"{USUAL}\n[{section}]\n{line}\n"
    kept = [old for old in USUAL.splitlines() if old.split("=")[0].strip() != key]
    at = kept.index(f"[[{section}]]") + 1
    return "\n".join([*kept[:at], line, *kept[at:]])


@pytest.fixture(scope="module")
def usual():
    return played(USUAL)


@pytest.mark.parametrize("option", OPTIONS)
def test_each_option_changes_the_run_the_same_way_however_it_is_said(option, usual, library_clip):
    if "stand" in OPTIONS[option][0] or "new" in OPTIONS[option][0]:
        library_clip("stand")
    override, (section, line) = OPTIONS[option]
    digest = played(USUAL, override).world.digest()
    assert digest != usual.world.digest()
    assert digest == played(with_line(section, line)).world.digest()


def test_the_usual_run_is_a_whole_one(usual):
    assert phases(usual) == ["play", "startle", "protect", "respond", "recover_blend", "recover_return", "play"]


def test_the_response_lasts_as_long_as_is_asked_or_as_the_ball_still_presses():
    response = Settings().response
    for response_s in (0.05, 0.1):
        report = played(USUAL, f"character.0.response_s={response_s}").report()
        row = next(row for row in report["phases"] if row["name"] == "respond")
        touched_s = max(event["t_s"] for event in report["events"] if event["kind"] == "contact")
        pressed_s = touched_s + response.contact_s + response.quiet_s - row["from_s"]
        expected_s = response_s if touched_s == row["from_s"] else max(response_s, pressed_s)
        assert row["to_s"] - row["from_s"] == pytest.approx(expected_s, abs=1.5 / 120)


def test_the_text_s_account_gives_a_fast_threat_more_time(usual):
    text = played(USUAL, "settings.timing.ttc_model=text", "threat.0.speed_mps=29.7")
    equation = played(USUAL, "threat.0.speed_mps=29.7")
    assert events(text, "perceived")[0]["ttc_s"] > 2.0 * events(equation, "perceived")[0]["ttc_s"]


def test_slack_leaves_more_of_the_way_to_go_at_contact():
    """With none the sustained pose is reached as the ball arrives; the more there is the farther off it still is."""
    left = []
    for slack in (0.0, 0.1, 0.3):
        run = played(USUAL, f"settings.timing.slack_share={slack}", "character.0.startle=false")
        track, sustained = track_of(run), run.world.assets
        assert sustained.settings.timing.slack_share == slack
        at = track.phase.index(Phase.RESPOND)
        last = track.lines[[line.tick for line in track.lines].index(at - 1)]
        left.append(float(np.linalg.norm(last.between_m - last.end_m, axis=1).max()))
    assert left[0] < left[1] < left[2]
    assert left[0] < 0.01


def test_size_as_a_radius_or_a_mass_is_that_of_the_ball():
    from behaviours.components import Flight

    for means, field, low, high in (("radius", "radius_m", 0.06, 0.20), ("mass", "mass_kg", 0.1, 2.0)):
        simulation = Simulation(parse_scenario(USUAL, "test", (f"threat.0.size_means={means}",)), find)
        while not len(simulation.world.rows(Flight)):
            simulation.step()
        (ball,) = simulation.world.rows(Flight)
        assert getattr(simulation.world[Flight], field)[ball] == pytest.approx(low + 0.5 * (high - low))


@pytest.mark.parametrize("name", CHOICES)
def test_every_named_choice_runs(name):
    ends = set()
    for choice in CHOICES[name]:
        run = Simulation(parse_scenario(USUAL, "test", (f"settings.{name}={choice}", "duration_s=1.0")), find)
        for _ in range(run.ticks):
            run.step()
        assert run.world[Reaction].phase[0] != Phase.STOPPED
        ends.add(run.world.digest())
    if name != "threats.low_path":  # this ball comes from above the floor anyway
        assert len(ends) == len(CHOICES[name])


def test_a_file_and_overrides_go_together(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(USUAL, encoding="utf-8")
    scenario = load_scenario(path, ("threat.0.size=0.1", "settings.block.offset_m=0.1"))
    assert scenario.threat[0].size == 0.1
    assert scenario.settings == {"block": {"offset_m": 0.1}}
    assert scenario.threat[0].speed_mps == 26.0
