"""Threats, and what a character makes of them: README.md beside this file walks through it.

A program begins with `scenario.load_scenario` (a file) or `scenario.check_scenario` (a dict), makes a
`simulation.Simulation` of it, and calls its `step` 120 times a second; `simulation.apply_command` throws something in,
`playing.joint_frames` reads a skeleton, `Simulation.world` is all state. `demos/own_loop.py` does all of this.
"""
