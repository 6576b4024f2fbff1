"""The one room that knows MuJoCo: a body's dynamics, the blow of a ball, and what follows."""

import os

# MuJoCo would load a window library for drawing of its own, which nobody here asks for: 70 ms at every start
os.environ.setdefault("MUJOCO_GL", "disable")
