"""Unit quaternions for kernels: one rotation in, one rotation out.

Conventions (Brace, everywhere): components w x y z, unit length, active, local to parent. `multiply(a, b)` applies b
first. Every function takes anything indexable (array row or tuple) and returns a tuple, so that inside a kernel
nothing is allocated; from plain Python they are just as usable. Whole arrays of rotations: `engine.maths.rotations`.
"""

from __future__ import annotations

import math

from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

IDENTITY = (1.0, 0.0, 0.0, 0.0)


@njit(cache=True)
def at(rows, row):
    """One row of an array (N, 4) as a tuple. In a kernel `rows[row]` would be a view: counted, a type of its own."""
    return (rows[row, 0], rows[row, 1], rows[row, 2], rows[row, 3])


@njit(cache=True)
def put(rows, row, q):
    """Writes one row of an array (N, 4)."""
    rows[row, 0] = q[0]
    rows[row, 1] = q[1]
    rows[row, 2] = q[2]
    rows[row, 3] = q[3]


@njit(cache=True)
def multiply(a, b):
    """The rotation b followed by the rotation a (Hamilton product)."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@njit(cache=True)
def conjugate(q):
    """The inverse of a unit quaternion."""
    return (q[0], -q[1], -q[2], -q[3])


@njit(cache=True)
def normalise(q):
    """The same rotation, unit length again after many products; a zero quaternion becomes the identity."""
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    if length < 1e-300:
        return (1.0, 0.0, 0.0, 0.0)
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length)


@njit(cache=True)
def rotate(q, v):
    """The vector v turned by q: v + 2 w (u x v) + 2 u x (u x v), with u the vector part."""
    tx = 2.0 * (q[2] * v[2] - q[3] * v[1])
    ty = 2.0 * (q[3] * v[0] - q[1] * v[2])
    tz = 2.0 * (q[1] * v[1] - q[2] * v[0])
    return (
        v[0] + q[0] * tx + q[2] * tz - q[3] * ty,
        v[1] + q[0] * ty + q[3] * tx - q[1] * tz,
        v[2] + q[0] * tz + q[1] * ty - q[2] * tx,
    )


@njit(cache=True)
def unrotate(q, v):
    """The vector v seen from the frame whose orientation is q."""
    return rotate(conjugate(q), v)


@njit(cache=True)
def from_axis_angle(axis, angle_rad):
    """Rotation by an angle about a unit axis."""
    s = math.sin(0.5 * angle_rad)
    return (math.cos(0.5 * angle_rad), axis[0] * s, axis[1] * s, axis[2] * s)


@njit(cache=True)
def about_x(angle_rad):
    """Rotation about X: rolls; the left arm lifts sideways for positive angles."""
    return (math.cos(0.5 * angle_rad), math.sin(0.5 * angle_rad), 0.0, 0.0)


@njit(cache=True)
def about_y(angle_rad):
    """Rotation about Y: pitches; the trunk bows forward for positive angles."""
    return (math.cos(0.5 * angle_rad), 0.0, math.sin(0.5 * angle_rad), 0.0)


@njit(cache=True)
def about_z(angle_rad):
    """Rotation about Z: yaws; turns left for positive angles."""
    return (math.cos(0.5 * angle_rad), 0.0, 0.0, math.sin(0.5 * angle_rad))


@njit(cache=True)
def from_rotation_vector(r):
    """Exponential map: axis times angle, in radians."""
    angle = math.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    if angle < 1e-12:
        return normalise((1.0, 0.5 * r[0], 0.5 * r[1], 0.5 * r[2]))
    s = math.sin(0.5 * angle) / angle
    return (math.cos(0.5 * angle), r[0] * s, r[1] * s, r[2] * s)


@njit(cache=True)
def to_rotation_vector(q):
    """Logarithm: axis times angle, radians, the angle in [0, pi]."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return (2.0 * x, 2.0 * y, 2.0 * z)
    scale = 2.0 * math.atan2(sine, w) / sine
    return (x * scale, y * scale, z * scale)


@njit(cache=True)
def angle_between(a, b):
    """The angle of the rotation from a to b, in [0, pi]."""
    d = multiply(conjugate(a), b)
    return 2.0 * math.atan2(math.sqrt(d[1] * d[1] + d[2] * d[2] + d[3] * d[3]), abs(d[0]))


@njit(cache=True)
def slerp(a, b, weight):
    """Spherical linear interpolation along the shorter arc, weight 0 gives a, 1 gives b (Shoemake 1985)."""
    r = to_rotation_vector(multiply(conjugate(a), b))
    return normalise(multiply(a, from_rotation_vector((weight * r[0], weight * r[1], weight * r[2]))))


@njit(cache=True)
def between(u, v):
    """The least rotation that takes unit vector u to unit vector v; opposite vectors turn about an axis normal to u."""
    w = 1.0 + u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
    if w < 1e-9:
        if abs(u[0]) < 0.9:
            return normalise((0.0, 0.0, u[2], -u[1]))
        return normalise((0.0, -u[2], 0.0, u[0]))
    return normalise((w, u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))


@inner_kernel
def from_columns(x, y, z):
    """The orientation whose axes, seen from outside, are the orthonormal right-handed x, y, z (Shepperd 1978)."""
    trace = x[0] + y[1] + z[2]
    if trace > 0.0:
        s = math.sqrt(trace + 1.0)
        q = (0.5 * s, 0.5 * (y[2] - z[1]) / s, 0.5 * (z[0] - x[2]) / s, 0.5 * (x[1] - y[0]) / s)
    elif x[0] >= y[1] and x[0] >= z[2]:
        s = math.sqrt(1.0 + x[0] - y[1] - z[2])
        q = (0.5 * (y[2] - z[1]) / s, 0.5 * s, 0.5 * (y[0] + x[1]) / s, 0.5 * (z[0] + x[2]) / s)
    elif y[1] >= z[2]:
        s = math.sqrt(1.0 - x[0] + y[1] - z[2])
        q = (0.5 * (z[0] - x[2]) / s, 0.5 * (y[0] + x[1]) / s, 0.5 * s, 0.5 * (z[1] + y[2]) / s)
    else:
        s = math.sqrt(1.0 - x[0] - y[1] + z[2])
        q = (0.5 * (x[1] - y[0]) / s, 0.5 * (z[0] + x[2]) / s, 0.5 * (z[1] + y[2]) / s, 0.5 * s)
    return normalise(q)


@njit(cache=True)
def swing_twist(q):
    """Splits q = swing * twist, the twist about the bone's own axis Z. Returns (swing, twist).

    A swing of exactly pi leaves the twist undefined; it is then zero.
    """
    length = math.sqrt(q[0] * q[0] + q[3] * q[3])
    if length < 1e-9:
        return ((q[0], q[1], q[2], q[3]), (1.0, 0.0, 0.0, 0.0))
    twist = (q[0] / length, 0.0, 0.0, q[3] / length)
    return (multiply(q, conjugate(twist)), twist)


@njit(cache=True)
def heading(q):
    """The yaw (radians, about world Z) of the frame's X axis; of its -Z axis where X points straight up or down."""
    x = rotate(q, (1.0, 0.0, 0.0))
    if x[0] * x[0] + x[1] * x[1] > 1e-4:
        return math.atan2(x[1], x[0])
    z = rotate(q, (0.0, 0.0, 1.0))
    if x[2] > 0.0:
        z = (-z[0], -z[1], -z[2])
    return math.atan2(z[1], z[0])
