"""Every panel, used by a hand without a window."""

import pytest

from behaviours.overriding import constants
from behaviours.perceive.threats import KINDS
from behaviours.scenario import check_scenario
from behaviours.scenario_spec import BODY_TARGETS, Scenario, StanceSpec
from behaviours.settings import Settings
from behaviours.simulation import flat_settings
from demos.window.character_panel import OWN_SHAPE
from demos.window.clips_panel import ClipsPanel, Row, matches
from demos.window.constants import knobs
from demos.window.help import ACTIONS, GROUPS
from demos.window.panels import make_panels
from demos.window.rules_panel import GROUPS as RULES
from demos.window.session import Session
from demos.window.threat_panel import ThreatPanel
from demos.window.timing_panel import GROUPS as TIMING
from tests.window.hand import HandUi

PANELS = {panel.title: panel for panel in make_panels()}


@pytest.fixture
def session(tmp_path) -> Session:
    return Session(check_scenario({"character": [{"clip": "sway"}]}), tmp_path, tmp_path, lambda: 0.0)


def use(session, title, **wanted):
    ui = HandUi(**wanted)
    PANELS[title].draw(HandUi(), session)  # some say first that they get ready
    PANELS[title].draw(ui, session)
    return ui


@pytest.mark.parametrize("title", PANELS)
def test_looking_at_a_panel_changes_nothing(session, title):
    before = (session.scenario, vars(session.threat).copy(), session.world.digest())
    ui = use(session, title)
    assert session.run.scenario is session.scenario  # nothing is run again
    session.advance(0.0)
    assert ui.seen
    assert (session.scenario, vars(session.threat), session.world.digest()) == before
    assert not session.toasts.lines


def test_titles_are_all_different():
    assert len(PANELS) == len(make_panels())


def test_a_threat_is_described_and_sent(session):
    use(session, "Threat", Azimuth=-60.0, Speed=29.0, Target="torso", Kind="custom", Size=0.8)
    use(session, "Threat", Mass=2.0, Send_it_now___T=True)
    ((command,),) = session.run.inputs.values()
    assert command["threat"] == {
        "azimuth_deg": -60.0, "elevation_deg": 10.0, "speed_mps": 29.0, "target": "torso", "kind": "custom",
        "size": 0.8, "mass_kg": 2.0, "radius_m": KINDS["custom"].radius_m,
    }  # fmt: skip


@pytest.mark.parametrize("target", BODY_TARGETS)
@pytest.mark.parametrize("kind", KINDS)
def test_whatever_the_threat_panel_can_say_can_be_sent(session, kind, target):
    use(session, "Threat", Kind=kind, Target=target, Size_means="both", Air_drag=True, Elevation=-30.0, Azimuth=180.0)
    session.send()
    for _ in range(3):
        session.run.advance()


def test_a_change_while_paused_changes_the_last_threat(session):
    session.send()
    session.advance(0.1)
    session.pause()
    use(session, "Threat", Azimuth=75.0)
    session.advance(0.0)
    ((command,),) = session.run.inputs.values()
    assert command["threat"]["azimuth_deg"] == 75.0


def test_the_character_is_changed(session):
    use(session, "Character", Boldness=0.7, Response=0.1, Goes_on_with="auto", Intensity=0.5, Startles=False)
    session.advance(0.0)
    spec = session.run.scenario.character[0]
    assert (spec.boldness, spec.response_s, spec.recover, spec.startle) == (0.7, 0.1, "auto", False)
    assert spec.stance.intensity == 0.5


def test_a_shape_of_its_own_is_worn_on_until_a_set_is_chosen(session):
    session.change_character(stance={"intensity": 0.5, "shape": {"knee_left_rad": 0.4}})
    session.advance(0.0)
    before = session.scenario
    ui = use(session, "Character")
    assert session.scenario is before
    assert ui.seen["Shape set"] == OWN_SHAPE
    use(session, "Character", Intensity=0.75)
    assert session.character.stance == StanceSpec(intensity=0.75, shape={"knee_left_rad": 0.4})
    use(session, "Character", Shape_set="interest")
    assert session.character.stance == StanceSpec(set="interest", intensity=0.75)


def test_every_constant_is_in_one_panel_and_can_be_turned(session):
    shown = [group for group, _ in (*RULES, *TIMING)]
    assert sorted(shown) == sorted(Settings._fields)
    assert {knob.name for group in knobs().values() for knob in group} == set(constants())


