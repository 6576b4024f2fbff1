"""The camera: where it stands, how it moves, what it sees. Frozen data; every move gives a new one.

Pixels count from the top left corner of a picture `size_px = (width, height)`; their centres are at half pixels.
Nothing here changes simulation state, so plain numpy linear algebra is fine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

NEAR_M, FAR_M = 0.1, 120.0
MIN_DISTANCE_M, MAX_DISTANCE_M = 0.3, 60.0
MAX_PITCH_RAD = math.radians(88.0)

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """A perspective eye. World metres, Z up."""

    eye: Point = (3.6, 2.2, 1.6)
    target: Point = (0.0, 0.0, 0.95)
    up: Point = (0.0, 0.0, 1.0)
    fov_rad: float = math.radians(34.0)  # vertical

    def axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Right, up and forward of the picture, unit vectors (3,) in the world."""
        forward = np.subtract(self.target, self.eye).astype(float)
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, self.up)
        right /= np.linalg.norm(right)
        return right, np.cross(right, forward), forward

    @property
    def distance_m(self) -> float:
        """From the eye to what it looks at."""
        return float(np.linalg.norm(np.subtract(self.target, self.eye)))


def orbit_camera(target, azimuth_deg: float, elevation_deg: float, distance_m: float, **more) -> Camera:
    """A camera seen from its target: azimuth 0 stands on +X looking back, 90 on +Y; elevation above the horizon."""
    back = _direction(math.radians(azimuth_deg), math.radians(elevation_deg))
    return Camera(eye=_point(np.add(target, distance_m * back)), target=_point(target), **more)


def orbit(camera: Camera, yaw_rad: float, pitch_rad: float) -> Camera:
    """Swings the eye about the target: yaw to the left of what is seen, pitch upwards, never over the pole."""
    back = np.subtract(camera.eye, camera.target)
    distance_m = np.linalg.norm(back)
    azimuth = math.atan2(back[1], back[0]) + yaw_rad
    elevation = np.clip(math.asin(np.clip(back[2] / distance_m, -1, 1)) + pitch_rad, -MAX_PITCH_RAD, MAX_PITCH_RAD)
    return replace(camera, eye=_point(np.add(camera.target, distance_m * _direction(azimuth, elevation))))


def pan(camera: Camera, dx_px: float, dy_px: float, size_px) -> Camera:
    """Drags the world along with the cursor: the point at the target's depth stays under it."""
    right, up, _ = camera.axes()
    metres_per_px = 2.0 * camera.distance_m * math.tan(0.5 * camera.fov_rad) / max(size_px[1], 1)
    return moved(camera, (up * dy_px - right * dx_px) * metres_per_px)


def off_centre(camera: Camera, left_px: float, up_px: float, size_px) -> Camera:
    """Moved sideways so that what stood in the middle of the picture stands that much farther left and up in it."""
    return pan(camera, -left_px, -up_px, size_px)


def zoom(camera: Camera, steps: float) -> Camera:
    """Towards the target for positive steps, an eighth of the way each."""
    distance_m = np.clip(camera.distance_m * math.exp(-0.13 * steps), MIN_DISTANCE_M, MAX_DISTANCE_M)
    back = np.subtract(camera.eye, camera.target) / camera.distance_m
    return replace(camera, eye=_point(np.add(camera.target, distance_m * back)))


def moved(camera: Camera, by_m) -> Camera:
    """The whole camera shifted, looking the same way."""
    return replace(camera, eye=_point(np.add(camera.eye, by_m)), target=_point(np.add(camera.target, by_m)))


def follow(camera: Camera, point_m, passed_s: float, half_life_s: float = 0.25) -> Camera:
    """Glides so that the target closes in on a moving point; half of the way is made in each half-life."""
    weight = 1.0 - 0.5 ** (passed_s / half_life_s)
    return moved(camera, weight * np.subtract(point_m, camera.target))


