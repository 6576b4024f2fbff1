"""What Numba is set up without stays within reach of everybody else."""

import subprocess
import sys

from tests.conftest import ROOT

IMPORTED = """
import sys
from engine.maths.ballistics import drag_per_m
drag_per_m(0.1, 0.3, 0.2)
print("scipy.linalg" in sys.modules)
"""
AFTERWARDS = """
import numpy as np
from numba import njit

@njit
def product(a, b):
    return np.dot(a, b), np.convolve(a[0], b[0]), np.linalg.solve(a, b)

a, b = np.array([[2.0, 1.0], [0.0, 4.0]]), np.array([[1.0, 3.0], [5.0, 7.0]])
for ours, numpys in zip(product(a, b), (np.dot(a, b), np.convolve(a[0], b[0]), np.linalg.solve(a, b))):
    assert np.allclose(ours, numpys, rtol=1e-14)
import scipy.linalg
assert scipy.linalg.det(a) == 8.0
"""


def test_it_is_not_imported_for_kernels_and_whoever_wants_it_has_it():
    done = subprocess.run([sys.executable, "-c", IMPORTED + AFTERWARDS], cwd=ROOT, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("False\n", "")