@pytest.mark.parametrize("knob", [knob for group in knobs().values() for knob in group], ids=lambda knob: knob.name)
def test_a_knob_holds_its_default_and_what_it_is_set_to_is_a_scenario(knob):
    if knob.kind in ("number", "angle", "whole"):
        assert knob.low <= knob.default <= knob.high
        assert knob.low < knob.high
    if knob.kind == "triple":
        assert all(knob.low <= angle <= knob.high for angle in knob.default)
    assert knob.help.endswith(")")
    group, field = knob.setting.split(".")
    default = list(knob.default) if isinstance(knob.default, tuple) else knob.default
    scenario = Scenario(settings={group: {field: default}})
    assert list(flat_settings(scenario.settings)) == [knob.setting]


def test_a_rule_is_turned_and_put_back(session):
    use(session, "Rules", reach_near=0.35)
    assert session.changed_settings() == {"block.reach_near_m": 0.35, "pelvis.reach_near_m": 0.35}
    ui = use(session, "Rules")
    assert ui.seen["reach near"] == 0.35
    assert "Block (3.2.5)  (1 changed)###block" in ui.said
    use(session, "Rules", As_in_the_thesis=True)
    assert session.changed_settings() == {}


def test_angles_are_shown_in_degrees_however_the_scenario_says_them(tmp_path):
    raw = {
        "character": [{"clip": "sway"}],
        "settings": {"block": {"swivel_small_rad": 0.5, "swivel_large_deg": 12}},
    }
    session = Session(check_scenario(raw), tmp_path, tmp_path, lambda: 0.0)
    ui = use(session, "Rules")
    assert ui.seen["swivel small"] == pytest.approx(28.6479, abs=1e-4)
    assert ui.seen["swivel large"] == 12


def test_time_is_slowed_by_a_slider(session):
    use(session, "Timing", Speed=0.3, Slow_motion_at_the_blow=False)
    assert session.clock.rate == 0.3
    assert not session.slow_motion.enabled


def test_switches_are_switched(session):
    use(session, "View", Limb_forces=True, Clip=True, Plots=False)
    assert (session.view.forces, session.view.ghosts, session.view.plots) == (True, ("clip",), False)


def test_a_clip_is_searched_for_and_played(session, tmp_path):
    (tmp_path / "My Fall.BVH").write_text("no motion", encoding="utf-8")
    panel = ClipsPanel()
    panel.draw(HandUi(clip_search="shifting weight"), session)
    ui = HandUi()
    panel.draw(ui, session)
    assert "sway" in ui.seen
    assert "walk" not in ui.seen
    panel.draw(HandUi(clip_search="fall"), session)
    panel.draw(HandUi(My_Fall_BVH=True, **{"My Fall.BVH": True}), session)
    (line,) = session.toasts.lines
    assert line.alarm
    assert "My Fall.BVH" in line.text
    assert session.character.clip == "sway"
    panel.draw(HandUi(clip_search="nothing like it"), session)
    ui = HandUi()
    panel.draw(ui, session)
    assert any("Nothing is called" in words for words in ui.said)


def test_every_word_of_a_search_counts():
    row = Row("walk", "walk", "straight walk, 1.5 m/s")
    assert matches(row, "")
    assert matches(row, "STRAIGHT walk")
    assert not matches(row, "straight run")


@pytest.mark.parametrize("what", ["screenshot", "film", "scenario", "recording"])
def test_what_is_to_be_kept_is_asked_for(session, what):
    label = {"screenshot": "Screenshot   P", "film": "Film   R", "scenario": "Scenario   Ctrl-S"}.get(what)
    ui = HandUi()
    ui.wanted[label or "Recording   Ctrl-R"] = True
    PANELS["Save"].draw(ui, session)
    assert session.asked == [what]


def test_the_threat_panel_says_when_it_will_be_noticed(session):
    session.threat.speed_mps = 29.7  # as fast as the rules know: eq. 4.1 from straight ahead gives 0.25 s
    session.threat.azimuth_deg = 0.0
    session.threat.elevation_deg = 0.0
    ui = HandUi()
    ThreatPanel().draw(ui, session)
    assert any("Noticed 0.25 s" in words for words in ui.said)


def test_no_key_means_two_things():
    keys = [key for rows in GROUPS.values() for row in rows for key in row.keys]
    assert len(keys) == len(set(keys)) == len(ACTIONS)
    assert {"f", "x"}.isdisjoint(keys)  # throwing and centring are not in the table of actions
