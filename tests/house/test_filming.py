"""Pictures from the command line, without any display."""

import numpy as np
import pytest
from PIL import Image

from behaviours.scenario import parse_scenario
from demos.cli import main
from demos.commands.capture import columns_for
from demos.filming import CAMERAS, Moment, Shot, choose, parse_camera, parse_ghosts, parse_size, placed_for
from demos.frames import frames_of, slowed_frames_of
from demos.stage import floor_under, scene_of
from engine.body.anthropometry import standard_body
from engine.core.clock import TICK_RATE_HZ
from engine.core.errors import BadInput
from engine.render.scene import Figure, Scene
from tests.behaviours.runs import AHEAD, run

SMALL = ("--set", "duration_s=0.5", "--size", "64x48", "--fps", "12")


def one_line(capsys):
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    return err


def test_a_film_has_every_frame(brace, tmp_path):
    from engine.render.capture import count_frames

    assert brace("capture", "sway", *SMALL, "-o", "a.mp4").returncode == 0
    assert count_frames(tmp_path / "a.mp4") == 7  # 0.5 s at 12 frames a second, both ends


def test_a_folder_has_every_frame_and_the_ghosts(brace, tmp_path):
    brace("capture", "sway", "--size", "64x48", "--fps", "2", "-o", "with", "--ghosts")
    done = brace("capture", "sway", "--size", "64x48", "--fps", "2", "-o", "without")
    assert (done.returncode, done.stderr) == (0, "")
    pictures = [sorted((tmp_path / name).glob("*.png")) for name in ("with", "without")]
    assert [len(found) for found in pictures] == [8, 8]
    same = [one.read_bytes() == other.read_bytes() for one, other in zip(*pictures, strict=True)]
    assert same == [True, True, False, True, True, True, True, True]  # only at 1.0 s somebody protects themselves


def test_a_strip_shows_the_blow(brace, tmp_path):
    words = ("--size", "90x120", "--frames", "5", "--columns", "3")
    assert brace("capture", "sway", *words, "-o", "strip.png").returncode == 0
    with Image.open(tmp_path / "strip.png") as strip:
        picture = np.asarray(strip)
    assert picture.shape[1] > 3 * 90
    assert picture.shape[0] > 2 * 120
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 500


def test_a_recording_is_filmed(brace, tmp_path):
    assert brace("react", "sway", "--set", "duration_s=0.5", "--record", "run.brace").returncode == 0
    assert brace("replay", "run.brace", "--size", "64x48", "--fps", "12", "-o", "replay").returncode == 0
    assert brace("capture", "sway", *SMALL, "-o", "capture").returncode == 0
    names = sorted(path.name for path in (tmp_path / "replay").glob("*.png"))
    assert len(names) == 7
    for name in names:
        assert (tmp_path / "replay" / name).read_bytes() == (tmp_path / "capture" / name).read_bytes()


def test_the_demo_without_a_display_says_where_its_pictures_are(brace, tmp_path):
    done = brace("demo", "sway", *SMALL, "-o", "new/folder")
    assert done.returncode == 0
    assert "new/folder/sway.png" in done.stdout
    assert {path.name for path in (tmp_path / "new/folder").iterdir()} == {"sway.png", "sway.mp4"}


def test_the_demo_goes_on_without_real_clips(brace, tmp_path):
    done = brace("demo", *SMALL, BRACE_CACHE=str(tmp_path / "cache"))
    assert done.returncode == 0
    assert "showing 'sway' instead" in done.stdout
    assert (tmp_path / "out/sway.mp4").exists()


def test_no_gl_is_one_line_and_leaves_nothing(brace, tmp_path):
    done = brace("capture", "sway", *SMALL, "-o", "a.gif", __EGL_VENDOR_LIBRARY_DIRS=str(tmp_path))
    assert done.returncode == 3
    assert done.stderr.startswith("error[no-gl]")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["-o", "a.avi"], 2),
        (["-o", "nowhere/a.mp4"], 3),
        (["-o", "/proc/a.mp4"], 3),
        (["-o", "a.mp4", "--size", "64"], 2),
        (["-o", "a.mp4", "--size", "1x1"], 2),
        (["-o", "a.mp4", "--fps", "0"], 2),
        (["-o", "a.mp4", "--camera", "under"], 2),
        (["-o", "a.mp4", "--ghosts", "clip,holy"], 2),
        (["-o", "a.png", "--from", "9"], 2),
    ],
)
def test_what_cannot_be_done_is_one_line(tmp_path, monkeypatch, capsys, words, code):
    monkeypatch.chdir(tmp_path)
    assert main(["capture", "sway", "--set", "duration_s=0.1", *words]) == code
    assert one_line(capsys).startswith("error[")
    assert list(tmp_path.iterdir()) == []


def test_numbers_are_read():
    assert parse_size("1280X720") == (1280, 720)
    assert parse_camera("left") == CAMERAS["left"]
    assert parse_camera("-30,10") == (-30.0, 10.0, CAMERAS["quarter"][2])
    assert parse_camera("-30,10,2.5") == (-30.0, 10.0, 2.5)
    assert parse_ghosts("all") == ("clip", "rules", "sustained")
    assert parse_ghosts("") == ()
    for wrong in ("1,2,3,4", "0,95", "0,0,-1", "nan,0"):
        with pytest.raises(BadInput):
            parse_camera(wrong)


