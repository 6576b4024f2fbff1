"""A running scenario as pictures: which moments, from where, with what written on them."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from behaviours.components import Character, Phase, Reaction
from behaviours.scenario_spec import Scenario
from demos.frames import frames_of, slowed_frames_of
from demos.stage import floor_under, pelvis_m, scene_of
from demos.window.slow_motion import SlowMotion
from engine.core.clock import TICK_RATE_HZ
from engine.core.errors import BadInput
from engine.render.camera import Camera, follow, orbit_camera
from engine.render.context import make_context
from engine.render.renderer import Renderer
from engine.render.scene import Scene

# where the camera stands about the character: azimuth from the way it faces at first, elevation, distance
CAMERAS = {
    "quarter": (55.0, 9.0, 4.4),  # on the side that the first threat does not come from
    "front": (0.0, 8.0, 4.4),
    "left": (90.0, 8.0, 4.4),
    "right": (-90.0, 8.0, 4.4),
    "back": (180.0, 8.0, 4.4),
    "above": (-90.0, 80.0, 5.5),
}
LOOK_AT_M = 0.95  # height of what the camera looks at
FOLLOW_HALF_LIFE_S = 0.12


class Shot(NamedTuple):
    """How to film."""

    size_px: tuple[int, int] = (1280, 720)
    fps: float = 30.0
    camera: tuple[float, float, float] = CAMERAS["quarter"]  # azimuth and elevation in degrees, distance in metres
    ghosts: Collection[str] = ()
    floor: str = "gym"  # one of engine.render.scene.FLOORS
    slow: bool = False  # whether time slows about each blow


class Moment(NamedTuple):
    """One picture to be: when, what, and where the camera looks."""

    time_s: float
    scene: Scene
    centre_m: np.ndarray  # (3,)
    phase: str


def moments(world, advance: Callable[[], None], ticks: int, shot: Shot) -> Iterator[Moment]:
    """Steps a world through that many ticks and gives what is to be seen at every frame."""
    alphas = frames_of(world, advance, ticks, shot.fps)
    if shot.slow:
        slow_motion = SlowMotion()
        alphas = slowed_frames_of(world, advance, ticks, shot.fps, lambda passed_s: slow_motion.ease(world, passed_s))
    for alpha in alphas:
        now = moment(world, alpha, shot.ghosts)
        now.scene.floor = floor_under(now.scene, shot.floor)
        yield now


def placed_for(shot: Shot, scenario: Scenario) -> Shot:
    """The shot with its camera turned as the first character faces, and a quarter view put out of the threat's way."""
    azimuth, elevation, distance = shot.camera
    if shot.camera == CAMERAS["quarter"] and scenario.threat and scenario.threat[0].azimuth_deg > 0.0:
        azimuth = -azimuth
    return shot._replace(camera=(azimuth + scenario.character[0].heading_deg, elevation, distance))


def moment(world, alpha: float, ghosts: Collection[str]) -> Moment:
    """What is to be seen a share `alpha` of the way to the world's last tick."""
    time_s = (world.tick - 1.0 + alpha) / TICK_RATE_HZ if world.tick else 0.0
    scene = scene_of(world, alpha, ghosts)
    row = int(world.rows(Character)[0])
    phase = Phase(int(world[Reaction].phase[row])).name.lower()
    x, y, _ = pelvis_m(world, row)
    return Moment(time_s, scene, np.array([x, y, LOOK_AT_M]), phase)


@contextlib.contextmanager
def studio() -> Iterator[Renderer]:
    """A renderer without a display. One for all the pictures of a process: drivers do not like two contexts in one."""
    with make_context(headless=True, size=(16, 16)) as context:
        yield Renderer(context)


def film_pictures(
    renderer: Renderer, seen: Iterator[Moment], shot: Shot, witness: Callable[[Moment, Camera], None] | None = None
) -> Iterator[np.ndarray]:
    """Draws the moments one after the other, (H, W, 3) uint8 each; the camera goes along with the character.

    witness: is told each moment and from where it was drawn.
    """
    camera: Camera | None = None
    for now in seen:
        camera = follow(camera or _camera_at(now, shot), now.centre_m, 1.0 / shot.fps, FOLLOW_HALF_LIFE_S)
        now.scene.captions.append(("top-left", f"{now.time_s:.2f} s  {now.phase.replace('_', ' ')}"))
        renderer.draw(now.scene, camera, shot.size_px)
        yield renderer.read_rgb()
        if witness:
            witness(now, camera)


def strip_pictures(renderer: Renderer, chosen: Sequence[Moment], shot: Shot) -> list[np.ndarray]:
    """Each moment as a picture of its own, the camera right at the character."""
    drawn = []
    for now in chosen:
        renderer.draw(now.scene, _camera_at(now, shot), shot.size_px)
        drawn.append(renderer.read_rgb())
    return drawn


def _camera_at(now: Moment, shot: Shot) -> Camera:
    return orbit_camera(now.centre_m, *shot.camera)


def choose(seen: Sequence[Moment], count: int, from_s: float | None, to_s: float | None) -> list[Moment]:
    """`count` moments evenly spread: over the span asked for, else from just before the reaction until it is over."""
    busy = [now.time_s for now in seen if now.phase != "play"] or [seen[0].time_s, seen[-1].time_s]
    first = busy[0] - 0.1 if from_s is None else from_s
    last = busy[-1] + 0.1 if to_s is None else to_s
    inside = [now for now in seen if first <= now.time_s <= last]
    if not inside:
        raise BadInput("usage", f"nothing lies from {first:g} to {last:g} s; the scenario lasts {seen[-1].time_s:g} s")
    picks = [round(float(pick)) for pick in np.linspace(0, len(inside) - 1, min(count, len(inside)))]
    contact = next((i for i, now in enumerate(inside) if now.phase == "respond"), None)
    if contact is not None and contact not in picks and len(picks) > 2:  # the blow itself is what one looks for
        nearest = min(range(1, len(picks) - 1), key=lambda k: abs(picks[k] - contact))
        picks[nearest] = contact
    return [inside[pick] for pick in picks]


def parse_size(text: str) -> tuple[int, int]:
    """`1280x720`. BadInput for anything else."""
    width, cross, height = text.lower().partition("x")
    if not (cross and width.isdigit() and height.isdigit() and 16 <= int(width) <= 8192 and 16 <= int(height) <= 8192):
        raise BadInput("usage", f"--size {text!r}: expected WIDTHxHEIGHT, each from 16 to 8192, such as 1280x720")
    return int(width), int(height)


def parse_camera(text: str) -> tuple[float, float, float]:
    """One of CAMERAS, or azimuth,elevation[,distance]: degrees about the character, metres. BadInput otherwise."""
    if text in CAMERAS:
        return CAMERAS[text]
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) == 2:
        numbers.append(CAMERAS["quarter"][2])
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)) or abs(numbers[1]) >= 90 or numbers[2] <= 0:
        known = ", ".join(CAMERAS)
        raise BadInput("usage", f"--camera {text!r}: expected one of {known}, or AZIMUTH,ELEVATION[,DISTANCE]")
    return numbers[0], numbers[1], numbers[2]


def parse_ghosts(text: str) -> tuple[str, ...]:
    """`all`, or names of GHOSTS with commas. BadInput otherwise."""
    from demos.stage import GHOSTS

    names = GHOSTS if text == "all" else tuple(filter(None, text.split(",")))
    for name in names:
        if name not in GHOSTS:
            raise BadInput("usage", f"--ghosts {name!r}: expected all, or some of {', '.join(GHOSTS)}")
    return names
