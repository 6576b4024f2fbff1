"""A run is recorded, saved, loaded and replayed to the same bits; a file that is none is one line of complaint."""

from __future__ import annotations

import copy
import json
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.core.errors import BadInput, EnvironmentTrouble, ReplayDiverged
from engine.core.journal import Journal, plain_json
from engine.core.journal_file import FORMAT, MAGIC, load_journal, save_journal
from engine.core.recorder import Recorder, new_journal, replay
from engine.core.world import World
from tests.core.toy_world import COMPONENTS, Flight, throw, toy

THROW = {"height_m": 1.0, "speed_mps": [1.0, 0.0, 0.5]}


def _recorded(ticks=150, throws=(0, 40, 40)):
    """A recorder that has run so long, with throws at these ticks."""
    world, step = toy()
    recorder = Recorder(world, step, throw, new_journal({"scenario": "toy", "balls": 3}, world))
    for tick in range(ticks):
        for _ in range(throws.count(tick)):
            recorder.command(THROW)
        recorder.advance()
    return recorder


@pytest.fixture
def recorder():
    return _recorded()


def _rerun(journal):
    """A replay from a freshly built world, to the end."""
    return _play_to_the_end(*toy(), journal)


def _play_to_the_end(world, step, journal):
    replayed = replay(world, step, throw, journal)
    while not replayed.at_end:
        replayed.advance()
    return replayed


def test_a_recording_saved_and_loaded_replays_to_the_same_bits(recorder, tmp_path):
    save_journal(recorder.journal, tmp_path / "run.brace")
    loaded = load_journal(tmp_path / "run.brace")
    assert loaded == recorder.journal
    assert loaded.header["scenario"] == "toy"
    assert loaded.header["made_with"]["numpy"] == np.__version__
    assert loaded.last_tick == 150
    replayed = _rerun(loaded)
    assert replayed.world.snapshot() == recorder.world.snapshot()


def test_two_runs_are_the_same_file(tmp_path):
    for name in ("one", "two"):
        save_journal(_recorded().journal, tmp_path / name)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


def test_commands_take_part(recorder):
    assert len(recorder.journal.commands_at(40)) == 2
    assert recorder.journal.digest_at(40) == _recorded(throws=(0,)).journal.digest_at(40)  # before the commands
    assert recorder.journal.digest_at(41) != _recorded(throws=(0,)).journal.digest_at(41)


def test_a_recording_begun_in_mid_run_brings_its_start(tmp_path):
    world, step = toy()
    for _ in range(33):
        step(world)
    recorder = Recorder(world, step, throw, new_journal({}, world))
    recorder.command(THROW)
    for _ in range(50):
        recorder.advance()
    save_journal(recorder.journal, tmp_path / "run")
    replayed = _rerun(load_journal(tmp_path / "run"))
    assert replayed.world.digest() == world.digest()
    assert replayed.journal.first_tick == 33


def test_a_start_from_another_kind_of_world_is_bad_input():
    stranger = World(COMPONENTS[:1], seed=7)
    stranger.tick = 1
    world, step = toy()
    with pytest.raises(BadInput, match="the recording does not fit: the snapshot was taken from a world of other comp"):
        replay(world, step, throw, new_journal({}, stranger))


@pytest.mark.parametrize("tick", [0, 1, 77, 150])
def test_a_run_that_differs_by_one_bit_is_caught_at_its_tick(recorder, tick):
    world, step = toy()

    def step_with_a_flaw(world):
        step(world)
        if world.tick == tick:
            world[Flight].position_m[world.rows(Flight)[0], 0] += 2.0**-40

    if tick == 0:
        world[Flight].position_m[0, 0] += 2.0**-40
    with pytest.raises(ReplayDiverged, match=f"tick {tick} gave") as caught:
        _play_to_the_end(world, step_with_a_flaw, recorder.journal)
    assert caught.value.exit_code == 4


def test_a_divergence_says_what_else_the_machine_runs_now(recorder):
    recorder.journal.header["made_with"]["numpy"] = "0.0.1"
    with pytest.raises(ReplayDiverged, match=r"recorded with numpy 0\.0\.1, now \d"):
        recorder.journal.witness(3, "0" * 32)


