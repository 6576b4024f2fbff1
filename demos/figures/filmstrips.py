"""Fig. 5.2: three filmstrips: back to the same motion; into a new one after a mild blow; and after an extreme one."""

from __future__ import annotations

from typing import Any

import numpy as np

from behaviours.components import Phase
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look, Strip, packed
from demos.figures.take import LEGEND, Take, take
from engine.body.kinematics import joints_of
from engine.body.skeleton import PELVIS
from engine.render.scene import Scene

LOOK = Look(-62.0, 9.0)
PITCH_M = 1.12
PICTURES, PICTURES_DOWN = 10, 8  # somebody who lies takes more of the strip
HEAD, BAND = 28, 26  # units over and under each strip
NEAR_M = 0.75  # balls whose skin is farther off, which would fly among the neighbours, are left out
MILD: dict[str, Any] = {"azimuth_deg": 25.0, "elevation_deg": 10.0, "speed_mps": 26.0, "size": 0.5, "perceived_s": 0.5}
EXTREME: dict[str, Any] = {
    **MILD,
    "azimuth_deg": 0.0,
    "speed_mps": 29.0,
    "size": 1.0,
    "size_means": "radius",
    "mass_kg": 2.0,
}
KNOCK_DOWN: dict[str, Any] = {
    **MILD, "kind": "custom", "target": "torso", "azimuth_deg": 0.0, "size": 1.0, "mass_kg": 12.0, "radius_m": 0.2,
    "speed_mps": 16.0, "speed_range_mps": [8.0, 20.0],
}  # fmt: skip
GET_UPS = ("getup_faceup", "getup_facedown")


def draw(press: Press) -> Sheet:
    # whoever is knocked down needs a motion to get up by
    extreme = KNOCK_DOWN if press.has(*GET_UPS) else EXTREME
    rows = (
        ("the same motion", take(press, scenario("same", MILD))),
        ("a new motion, mild blow", take(press, scenario("new", MILD))),
        (
            f"a new motion, extreme blow ({number(extreme['mass_kg'], 0)} kg)",
            take(press, scenario("new", extreme, 9.0)),
        ),
    )
    chosen = [moments(run) for _, run in rows]
    strips = [_strip(press, run, ticks) for (_, run), ticks in zip(rows, chosen, strict=True)]
    sheet = Sheet(sum(strip.size[1] + HEAD + BAND for strip in strips) + 34, press.scale)
    y = 0.0
    for (name, run), ticks, strip in zip(rows, chosen, strips, strict=True):
        y += HEAD
        sheet.text(8, y - HEAD + 5, f"{name}: {goes_on_with(run)}", BODY + 1, italic=True)
        sheet.picture(strip, 0, y)
        for k, tick in enumerate(ticks):
            x, _ = strip.at(k, (0.0, 0.0, 0.0))
            seconds = run.frames[tick].time_s - run.frames[run.contact].time_s
            sheet.text(x, y + strip.size[1] + 2, f"{number(seconds)} s", SMALL, "faint", "center")
        y += strip.size[1] + BAND
    sheet.legend(8, sheet.height - 14, LEGEND)
    sheet.text(992, sheet.height - 14, "time from contact", SMALL, "faint", "right", "center", italic=True)
    return sheet


def scenario(recover: str, threat: dict[str, Any], duration_s: float = 4.0) -> dict[str, Any]:
    """A walker who is met by such a threat."""
    character = {"clip": "walk", "start_s": 0.5, "startle": False, "recover": recover}
    return {"duration_s": duration_s, "character": [character], "threat": [threat]}


def moments(run: Take) -> list[int]:
    """Before perception, on the way, the pose as it is reached; then, by equal amounts of motion, until it goes on."""
    reached, first = run.contact - 1, run.perceived - 1
    down = any(frame.phase == Phase.DOWN for frame in run.frames)
    playing = [t for t in range(run.contact, len(run.frames)) if run.frames[t].phase == Phase.PLAY]
    over = len(run.frames) - 1
    if playing:
        stays = next((t for t in range(playing[0], over) if run.frames[t].phase != Phase.PLAY), over)
        over = stays if down else min(playing[0] + 24, over)
    after = _evenly_moving(run, run.contact + 8, over, (PICTURES_DOWN if down else PICTURES) - 3)
    return [first, (first + reached) // 2, reached, *after]


def _evenly_moving(run: Take, start: int, end: int, count: int) -> list[int]:
    """Ticks between which the joints, seen from over the pelvis, go equally far."""
    joints = np.array([joints_of(run.body, frame.pose)[0] for frame in run.frames[start : end + 1]])
    joints[:, :, :2] -= joints[:, PELVIS : PELVIS + 1, :2].copy()
    steps = np.linalg.norm(np.diff(joints, axis=0), axis=-1).mean(axis=-1)
    gone = np.concatenate([[0.0], np.cumsum(steps)])
    return [start + int(np.searchsorted(gone, share * gone[-1])) for share in np.linspace(0.0, 1.0, count)]


def _strip(press: Press, run: Take, ticks: list[int]) -> Strip:
    scenes = [_scene(run, tick) for tick in ticks]
    return press.strip(scenes, LOOK, 1000, packed(scenes, LOOK, PITCH_M))


def _scene(run: Take, tick: int) -> Scene:
    """The body over the origin, whether it stands or lies."""
    positions, _ = joints_of(run.body, run.frames[tick].pose)
    scene = run.scene(tick, 0.5 * (positions.min(axis=0) + positions.max(axis=0)))
    scene.balls = [ball for ball in scene.balls if np.hypot(*np.asarray(ball.position_m)[:2]) < NEAR_M + ball.radius_m]
    return scene


def goes_on_with(run: Take) -> str:
    """The motion that is played after the blow."""
    after = (frame.clip for frame in run.frames[run.contact :] if frame.phase == Phase.PLAY)
    return next(after, "stays down")
