"""The page: whole in itself, small, true to the run; and in a real browser it is seen, turned, stopped and scrubbed."""

import base64
import json
import re
import zlib

import numpy as np
import pytest

from demos.exporting.html import centre_of, html_bytes
from engine.body.kinematics import joints_of
from engine.body.skeleton import Pose
from engine.maths import rotations
from tests.exporting.browser import browser_page, find_chromium

CAMERA = (55.0, 9.0, 4.4)
SIZE = (800, 560)


@pytest.fixture(scope="module")
def text(footage):
    return html_bytes(footage, CAMERA).decode()


def inside(text):
    """(head, array by its place), read as the page reads them."""
    head = json.loads(re.search(r'<script id="head" type="application/json">(.*?)</script>', text, re.S)[1])
    packed = re.search(r'<script id="data" type="text/plain">(.*?)</script>', text, re.S)[1]
    data = zlib.decompress(base64.b64decode(packed))
    return head, lambda place: np.frombuffer(data, place[0], place[2], place[1])


def test_nothing_is_fetched_and_nothing_is_large(text):
    assert len(text) < 1_500_000
    assert not re.search(r"https?:|//cdn|src\s*=|<link|@import|import\(", text)
    assert "default-src 'none'" in text


def test_a_title_is_text_and_no_page(text):
    assert "<title>two &lt;people&gt;</title>" in text
    assert inside(text)[0]["title"] == "two <people>"


def test_tracks_are_the_run_within_rounding(text, footage):
    head, array = inside(text)
    assert (head["fps"], head["frames"]) == (footage.fps, len(footage.time_s))
    for told, person in zip(head["people"], footage.people, strict=True):
        root = array(told["root"]).reshape(-1, 3).astype(float)
        turns = rotations.normalise(array(told["turns"]).reshape(-1, 21, 4) / 32767.0)
        found = joints_of(person.body._replace(offset_m=np.array(told["offsets"])), Pose(root, turns))[0]
        assert np.abs(found - joints_of(person.body, person.pose)[0]).max() < 2e-4
    ball = head["balls"][0]
    assert np.abs(array(ball["places"]).reshape(-1, 3) - footage.balls[0].position_m).max() < 1e-5
    assert np.array_equal(array(ball["seen"]).astype(bool), footage.balls[0].seen)


def test_people_of_one_body_share_one_mesh(text):
    head, array = inside(text)
    assert [person["mesh"] for person in head["people"]] == [0, 0]
    assert len(head["meshes"]) == 2  # and the ball's
    for mesh in head["meshes"]:
        corners = mesh["places"][2] // 4
        assert array(mesh["triangles"]).max() == corners - 1
        weights = array(mesh["weights"]).reshape(-1, 4).sum(axis=1, dtype=int)
        assert np.abs(weights - 255).max() <= 2


def test_phases_and_marks_tell_the_story(text):
    head, _ = inside(text)
    names = [phase["name"] for phase in head["phases"]]
    assert names[0] == "play"
    assert names.index("protect") < names.index("respond")
    kinds = [kind for _, kind in head["marks"]]
    assert kinds[:2] == ["perceived", "contact"]
    assert set(kinds[2:]) <= {"contact"}  # a ball may come off one hand and meet the other


def test_the_camera_looks_at_all_of_them(footage):
    centre, reach_m, at_first_m = centre_of(footage)
    assert at_first_m <= reach_m
    assert centre.shape == (len(footage.time_s), 3)
    for person in footage.people:
        assert np.hypot(*(person.pose.root_m - centre)[:, :2].T).max() < reach_m
    assert np.abs(np.diff(centre, n=2, axis=0)).max() < 2e-3  # no shake


def test_the_same_footage_gives_the_same_bytes(footage, text):
    assert html_bytes(footage, CAMERA).decode() == text


@pytest.fixture(scope="module")
def page(tmp_path_factory, text):
    if find_chromium() is None:
        pytest.skip("no Chromium here (Debian: apt-get install chromium)")
    folder = tmp_path_factory.mktemp("page")
    path = folder / "scene.html"
    path.write_text(text, encoding="utf-8")
    with browser_page(folder / "profile", SIZE) as page:
        page.address = path.as_uri()
        unlimited = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
        page.call("Network.emulateNetworkConditions", offline=True, **unlimited)
        yield page


def state(page):
    return page.value("document.body.dataset.state"), float(page.value("document.body.dataset.time"))


def camera(page):
    return np.array(page.value("document.body.dataset.camera").split(), float)


def dark(picture):
    """Pixels of shorts, hair and glass in the picture above the controls."""
    return int((picture[:450, :, :].max(axis=2) < 90).sum())


def coloured(picture):
    """Pixels of the ball's yellow and blue."""
    return int((np.ptp(picture[60:450].astype(int), axis=2) > 70).sum())


def test_it_shows_the_people_and_the_ball(page):
    page.open(f"{page.address}#t=0.2")
    before = page.picture()
    page.open(f"{page.address}#t=1.03")
    coming = page.picture()
    assert state(page) == ("paused", 1.03)
    assert page.value("document.getElementById('message').textContent") == ""
    assert dark(before) > 300
    assert coloured(before) < 20  # no ball yet
    assert coloured(coming) > 100
    assert page.requests == [] or all(address.startswith(("file:", "about:")) for address in page.requests)


def test_it_plays_and_space_stops_it(page):
    page.open(page.address)
    page.wait_for("Number(document.body.dataset.time) > 0.1")
    assert state(page)[0] == "playing"
    page.key(" ")
    page.wait_for("document.body.dataset.state === 'paused'")
    stopped = state(page)[1]
    first, second = page.picture(), page.picture()
    assert state(page)[1] == stopped
    assert np.array_equal(first, second)
    page.key(".")
    page.wait_for(f"Number(document.body.dataset.time) > {stopped}")
    assert state(page)[1] == pytest.approx(min(stopped + 1.0 / 30.0, 1.4), abs=1e-3)


def test_dragging_orbits_and_the_wheel_comes_nearer(page):
    page.open(f"{page.address}#t=0.2")
    first, seen = camera(page), page.picture()
    page.drag((400, 250), (500, 280))
    page.picture()
    turned = camera(page)
    assert turned[0] == pytest.approx(first[0] - 40.0, abs=1.0)
    assert turned[1] == pytest.approx(first[1] + 9.0, abs=1.0)
    page.mouse("mouseWheel", 400, 250, deltaX=0, deltaY=-300)
    page.wait_for(f"Number(document.body.dataset.camera.split(' ')[2]) < {0.9 * first[2]}")
    near = page.picture()
    assert dark(near) > 1.3 * dark(seen)
    page.key("x")
    page.picture()
    assert np.array_equal(camera(page), first)
    assert np.array_equal(page.picture(), seen)


def test_the_timeline_scrubs(page):
    page.open(f"{page.address}#t=0")
    box = page.value("document.getElementById('timeline').getBoundingClientRect().toJSON()")
    left, top, width = box["x"], box["y"] + 0.5 * box["height"], box["width"]
    page.drag((left + 0.1 * width, top), (left + 0.79 * width, top))
    page.picture()
    assert state(page) == ("paused", pytest.approx(0.79 * 1.4, abs=0.01))
    assert "respond" in page.value("document.getElementById('caption').textContent")