def test_the_quarter_view_keeps_out_of_the_way_of_the_ball():
    for azimuth, side in ((30, -1), (-30, 1)):
        scenario = parse_scenario(f"[[character]]\nheading_deg = 20\n[[threat]]\nazimuth_deg = {azimuth}\n")
        assert placed_for(Shot(), scenario).camera[0] == 20 + side * CAMERAS["quarter"][0]
    assert placed_for(Shot(camera=CAMERAS["left"]), scenario).camera[0] == 20 + 90


def test_the_moments_of_a_strip():
    phases = ["play"] * 10 + ["protect"] * 20 + ["respond"] * 3 + ["recover_return"] * 20 + ["play"] * 30
    seen = [Moment(i / 16, Scene(), np.zeros(3), phase) for i, phase in enumerate(phases)]
    chosen = choose(seen, 5, None, None)
    times = [now.time_s for now in chosen]
    assert times == sorted(times)
    assert times[0] == 9 / 16  # just before the reaction
    assert times[-1] == 53 / 16  # just after it
    assert 30 / 16 in times  # the first moment of the blow
    assert [now.time_s for now in choose(seen, 3, 0.0, 0.25)] == [0.0, 0.125, 0.25]
    assert len(choose(seen, 500, None, None)) == 45
    blow_s = next(now.time_s for now in seen if now.phase == "respond")
    times = [now.time_s for now in choose(seen, 5, blow_s, None)]
    assert times[0] == blow_s
    assert times == sorted(set(times))  # the blow is among them once


@pytest.mark.parametrize(("frames", "columns"), [(1, 1), (8, 8), (9, 5), (16, 8), (17, 6)])
def test_rows_of_a_strip_are_short_and_alike(frames, columns):
    assert columns_for(frames) == columns


def test_who_walks_out_of_the_hall_walks_on_plain_ground():
    body = standard_body()
    inside, outside = (np.full((21, 3), x) for x in (2.0, 20.0))
    turned = np.tile([1.0, 0.0, 0.0, 0.0], (21, 1))
    assert floor_under(Scene(figures=[Figure(body, inside, turned)]), "gym").style == "gym"
    assert floor_under(Scene(figures=[Figure(body, outside, turned)]), "gym").style == "plain"
    assert floor_under(Scene(), "plain").style == "plain"


class Clockwork:
    """What steps and counts its ticks."""

    tick = 0

    def advance(self):
        self.tick += 1


def times_s(frames, clockwork):
    """When each frame is, as its place between two ticks says."""
    return [(clockwork.tick - 1.0 + alpha) / TICK_RATE_HZ for alpha in frames]


def test_slowed_frames_at_full_pace_are_the_steady_ones():
    steady, slowed = Clockwork(), Clockwork()
    expected = times_s(frames_of(steady, steady.advance, 60, 25.0), steady)
    found = times_s(slowed_frames_of(slowed, slowed.advance, 60, 25.0, lambda passed_s: 1.0), slowed)
    assert found == pytest.approx(expected, abs=1e-12)


def test_slowed_frames_lie_as_close_as_the_pace_says():
    clockwork = Clockwork()
    frames = slowed_frames_of(clockwork, clockwork.advance, 60, 30.0, lambda _: 0.1 if clockwork.tick >= 30 else 1.0)
    steps_s = np.diff(times_s(frames, clockwork))
    assert steps_s[:7] == pytest.approx(1 / 30)
    assert steps_s[8:] == pytest.approx(0.1 / 30)
    assert clockwork.tick == 60


def test_a_film_slows_about_the_blow_and_nowhere_else(brace, tmp_path):
    words = ("--size", "32x24", "--fps", "12", "--floor", "plain", "--from", "0.3", "--to", "2.0")
    done = brace("capture", "sway", *words, "--slow", "-o", "film", "--tracks", "tracks.npz")
    assert (done.returncode, done.stderr) == (0, "")
    time_s = np.load(tmp_path / "tracks.npz")["time_s"]
    assert len(list((tmp_path / "film").glob("*.png"))) == len(time_s)
    assert 0.3 <= time_s[0] <= 0.3 + 1 / 12
    assert 2.0 - 1 / 12 <= time_s[-1] <= 2.0
    steps_s = np.diff(time_s)
    slow = time_s[1:][steps_s < 0.5 / 12]
    assert len(slow) > 8
    assert slow[-1] - slow[0] < 0.4  # a blow, with what leads to it
    assert np.median(np.delete(steps_s, np.flatnonzero(steps_s < 0.5 / 12))) == pytest.approx(1 / 12)


def test_a_span_with_nothing_in_it_is_one_line(capsys, tmp_path):
    words = ["capture", "sway", *SMALL, "--from", "3", "-o", str(tmp_path / "a.gif")]
    assert main(words) == 2
    assert one_line(capsys).startswith("error[usage]: nothing lies from 3 to 0.5 s")
    assert not list(tmp_path.iterdir())


def test_a_strip_is_not_slowed(capsys):
    assert main(["capture", "sway", "--slow", "-o", "strip.png"]) == 2
    assert one_line(capsys).startswith("error[usage]: --slow")


@pytest.mark.parametrize("kind", ["volleyball", "custom"])
def test_a_ball_is_drawn_as_what_it_is(kind):
    simulation = run(threats=[{**AHEAD, "kind": kind, "perceived_s": 0.1}], duration_s=0.3)
    assert [ball.kind for ball in scene_of(simulation.world).balls] == [kind]
