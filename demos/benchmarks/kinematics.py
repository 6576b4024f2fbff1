"""Forward kinematics and centre of mass of one pose, against the loop that one would write in numpy."""

from __future__ import annotations

import numpy as np

from demos.benchmarks import Benchmark


def prepare() -> Benchmark:
    from engine.body.anthropometry import standard_body
    from engine.body.kinematics import centre_of_mass, joints_into
    from engine.body.skeleton import JOINT_COUNT, PARENT

    body = standard_body()
    chance = np.random.default_rng(1)
    rotations = chance.normal(size=(JOINT_COUNT, 4))
    rotations /= np.linalg.norm(rotations, axis=1)[:, None]
    root_m = np.array([0.3, -0.2, 0.9])
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))

    def kernels():
        joints_into(body.offset_m, root_m, rotations, positions, orientations)
        return centre_of_mass(body, positions, orientations)

    def numpy_loop():
        where, turned = [], []
        for joint, parent in enumerate(PARENT):
            turn = _matrix(rotations[joint])
            if parent < 0:
                where.append(root_m)
                turned.append(turn)
            else:
                where.append(where[parent] + turned[parent] @ body.offset_m[joint])
                turned.append(turned[parent] @ turn)
        parts = [where[j] + turned[j] @ com for j, com in zip(body.part_joint, body.part_com_m, strict=True)]
        return np.average(parts, axis=0, weights=body.part_mass_kg)

    def check(ours, reference):
        np.testing.assert_allclose(ours, reference, atol=1e-12)

    return Benchmark("pose to joints and centre of mass", kernels, "numpy, joint by joint", numpy_loop, check)


def _matrix(q):
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
