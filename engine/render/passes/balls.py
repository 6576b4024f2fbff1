"""Balls: one unit sphere, instanced; the panels are painted by the shader, so they are sharp at any distance."""

from __future__ import annotations

import numpy as np

from engine.render.gpu import Instances, make_pass
from engine.render.scene import Ball

SOLID, SHADOW, MEASURE = range(3)
SHADOW_UNIT = 1
VOLLEYBALL, PLAIN = range(2)


class BallPass:
    """Draws solid balls, and after everything else those that are seen through."""

    def __init__(self, gl):
        programs = [make_pass(gl, "ball"), make_pass(gl, "ball", SHADOW=1), make_pass(gl, "ball_measure")]
        programs[SOLID]["shadow_map"] = SHADOW_UNIT
        vertices, triangles = unit_sphere()
        layout = (gl.buffer(vertices.astype("f4").tobytes()), "3f", "vertex")
        index = gl.buffer(triangles.astype("i4").tobytes())
        self.solid, self.ghosts = (
            Instances(gl, programs, layout, "4f 4f 2f", ("place_m", "turn", "look"), index) for _ in range(2)
        )

    def upload(self, balls: list[Ball], eye_m) -> None:
        solid = [ball for ball in balls if ball.alpha >= 1.0]
        ghosts = [ball for ball in balls if 0.0 < ball.alpha < 1.0]
        ghosts.sort(key=lambda ball: -float(np.linalg.norm(np.subtract(ball.position_m, eye_m))))
        for instances, drawn in ((self.solid, solid), (self.ghosts, ghosts)):
            instances.upload(np.array([_row(ball) for ball in drawn], "f4").reshape(-1, 10))

    def draw_solid(self, which: int = SOLID) -> None:
        self.solid.draw(which)

    def draw_shadow(self) -> None:
        self.solid.draw(SHADOW)

    def draw_ghosts(self) -> None:
        self.ghosts.draw(SOLID)


def unit_sphere(steps: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """(V, 3) points and (T, 3) triangles: an octahedron split `steps` times and pushed out."""
    vertices = np.vstack([np.eye(3), -np.eye(3)])
    triangles = np.array([(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)])
    for _ in range(steps):
        corners = vertices[triangles]
        middles = 0.5 * (corners + np.roll(corners, -1, axis=1))  # of the sides 0-1, 1-2, 2-0
        points = np.concatenate([corners, middles], axis=1)
        points /= np.linalg.norm(points, axis=2, keepdims=True)
        base = 6 * np.arange(len(triangles))[:, None]
        triangles = np.concatenate([base + part for part in ([0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5])])
        vertices, inverse = np.unique(np.round(points.reshape(-1, 3), 9), axis=0, return_inverse=True)
        triangles = inverse.reshape(-1)[triangles]
    return vertices, triangles


def _row(ball: Ball) -> tuple[float, ...]:
    kind = VOLLEYBALL if ball.kind == "volleyball" else PLAIN
    return (*np.asarray(ball.position_m, float), ball.radius_m, *np.asarray(ball.orientation, float), kind, ball.alpha)
