"""Clips that are missing are fetched from the window, which goes on meanwhile; whoever lies there then gets up."""

from __future__ import annotations

import sys
import time

import numpy as np
import pytest

from behaviours.components import Phase
from behaviours.scenario import check_scenario
from demos.window import fetching
from demos.window.clips_panel import ClipsPanel
from demos.window.fetching import Fetching
from demos.window.keeping import Keeper
from demos.window.session import Session
from demos.window.status import draw_offer, stays_down
from engine.clips import library
from tests.behaviours.knocked import HEAVY, get_up_file
from tests.window.hand import HandUi

KNOCKED_DOWN = {**HEAVY, "elevation_deg": 10.0, "azimuth_deg": 150.0, "perceived_s": 0.1, "ttc_s": 0.4}
OFFER = f"Fetch some ({library.FETCH_SIZE})"
PATIENCE_S = 30.0


def until(holds) -> None:
    end = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def python(monkeypatch, program: str) -> None:
    """This instead of the real command."""
    monkeypatch.setattr(fetching, "COMMAND", (sys.executable, "-c", program))


@pytest.fixture
def fallen(tmp_path, monkeypatch) -> Session:
    """Somebody who lies there, in a library whose get-ups are not here yet."""
    files = [get_up_file(tmp_path, face_down=down) for down in (False, True)]
    listed = [
        library.Listed(file.stem, "tips up", str(tmp_path / "fetched" / file.name), extra=True, gets_up=True)
        for file in files
    ]
    sway = next(clip for clip in library.LIBRARY if clip.name == "sway")
    monkeypatch.setattr(library, "LIBRARY", (sway, *listed))
    raw = {"character": [{"clip": "sway"}], "threat": [KNOCKED_DOWN], "duration_s": 8.0}
    session = Session(check_scenario(raw), tmp_path, tmp_path, lambda: 0.0)
    session.slow_motion.enabled = False
    while not stays_down(session):
        assert session.tick < 500
        session.run.advance()
    return session


def test_it_is_said_and_offered(fallen):
    ui = HandUi(**{OFFER: True})
    draw_offer(ui, fallen, 10.0)
    assert fallen.asked == ["clips"]
    assert any("no clip that is here gets up" in line for line in ui.said)


def test_nothing_is_offered_to_who_stands(fallen):
    fallen.seek(0)
    ui = HandUi()
    draw_offer(ui, fallen, 10.0)
    assert not ui.said
    assert not ui.seen


def test_fetching_lets_them_get_up(fallen, tmp_path, monkeypatch):
    python(monkeypatch, f"import os; os.makedirs({str(tmp_path / 'fetched')!r}, exist_ok=True); "
           f"[os.link(f, {str(tmp_path / 'fetched')!r} + '/' + os.path.basename(f)) "
           f"for f in __import__('glob').glob({str(tmp_path / '*.json')!r})]")  # fmt: skip
    keeper, blank = Keeper(fallen), np.zeros((4, 4, 3), np.uint8)
    fallen.ask("clips")
    keeper.keep(lambda: blank, 0.0)
    assert fallen.fetching
    until(lambda: keeper.keep(lambda: blank, 0.0) or not fallen.fetching)
    tick = fallen.tick
    fallen.advance(0.0)  # what has happened happens again, with the clips
    assert fallen.tick == tick
    while fallen.phase == Phase.DOWN:
        assert fallen.tick < tick + 240
        fallen.run.advance()
    assert fallen.phase == Phase.RECOVER_BLEND
    assert not stays_down(fallen)


def test_what_went_wrong_is_said_in_one_line(fallen, monkeypatch):
    python(monkeypatch, "import sys; sys.exit('a warning\\nerror[fetch]: could not fetch it (no network)')")
    keeper, blank = Keeper(fallen), np.zeros((4, 4, 3), np.uint8)
    fallen.ask("clips")
    until(lambda: keeper.keep(lambda: blank, 0.0) or not fallen.fetching)
    line = fallen.toasts.lines[-1]
    assert (line.text, line.alarm) == ("error[fetch]: could not fetch it (no network)", True)


def test_the_clips_panel_offers_the_same(fallen):
    ui = HandUi(**{f"Fetch what is not here ({library.FETCH_SIZE})": True})
    ClipsPanel().draw(ui, fallen)
    assert fallen.asked == ["clips"]


def test_a_window_that_closes_ends_it(monkeypatch):
    python(monkeypatch, "import time; time.sleep(600)")
    going = Fetching()
    going.begin()
    process = going._process
    going.begin()  # a second time changes nothing
    assert going._process is process
    assert going.ended() is None
    going.stop()
    assert process.returncode is not None
    assert not going.going
