"""After a knock-down: the body comes to rest and gets up if the library knows how, else it stays down and says so."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Phase
from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, PELVIS
from tests.behaviours.knocked import HEAVY, events, get_up_file, played, struck

KNOCKED_DOWN = {**HEAVY, "elevation_deg": 10.0, "azimuth_deg": 150.0}


def heights_m(run) -> np.ndarray:
    """(T, J) of the joints."""
    (track,) = run.observer.tracks.values()
    return joints_of(track.body, track.pose)[0][..., 2]


def phases(run) -> list[str]:
    return [phase["name"] for phase in run.report()["phases"]]


def rose(run, name: str) -> None:
    """Holds for every get-up."""
    (search,) = [event for event in events(run, "searched") if event["chosen"] == "get_up"]
    assert search["clip"] == name
    names = phases(run)
    at = names.index("down")
    assert names[at : at + 4] == ["down", "recover_blend", "recover_return", "play"]
    height = heights_m(run)
    (track,) = run.observer.tracks.values()
    down = np.flatnonzero(np.equal(track.phase, Phase.DOWN))
    assert height[down[-1], [HEAD, PELVIS]].max() < 0.5
    assert height[-1, HEAD] > 1.2
    assert height[-1, PELVIS] > 0.7
    # nothing is deep in the floor, and nothing jumps: a tenth of a metre a tick is 12 m/s
    assert height[down[-1] :].min() > -0.06
    assert np.abs(np.diff(np.array(track.root_m), axis=0)).max() < 0.1


@pytest.fixture(scope="module")
def own_get_ups(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clips")
    return [str(get_up_file(folder, face_down=down)) for down in (False, True)]


@pytest.fixture(scope="module", params=["new", "same"])
def risen(own_get_ups, request):
    """Getting up is the only way back to the same motion too."""
    wish = {"recover": request.param, "library": own_get_ups}
    return played(struck(KNOCKED_DOWN, clip="sway", duration_s=7.0, **wish), checked=True)


def test_somebody_knocked_down_gets_up_and_goes_on_with_their_own_clip(risen):
    (search,) = [event for event in events(risen, "searched") if event["chosen"] == "get_up"]
    rose(risen, search["clip"])
    assert risen.report()["metrics"]["recovered_to"] == search["clip"]
    (went_on,) = events(risen, "went_on")
    assert went_on["clip"] == "sway"
    assert phases(risen)[-3:] == ["play", "recover_return", "play"]
    (track,) = risen.observer.tracks.values()
    assert track.clip[-1] == 0


def test_a_get_up_is_deterministic(risen):
    again = played(risen.scenario)
    assert again.world.digest() == risen.world.digest()


@pytest.mark.parametrize("recover", ["new", "same"])
def test_without_a_get_up_the_body_stays_down_and_it_is_said_once(recover):
    run = played(struck(KNOCKED_DOWN, clip="sway", library=[], duration_s=5.0, recover=recover))
    assert events(run, "stays_down") == [{"reason": "no motion that gets up"}]
    assert run.report()["metrics"]["recovered_to"] == "down"
    assert phases(run)[-1] == "down"
    assert heights_m(run)[-1, HEAD] < 0.5


def test_a_get_up_that_begins_too_far_off_is_not_begun(own_get_ups):
    near = {"search": {"get_up_within_m": 0.01}}
    run = played(struck(KNOCKED_DOWN, clip="sway", library=own_get_ups, duration_s=5.0, settings=near))
    (said,) = events(run, "stays_down")
    assert said["reason"].startswith("the nearest get-up begins 0.")
    assert phases(run)[-1] == "down"


@pytest.mark.parametrize(("azimuth_deg", "elevation_deg"), [(0.0, 10.0), (150.0, 10.0)])
def test_real_get_ups(library_clip, azimuth_deg, elevation_deg):
    library = ["stand", "getup_faceup", "getup_facedown"]
    for name in library:
        library_clip(name)
    blow = {**KNOCKED_DOWN, "azimuth_deg": azimuth_deg, "elevation_deg": elevation_deg}
    run = played(struck(blow, clip="stand", library=library, duration_s=8.0))
    (search,) = [event for event in events(run, "searched") if event["chosen"] == "get_up"]
    assert search["clip"].startswith("getup_")
    rose(run, search["clip"])
    assert run.report()["metrics"]["foot_slide_max_m"] < 0.002


def test_for_the_same_motion_only_get_ups_are_gathered():
    """An upright clip of the library is of no use to whoever wants no new motion, and is not even looked for."""
    same = played(struck(KNOCKED_DOWN, clip="sway", library=["walk", "sway"], duration_s=0.1, recover="same"))
    assert same.world.assets.libraries == (None,)
    assert [clip.name for clip in same.world.assets.clips] == ["sway"]