def frame_all(camera: Camera, points_m, size_px, margin: float = 0.08) -> Camera:
    """The nearest place from which every point (N, 3) is in the picture, looking the same way.

    margin: the share of the picture that stays free on each side. Each point's view coordinates bound the eye along the
    four sides of the frustum; the two opposite sides that bind give the depth in closed form. Sideways the eye is then
    put where the outermost points are equally far from the centre.
    """
    points = np.asarray(points_m, float).reshape(-1, 3)
    if len(points) == 0:
        return camera
    right, up, forward = camera.axes()
    depth = points @ forward
    tangents = half_tangents(camera, size_px) * (1.0 - 2.0 * margin)
    laterals = (points @ right, points @ up)
    bounds = [(np.min(x + t * depth), np.max(x - t * depth)) for x, t in zip(laterals, tangents, strict=True)]
    eye_depth = min((low - high) / (2.0 * t) for (low, high), t in zip(bounds, tangents, strict=True))
    eye_depth = min(eye_depth, float(np.min(depth)) - MIN_DISTANCE_M)
    across, upwards = (_centred(x, depth - eye_depth) for x in laterals)
    eye = across * right + upwards * up + eye_depth * forward
    middle_depth = 0.5 * (np.min(depth) + np.max(depth))
    return replace(camera, eye=_point(eye), target=_point(eye + (middle_depth - eye_depth) * forward))


def _centred(lateral: np.ndarray, depth: np.ndarray) -> float:
    """The sideways place of the eye from which the leftmost and the rightmost slope are opposite, by bisection."""
    low, high = float(np.min(lateral)), float(np.max(lateral))
    for _ in range(50):
        middle = 0.5 * (low + high)
        slopes = (lateral - middle) / depth
        low, high = (middle, high) if slopes.max() + slopes.min() > 0.0 else (low, middle)
    return 0.5 * (low + high)


def half_tangents(camera: Camera, size_px) -> np.ndarray:
    """(2,) tangents of half the field of view, across and up."""
    vertical = math.tan(0.5 * camera.fov_rad)
    return np.array([vertical * size_px[0] / max(size_px[1], 1), vertical])


def clip_from_world(camera: Camera, size_px) -> np.ndarray:
    """(4, 4) the projection that GL wants: world columns to clip space."""
    right, up, forward = camera.axes()
    view = np.eye(4)
    view[:3, :3] = right, up, -forward
    view[:3, 3] = -view[:3, :3] @ np.asarray(camera.eye, float)
    across, upwards = half_tangents(camera, size_px)
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = 1.0 / across, 1.0 / upwards
    projection[2, 2] = -(FAR_M + NEAR_M) / (FAR_M - NEAR_M)
    projection[2, 3] = -2.0 * FAR_M * NEAR_M / (FAR_M - NEAR_M)
    projection[3, 2] = -1.0
    return projection @ view


def project(camera: Camera, points_m, size_px) -> tuple[np.ndarray, np.ndarray]:
    """Pixels (N, 2) of world points (N, 3), and their depths (N,) along the view: behind the eye where not positive."""
    points = np.asarray(points_m, float).reshape(-1, 3)
    right, up, forward = camera.axes()
    offset = points - np.asarray(camera.eye, float)
    depth = offset @ forward
    across, upwards = half_tangents(camera, size_px)
    safe = np.where(np.abs(depth) > 1e-9, depth, 1e-9)
    x = (0.5 + 0.5 * (offset @ right) / (safe * across)) * size_px[0]
    y = (0.5 - 0.5 * (offset @ up) / (safe * upwards)) * size_px[1]
    return np.stack([x, y], axis=1), depth


def ray_through(camera: Camera, pixel, size_px) -> tuple[np.ndarray, np.ndarray]:
    """Where a pixel looks: the eye (3,) and a unit direction (3,) in the world. For picking and throwing."""
    right, up, forward = camera.axes()
    across, upwards = half_tangents(camera, size_px)
    x = (2.0 * pixel[0] / max(size_px[0], 1) - 1.0) * across
    y = (1.0 - 2.0 * pixel[1] / max(size_px[1], 1)) * upwards
    direction = forward + x * right + y * up
    return np.asarray(camera.eye, float), direction / np.linalg.norm(direction)


def _direction(azimuth_rad: float, elevation_rad: float) -> np.ndarray:
    level = math.cos(elevation_rad)
    return np.array([level * math.cos(azimuth_rad), level * math.sin(azimuth_rad), math.sin(elevation_rad)])


def _point(xyz) -> Point:
    x, y, z = xyz
    return (float(x), float(y), float(z))
