"""What is kept of each tick, against what can be said without it."""

import itertools

import numpy as np
import pytest

from behaviours.components import Phase, Reaction
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation
from demos.window.history import GRAVITY_MPS2
from demos.window.marks import limb_forces_N, predicted_path
from demos.window.run import ClipBox, Run


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    threat = {"azimuth_deg": 15.0, "speed_mps": 26.0, "perceived_s": 0.25}
    run = Run(check_scenario({"character": [{"clip": "sway"}], "threat": [threat]}), ClipBox(folder), folder, {})
    run.phases = [Phase.PLAY]
    for _ in range(240):
        run.advance()
        run.phases.append(Phase(int(run.world[Reaction].phase[0])))
    return run


def test_spans_say_the_phase_of_every_tick(run):
    spans = run.history.pasts[0].spans
    assert spans[0].first == 0
    assert spans[-1].last == 240
    assert all(before.last + 1 == after.first for before, after in itertools.pairwise(spans))
    assert [span.phase for span in spans for _ in range(span.first, span.last + 1)] == run.phases


def test_marks_tell_the_threat_and_its_contact(run):
    kinds = [mark.kind for mark in run.history.marks]
    assert kinds[:2] == ["perceived", "contact"]
    seen, struck = run.history.marks[:2]
    assert seen.tick == 31
    assert struck.tick - seen.tick == pytest.approx(120.0 * seen.data["ttc_s"], abs=3)


def test_the_forces_on_all_parts_are_the_whole_weight_while_standing(run):
    body = run.world.assets.bodies[0]
    forces = run.history.forces_N(0, 20, body.part_mass_kg)
    weight_N = body.part_mass_kg.sum() * GRAVITY_MPS2
    assert forces.sum(axis=0) == pytest.approx((0.0, 0.0, weight_N), abs=0.03 * weight_N)
    limbs = limb_forces_N(body, forces)
    assert limbs["head"][2] > 30.0
    assert limbs["left arm"] == pytest.approx(limbs["right arm"] * (1, -1, 1), abs=5.0)
    assert run.history.forces_N(0, 1, body.part_mass_kg) is None


def test_a_blow_shows_in_the_head_as_the_report_has_it(tmp_path):
    raw = {"character": [{"clip": "sway", "protects": False}], "threat": [{"speed_mps": 26.0, "perceived_s": 0.25}]}
    run = Run(check_scenario(raw), ClipBox(tmp_path), tmp_path, {})
    judge = Simulation(check_scenario(raw), ClipBox(tmp_path), observe=True)
    for _ in range(160):
        run.advance()
        judge.step()
    head_g = np.array(run.history.pasts[0].head_g)
    assert head_g[3:25].max() < 1.0
    assert head_g.max() > 10.0
    assert head_g.max() == pytest.approx(judge.report()["metrics"]["head_peak_g"], rel=1e-6)


def test_another_future_is_forgotten_from_now_on(run, tmp_path):
    other = Run(run.scenario, ClipBox(tmp_path), tmp_path, {})
    for _ in range(120):
        other.advance()
    other.seek(50)
    other.command({"do": "threaten", "threat": {"azimuth_deg": -90.0}})
    assert other.history.last_tick == 50
    assert all(mark.tick <= 50 for mark in other.history.marks)
    assert other.history.pasts[0].spans[-1].last == 50
    for _ in range(70):
        other.advance()
    assert other.history.last_tick == 120
    again = [mark.kind for mark in other.history.marks]
    assert again.count("perceived") >= 1


def test_a_predicted_path_is_flown(run, tmp_path):
    from behaviours.components import Flight

    other = Run(run.scenario, ClipBox(tmp_path), tmp_path, {})
    for _ in range(35):
        other.advance()
    (row,) = other.world.rows(Flight)
    path = predicted_path(other.world[Flight], int(row), 0.1)
    for _ in range(12):
        other.advance()
    assert other.world[Flight].position_m[row] == pytest.approx(path[-1], abs=1e-6)
