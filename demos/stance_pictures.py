"""Stances to look at: one from the front and the side, or the way from neutral into it and back."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from behaviours.stance import sequence
from behaviours.stance.shape import shape, wind_up
from behaviours.stance.solve import StanceResult, solve_shape
from behaviours.stance.stepping import stands_elsewhere, steps_to
from engine.body.skeleton import ANKLES, Body
from engine.body.support import polygon_of
from engine.render.camera import Camera, orbit_camera
from engine.render.scene import Balance, Ball, Figure, Scene

FPS = 30.0
SIZE_PX = (480, 720)
MARK_RADIUS_M = 0.035
VIEWS_DEG = (0.0, -90.0)  # front, and its right side, from which it faces right
LENS_RAD, DISTANCE_M, MIDDLE_M = math.radians(19.0), 6.4, 0.92
WIND_UP_S, MOVE_S, HOLD_S = 0.35, 0.7, 0.9


def scene_of(body: Body, joints_m, orientations, com_m, wanted_m, planted, marks: Sequence) -> Scene:
    """One body with its balance on the floor, and a ball for each point that it is about."""
    support_m = polygon_of(body, joints_m, orientations, planted)
    return Scene(
        figures=[Figure(body, joints_m, orientations)],
        balls=[Ball(point, MARK_RADIUS_M, kind="mark") for point in marks],
        balances=[Balance(support_m, com_m, wanted_m)],
    )


def scene_of_result(body: Body, result: StanceResult, marks: Sequence = ()) -> Scene:
    both = np.array([True, True])
    return scene_of(body, result.joints_m, result.orientations, result.com_m, result.plan.balance_m, both, marks)


def camera_at(azimuth_deg: float, elevation_deg: float = 5.0) -> Camera:
    """A long lens, so that front and side keep their proportions."""
    return orbit_camera((0.05, 0.0, MIDDLE_M), azimuth_deg, elevation_deg, DISTANCE_M, fov_rad=LENS_RAD)


def front_and_side(body: Body, result: StanceResult, marks: Sequence = ()) -> np.ndarray:
    """(H, W, 3) both views side by side."""
    from demos.filming import studio

    views = []
    with studio() as renderer:
        for azimuth in VIEWS_DEG:
            renderer.draw(scene_of_result(body, result, marks), camera_at(azimuth), SIZE_PX)
            views.append(renderer.read_rgb())
    return np.hstack(views)


def there_and_back(body: Body, results: Sequence[StanceResult]) -> tuple[StanceResult, list[sequence.Move]]:
    """From neutral, with a little wind-up before each, into one stance after the other, and back to neutral. One whose
    feet stand elsewhere is stepped into.
    """
    neutral = at = solve_shape(body, shape(), results[0].feet)
    moves: list[sequence.Move] = []
    for result in results:
        if stands_elsewhere(at.feet, result.feet):
            moves += [*steps_to(body, at, result), sequence.Move(result, 0.0, HOLD_S)]
        else:
            back = solve_shape(body, wind_up(result.shape, 0.2), result.feet)
            moves += [sequence.Move(back, WIND_UP_S, 0.0), sequence.Move(result, MOVE_S, HOLD_S)]
        at = result
    if stands_elsewhere(at.feet, neutral.feet):
        return neutral, [*moves, *steps_to(body, at, neutral)]
    return neutral, [*moves, sequence.Move(neutral, MOVE_S, 0.3)]


def film_of(body: Body, frames: Sequence[sequence.Frame], marks: Sequence = ()) -> Iterator[np.ndarray]:
    """Pictures of a sequence, FPS a second."""
    from demos.filming import studio

    with studio() as renderer:
        for frame in frames[:: round(sequence.TICK_RATE_HZ / FPS)]:
            scene = scene_of(
                body, frame.joints_m, frame.orientations, frame.com_m, frame.com_wanted_m, frame.planted, marks
            )
            renderer.draw(scene, camera_at(-40.0, 8.0), SIZE_PX)
            yield renderer.read_rgb()


def foot_motion_m(frames: Sequence[sequence.Frame]) -> float:
    """How far any ankle strays from where it was when its foot came to stand."""
    most_m, stood = 0.0, [None, None]
    for frame in frames:
        for side, ankle in enumerate(ANKLES):
            if not frame.planted[side]:
                stood[side] = None
            elif stood[side] is None:
                stood[side] = frame.joints_m[ankle]
            else:
                most_m = max(most_m, float(np.sqrt(((frame.joints_m[ankle] - stood[side]) ** 2).sum())))
    return most_m
