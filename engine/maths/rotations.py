"""Whole arrays of unit quaternions at once: shapes (..., 4), components w x y z, active. `multiply(a, b)` applies b
first.

The plain-numpy twin of `engine.maths.quaternion` for work done once, at import, at set-up, in tests. Leading axes
broadcast."""

from __future__ import annotations

import numpy as np

AXIS_OF_LETTER = {"X": 0, "Y": 1, "Z": 2}


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The rotations b followed by the rotations a (Hamilton product)."""
    aw, ax, ay, az = np.moveaxis(np.asarray(a, float), -1, 0)
    bw, bx, by, bz = np.moveaxis(np.asarray(b, float), -1, 0)
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=-1,
    )


def conjugate(q: np.ndarray) -> np.ndarray:
    """The inverses of unit quaternions."""
    return np.asarray(q, float) * np.array([1.0, -1.0, -1.0, -1.0])


def normalise(q: np.ndarray) -> np.ndarray:
    """The same rotations at unit length; a zero quaternion becomes the identity."""
    q = np.asarray(q, float)
    length = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(length < 1e-300, np.array([1.0, 0.0, 0.0, 0.0]), q / np.where(length < 1e-300, 1.0, length))


def rotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The vectors v (..., 3) turned by q: v + 2 w (u x v) + 2 u x (u x v), with u the vector part."""
    q, v = np.asarray(q, float), np.asarray(v, float)
    t = 2.0 * np.cross(q[..., 1:], v)
    return v + q[..., :1] * t + np.cross(q[..., 1:], t)


def unrotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The vectors v (..., 3) seen from frames whose orientations are q."""
    return rotate(conjugate(q), v)


def from_axis_angle(axis: np.ndarray, angle_rad: np.ndarray | float) -> np.ndarray:
    """Rotations by angles (...) about unit axes (..., 3)."""
    return from_rotation_vector(np.asarray(axis, float) * np.asarray(angle_rad, float)[..., None])


def from_euler(order: str, angles_rad: np.ndarray) -> np.ndarray:
    """Rotations from angles (..., len(order)) about the letters of `order`, each about the axes already turned by those
    before it.

    "ZYX" is R_z R_y R_x: the way a BVH file lists its channels. Any number of letters, repeats allowed.
    """
    angles_rad = np.asarray(angles_rad, float)
    q = np.zeros((*angles_rad.shape[:-1], 4))
    q[..., 0] = 1.0
    for column, letter in enumerate(order):
        turn = np.zeros_like(q)
        turn[..., 0] = np.cos(0.5 * angles_rad[..., column])
        turn[..., 1 + AXIS_OF_LETTER[letter]] = np.sin(0.5 * angles_rad[..., column])
        q = multiply(q, turn)
    return q


def to_matrix(q: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3), columns the turned axes."""
    q = np.asarray(q, float)
    return np.stack([rotate(q, axis) for axis in np.eye(3)], axis=-1)


def from_matrix(m: np.ndarray) -> np.ndarray:
    """Unit quaternions from rotation matrices (..., 3, 3), the largest component found first (Shepperd 1978)."""
    m = np.asarray(m, float)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    # four times the product of every pair of components; the row of the largest square is the most accurate
    squares = np.stack([1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz], axis=-1)
    wx, wy, wz = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    xy, xz, yz = m[..., 0, 1] + m[..., 1, 0], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 2] + m[..., 2, 1]
    products = np.stack(
        [
            np.stack([squares[..., 0], wx, wy, wz], axis=-1),
            np.stack([wx, squares[..., 1], xy, xz], axis=-1),
            np.stack([wy, xy, squares[..., 2], yz], axis=-1),
            np.stack([wz, xz, yz, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    row = np.argmax(squares, axis=-1)[..., None, None]
    return normalise(np.take_along_axis(products, np.broadcast_to(row, (*row.shape[:-1], 4)), axis=-2)[..., 0, :])


def from_rotation_vector(r: np.ndarray) -> np.ndarray:
    """Exponential map of axis times angle (..., 3), radians."""
    r = np.asarray(r, float)
    angle = np.linalg.norm(r, axis=-1, keepdims=True)
    scale = 0.5 * np.sinc(0.5 * angle / np.pi)
    return np.concatenate([np.cos(0.5 * angle), scale * r], axis=-1)


def to_rotation_vector(q: np.ndarray) -> np.ndarray:
    """Logarithm (..., 3): axis times angle, radians, the angle in [0, pi]."""
    q = np.asarray(q, float)
    q = np.where(q[..., :1] < 0.0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    small = sine < 1e-12
    return q[..., 1:] * np.where(small, 2.0, 2.0 * np.arctan2(sine, q[..., :1]) / np.where(small, 1.0, sine))


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The angles (...) of the rotations from a to b, in [0, pi] radians."""
    return np.linalg.norm(to_rotation_vector(multiply(conjugate(a), b)), axis=-1)


def slerp(a: np.ndarray, b: np.ndarray, weight: np.ndarray | float) -> np.ndarray:
    """Spherical linear interpolation along the shorter arc, weight (...) 0 gives a, 1 gives b (Shoemake 1985)."""
    arc = to_rotation_vector(multiply(conjugate(a), b))
    return multiply(a, from_rotation_vector(np.asarray(weight, float)[..., None] * arc))


def between(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The least rotations that take unit vectors u (..., 3) to v; opposite vectors turn about an axis normal to u."""
    u, v = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
    w = 1.0 + np.sum(u * v, axis=-1, keepdims=True)
    helper = np.where(np.abs(u[..., :1]) < 0.9, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    opposite = np.concatenate([np.zeros_like(w), np.cross(u, helper)], axis=-1)
    return normalise(np.where(w < 1e-9, opposite, np.concatenate([w, np.cross(u, v)], axis=-1)))


def heading(q: np.ndarray) -> np.ndarray:
    """The yaws (...), radians about world Z, of the frames' X axes; of their -Z (Z) axes where X points straight up
    (down)."""
    x, z = rotate(q, np.array([1.0, 0.0, 0.0])), rotate(q, np.array([0.0, 0.0, 1.0]))
    upright = np.where(x[..., 2:] > 0.0, -z, z)
    chosen = np.where((x[..., 0] ** 2 + x[..., 1] ** 2 > 1e-4)[..., None], x, upright)
    return np.arctan2(chosen[..., 1], chosen[..., 0])


def about_z(angle_rad: np.ndarray | float) -> np.ndarray:
    """Yaws: rotations about Z by angles (...), radians."""
    half = 0.5 * np.asarray(angle_rad, float)
    zero = np.zeros_like(half)
    return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=-1)


def continuity(q: np.ndarray) -> np.ndarray:
    """The same rotations along axis 0, each quaternion in the hemisphere of the one before it, so that they may be
    interpolated."""
    q = np.array(q, float)
    if len(q) > 1:
        flips = np.where(np.sum(q[1:] * q[:-1], axis=-1) < 0.0, -1.0, 1.0)
        q[1:] *= np.cumprod(flips, axis=0)[..., None]
    return q
