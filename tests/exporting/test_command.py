"""`brace export` as a user meets it: four kinds of file that other things can read, whole or not at all."""

import errno

import numpy as np
import pytest

from demos.cli import main
from demos.running import open_scenario, start
from engine.body.kinematics import joints_of
from engine.body.skeleton import Pose
from engine.clips.bvh import read_bvh
from engine.clips.tracks import world_of
from engine.core import files

SHORT = ("--set", "duration_s=0.5")


def one_line(capsys):
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    return err


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("exported")
    for ending in ("bvh", "npz", "glb", "html"):
        assert main(["export", "sway", *SHORT, "-o", str(folder / f"run.{ending}")]) == 0
    return folder


@pytest.fixture(scope="module")
def run_m():
    """World joints (F, 21, 3) of the run, tick for tick."""
    from behaviours.components import Posture

    simulation = start(*open_scenario("sway", SHORT[1:]))
    posture, joints = simulation.world[Posture], []
    for _ in range(simulation.ticks + 1):
        if joints:
            simulation.step()
            posture = simulation.world[Posture]
        pose = Pose(posture.root_m[0].copy(), posture.rotations[0].copy())
        joints.append(joints_of(simulation.world.assets.bodies[0], pose)[0])
    return np.array(joints)


def test_every_tick_is_in_the_bvh(exported, run_m):
    tracks = read_bvh(exported / "run.bvh")
    ahead, left, up = np.moveaxis(run_m, -1, 0)
    assert tracks.fps == pytest.approx(120.0)
    assert np.abs(0.01 * world_of(tracks)[0] - np.stack([left, up, ahead], axis=-1)).max() < 1e-5


def test_every_tick_is_in_the_archive(exported, run_m):
    with np.load(exported / "run.npz") as archive:
        assert np.abs(archive["joints_m"] - run_m).max() < 1e-9
        assert archive["ball_m"].shape == (len(archive["ball_mass_kg"]), 61, 3)
        assert archive["phase_names"][archive["phase"][0]] == "play"
        assert archive["time_s"][-1] == 0.5


def test_an_exported_run_can_be_played(exported, tmp_path, capsys):
    scenario = tmp_path / "again.toml"
    for ending in ("npz", "bvh"):
        scenario.write_text(f'version = 1\nduration_s = 0.1\n[[character]]\nclip = "{exported}/run.{ending}"\n')
        assert main(["react", str(scenario)]) == 0
    assert capsys.readouterr().err == ""


def test_the_same_run_gives_the_same_bytes(exported, tmp_path):
    for ending in ("bvh", "npz", "glb", "html"):
        assert main(["export", "sway", *SHORT, "-o", str(tmp_path / f"run.{ending}")]) == 0
        assert (tmp_path / f"run.{ending}").read_bytes() == (exported / f"run.{ending}").read_bytes()


def test_another_rate_gives_as_many_frames(tmp_path):
    assert main(["export", "sway", *SHORT, "--fps", "24", "-o", str(tmp_path / "a.bvh")]) == 0
    assert read_bvh(tmp_path / "a.bvh").rotations.shape[0] == 13


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("-o", "a.fbx"), 2, "unknown ending .fbx, expected .bvh, .npz, .glb, .html"),
        (("-o", "a"), 2, "no ending"),
        (("-o", "nowhere/a.bvh"), 3, "no folder nowhere"),
        (("-o", "/proc/a.glb"), 3, "/proc/a.glb"),
        (("-o", "a.bvh", "--character", "1"), 2, "--character 1: expected 0 to 0"),
        (("-o", "a.bvh", "--fps", "nan"), 2, "--fps nan: expected 1 to 120"),
        (("-o", "a.bvh", "--fps", "240"), 2, "--fps 240: expected 1 to 120"),
    ],
)
def test_what_cannot_be_is_one_line(tmp_path, monkeypatch, capsys, words, code, said):
    monkeypatch.chdir(tmp_path)
    assert main(["export", "sway", *SHORT, *words]) == code
    assert said in one_line(capsys)
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_what_was_there(tmp_path, monkeypatch, capsys):
    target = tmp_path / "a.bvh"
    target.write_text("precious")

    def full(_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    assert main(["export", "sway", *SHORT, "-o", str(target)]) == 3
    assert "the disk is full" in one_line(capsys)
    assert target.read_text() == "precious"
    assert [path.name for path in tmp_path.iterdir()] == ["a.bvh"]
