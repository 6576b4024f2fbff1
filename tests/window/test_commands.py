"""Commands as part of a scenario, and a threat that is sent from outside, against the same threat from a script."""

import pytest

from behaviours.components import Flight, Reaction, Threat
from behaviours.scenario import check_scenario
from behaviours.simulation import apply_command
from demos.running import recorder_of, start
from demos.scenarios import FOLDER
from engine.core.errors import BadInput

THREAT = {"azimuth_deg": 25.0, "elevation_deg": 8.0, "speed_mps": 25.0}


def run(raw, ticks=150):
    simulation = start(check_scenario({"character": [{"clip": "sway"}], **raw}), FOLDER)
    for _ in range(ticks):
        simulation.step()
    return simulation.world


def test_a_threat_sent_from_outside_comes_as_the_scripted_one_does():
    scripted = run({"threat": [{**THREAT, "perceived_s": 0.25}]})
    sent = run({"command": [{"at_s": 0.25, "threat": THREAT}]})
    assert (
        [(e.tick, e.kind) for e in scripted.events if e.kind != "launched"]
        == [(e.tick, e.kind) for e in sent.events if e.kind != "launched"]
    )  # fmt: skip
    assert sent[Reaction].contact[0] == scripted[Reaction].contact[0]
    (mine,), (its,) = sent.rows(Flight, Threat), scripted.rows(Flight, Threat)
    assert sent[Flight].position_m[mine] == pytest.approx(scripted[Flight].position_m[its], abs=1e-9)


def test_a_scenario_with_commands_is_the_recording_with_the_same_ones():
    throw = {"position_m": (4.0, 0.5, 1.6), "velocity_mps": (-18.0, -2.0, 2.0)}
    whole = run({"command": [{"at_s": 0.5, "throw": throw}, {"at_s": 0.9, "threat": THREAT}]}, 240)
    recorder = recorder_of(start(check_scenario({"character": [{"clip": "sway"}]}), FOLDER), FOLDER)
    for tick in range(240):
        if tick == 60:
            recorder.command({"do": "throw", "at": 0, "kind": "volleyball", "size": 0.5, **throw})
        if tick == 108:
            recorder.command({"do": "threaten", "threat": THREAT})
        recorder.advance()
    assert recorder.world.digest() == whole.digest()


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ({"at_s": 1.0}, "either a throw"),
        ({"at_s": 1.0, "threat": {"at_character": 3}}, "there are 1 characters"),
        ({"at_s": 1.0, "threat": {"free": True, "position_m": (1, 1, 1), "speed_mps": 20}}, "free threat"),
        ({"at_s": 1.0, "thrown": {}}, "unknown key"),
    ],
)
def test_impossible_commands_are_refused(command, said):
    with pytest.raises(BadInput, match=said):
        check_scenario({"command": [command]})


def test_a_threat_from_a_foreign_recording_is_checked():
    world = run({}, 1)
    with pytest.raises(BadInput, match=r"threat\.speed_mps"):
        apply_command(world, {"do": "threaten", "threat": {"speed_mps": -3}})
