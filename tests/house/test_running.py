"""Scenarios from the command line: the same bits every time, recorded, replayed, and refused in one line."""

import json
from itertools import pairwise

import pytest

from behaviours.recover import library
from behaviours.scenario_spec import Scenario
from behaviours.settings import Settings
from demos.cli import main
from engine.clips.library import Listed
from engine.core.journal_file import load_journal, save_journal

SHORT = ("--set", "duration_s=1.5")
METRICS = {
    "ttc_s", "contact_error_s", "first_contact", "head_peak_g", "hic15", "foot_slide_max_m",
    "hand_line_deviation_max_m", "com_margin_min_m", "joint_limit_excess_max_rad", "seam_position_jump_max_m",
    "seam_velocity_jump_max_mps", "recovered_to",
}  # fmt: skip


def report(capsys, *words):
    assert main(["react", "sway", *SHORT, "--json", *words]) == 0
    return json.loads(capsys.readouterr().out)


def one_line(capsys):
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    return err


@pytest.fixture
def recording(tmp_path, capsys):
    path = tmp_path / "run.brace"
    assert main(["react", "sway", *SHORT, "--record", str(path)]) == 0
    capsys.readouterr()
    return path


def test_the_same_run_gives_the_same_bits(capsys):
    assert report(capsys) == report(capsys)


def test_another_speed_gives_another_run(capsys):
    first, second = report(capsys), report(capsys, "--set", "threat.0.speed_mps=23")
    assert first["digest"] != second["digest"]
    assert second["metrics"]["ttc_s"] > first["metrics"]["ttc_s"]  # eq. 4.1: slower threats leave more time


def test_the_report_has_what_scripts_rely_on(capsys):
    found = report(capsys)
    assert found["metrics"].keys() >= METRICS
    assert found["ticks"] == 180
    kinds = [event["kind"] for event in found["events"]]
    assert kinds.index("perceived") < kinds.index("contact")
    assert all(earlier["to_s"] == later["from_s"] for earlier, later in pairwise(found["phases"]))
    assert found["phases"][0]["from_s"] == 0.0


def test_words_say_the_same(capsys):
    found = report(capsys)
    assert main(["react", "sway", *SHORT]) == 0
    out = capsys.readouterr().out
    assert out.splitlines()[-1] == f"{found['ticks']} ticks, digest {found['digest']}"
    for phase in found["phases"]:
        assert phase["name"] in out


def test_a_recording_is_simulated_again_bit_for_bit(recording, capsys):
    assert main(["replay", str(recording), "--check"]) == 0
    assert capsys.readouterr().out.startswith("180 ticks simulated again, every one equal")


def test_a_recording_that_comes_out_otherwise_is_exit_code_4(recording, capsys):
    journal = load_journal(recording)
    journal.digests[-1] ^= 1
    save_journal(journal, recording)
    assert main(["replay", str(recording), "--check"]) == 4
    assert "tick 180" in one_line(capsys)


@pytest.mark.parametrize(
    ("spoil", "code"),
    [(lambda header: header.pop("scenario"), 2), (lambda header: header.update(clips=["another"]), 2)],
)
def test_a_recording_of_something_else_is_refused(recording, capsys, spoil, code):
    journal = load_journal(recording)
    spoil(journal.header)
    save_journal(journal, recording)
    assert main(["replay", str(recording)]) == code
    assert one_line(capsys).startswith("error[recording]")


def test_no_recording_is_one_line(tmp_path, capsys):
    (tmp_path / "notes").write_text("hello")
    assert main(["replay", str(tmp_path / "notes")]) == 2
    assert main(["replay", str(tmp_path / "nowhere")]) == 2
    assert capsys.readouterr().err.count("error[") == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('version = 1\n[[threat]]\nkind = "volleyball"\nsped_mps = 3\n', "s.toml:4: unknown key 'threat.0.sped_mps'"),
        ("version = 1\nseed = \n", "s.toml:2: "),
        ('version = 1\n[[character]]\nclip = "nowhere.bvh"\n', "nowhere.bvh"),
        ('version = 1\n[[threat]]\nspeed_mps = "fast"\n', "s.toml:3: threat.0.speed_mps"),
    ],
)
def test_a_wrong_scenario_is_one_line_with_its_place(tmp_path, capsys, text, said):
    path = tmp_path / "s.toml"
    path.write_text(text)
    assert main(["react", str(path)]) == 2
    assert said in one_line(capsys)


def test_a_clip_beside_the_scenario_is_found_from_anywhere(tmp_path, monkeypatch, capsys, library_clip):
    """Relative to the file that names it, not to where one stands."""
    import shutil

    from engine.clips.library import clip_folder

    library_clip("stand")
    (tmp_path / "mine").mkdir()
    shutil.copy(clip_folder() / "stand.bvh", tmp_path / "mine/own.bvh")
    (tmp_path / "mine/s.toml").write_text('version = 1\nduration_s = 0.1\n[[character]]\nclip = "own.bvh"\n')
    monkeypatch.chdir(tmp_path)
    assert main(["react", "mine/s.toml", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ticks"] == 12


@pytest.mark.parametrize("wrong", ["threat.0", "threat.7.size=1", "=3", "threat.0.sizes=1", "duration_s=soon"])
def test_a_wrong_override_is_one_line(capsys, wrong):
    assert main(["react", "sway", "--set", wrong]) == 2
    assert one_line(capsys).startswith("error[")


@pytest.mark.parametrize(
    ("place", "exit_code", "code"),
    [("/proc/run.brace", 3, "unwritable"), ("nowhere/run.brace", 3, "unwritable"), (".", 2, "output")],
)
def test_a_recording_that_cannot_be_written_is_refused_before_the_run(capsys, place, exit_code, code):
    assert main(["react", "sway", "--record", place]) == exit_code
    assert one_line(capsys).startswith(f"error[{code}] {place}: ")


def test_a_clip_that_is_typed_counts_from_here(tmp_path, monkeypatch, capsys):
    """A scenario's own paths start beside it; a path on the command line starts where one stands."""
    assert main(["export", "sway", "--set", "duration_s=1", "-o", str(tmp_path / "mine.bvh")]) == 0
    monkeypatch.chdir(tmp_path)
    capsys.readouterr()
    assert main(["react", "sway", *SHORT, "--set", "character.0.clip=mine.bvh", "--record", "mine.brace"]) == 0
    monkeypatch.chdir("/")
    assert main(["replay", str(tmp_path / "mine.brace"), "--check"]) == 0
    kept = load_journal(tmp_path / "mine.brace").header["scenario"]
    assert kept["character"][0]["clip"] == str(tmp_path / "mine.bvh")


def test_get_ups_that_were_fetched_since_do_not_count_in_a_replay(recording, monkeypatch, tmp_path):
    """As the run was recorded: what has been fetched since is not looked at."""
    fetched = [*library.list_clips(), Listed("rises", "as if it got up", str(tmp_path / "none.json"), gets_up=True)]
    (tmp_path / "none.json").write_text("{}")
    monkeypatch.setattr(library, "list_clips", lambda: fetched)
    assert library.get_up_names(Scenario()) == ("rises",)
    assert main(["replay", str(recording), "--check"]) == 0


def test_a_constant_is_named_with_or_without_its_section(capsys):
    plain = report(capsys, "--set", "block.offset_m=0.15")
    assert plain["digest"] == report(capsys, "--set", "settings.block.offset_m=0.15")["digest"]
    assert plain["digest"] != report(capsys)["digest"]


def test_constants_and_keys_of_a_scenario_have_different_names():
    assert not set(Settings._fields) & set(Scenario.model_fields)