def test_a_command_is_kept_as_it_will_be_loaded():
    world, step = toy()
    given = []
    recorder = Recorder(world, step, lambda world, command: given.append(command), new_journal({}, world))
    command = {"at_m": (1, 2.5), "kind": "throw"}
    recorder.command(command)
    command["kind"] = "changed later"
    recorder.advance()
    assert given == [{"at_m": [1, 2.5], "kind": "throw"}]


@pytest.mark.parametrize("wrong", [{"speed_mps": float("nan")}, {"who": object()}, {"x": np.float32(1)}])
def test_a_command_that_json_cannot_keep_is_refused(recorder, wrong):
    before = copy.deepcopy(recorder.journal)
    with pytest.raises((TypeError, ValueError)):
        recorder.command(wrong)
    assert recorder.journal == before


def test_digests_outside_the_recording_are_refused(recorder):
    for tick in (-1, 151):
        with pytest.raises(IndexError, match="outside the recording, 0 to 150"):
            recorder.journal.digest_at(tick)


# --- files -----------------------------------------------------------------------------------------------------------


def _complaint(path):
    with pytest.raises(BadInput) as caught:
        load_journal(path)
    line = caught.value.line()
    assert line.startswith(f"error[recording] {path}: ")
    assert "\n" not in line
    assert caught.value.exit_code == 2
    return line


@pytest.fixture(scope="module")
def good_bytes(tmp_path_factory):
    path = tmp_path_factory.mktemp("journal") / "run"
    save_journal(_recorded(ticks=20).journal, path)
    return path.read_bytes()


def test_a_file_cut_short_anywhere_is_one_line(good_bytes, tmp_path):
    path = tmp_path / "cut"
    for size in range(len(good_bytes)):
        path.write_bytes(good_bytes[:size])
        _complaint(path)


@given(at=st.integers(0, 10_000), flip=st.integers(1, 255))
def test_a_byte_that_changed_anywhere_is_noticed(good_bytes, tmp_path_factory, at, flip):
    """zlib's own check covers the stream; the compression level noted in its header is no content."""
    at %= len(good_bytes)
    path = tmp_path_factory.getbasetemp() / "flipped"
    path.write_bytes(good_bytes[:at] + bytes([good_bytes[at] ^ flip]) + good_bytes[at + 1 :])
    _complaint(path)


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (b"", "no recording"),
        (b"PK\x03\x04 some other program's file", "no recording"),
        (MAGIC + (FORMAT + 1).to_bytes(2, "little") + b"anything", "a recording of format 2, expected format 1"),
        (MAGIC + FORMAT.to_bytes(2, "little") + zlib.compress(b"what?"), "a damaged recording"),
    ],
)
def test_a_foreign_file_is_one_line(content, complaint, tmp_path):
    path = tmp_path / "foreign"
    path.write_bytes(content)
    assert complaint in _complaint(path)


def test_more_after_the_end_is_noticed(good_bytes, tmp_path):
    path = tmp_path / "long"
    path.write_bytes(good_bytes + b"x")
    assert "1 bytes too many" in _complaint(path)


def test_a_file_that_is_not_there_or_no_file(tmp_path):
    assert "No such file" in _complaint(tmp_path / "nowhere")
    assert "Is a directory" in _complaint(tmp_path)


@pytest.mark.parametrize(
    "change",
    [
        {"header": ["no", "table"]},
        {"digests": bytearray()},
        {"digests": bytearray(15)},
        {"inputs": {3: ["no table"]}},
        {"inputs": {3: 7}},
        {"first_tick": 4},
    ],
)
def test_content_of_the_wrong_kind_is_one_line(change, tmp_path):
    journal = Journal(**{"header": {}, "digests": bytearray(16), **change})
    save_journal(journal, tmp_path / "odd")
    assert "a damaged recording" in _complaint(tmp_path / "odd")


def test_an_unwritable_place_is_an_environment_trouble(recorder, tmp_path):
    with pytest.raises(EnvironmentTrouble, match="there is no folder"):
        save_journal(recorder.journal, tmp_path / "nowhere" / "run")


def test_plain_json_is_what_json_keeps():
    assert plain_json({"a": (1, 2)}) == json.loads('{"a": [1, 2]}')
