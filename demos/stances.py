"""Every stance after the other, as a page to turn and scrub. `python -m demos.stances [PAGE.html]`"""

import sys
from itertools import pairwise

import numpy as np

from behaviours.components import Phase
from behaviours.stance.shape_sets import SETS
from behaviours.stance.solve import solve_stance
from demos.cli import guarded
from demos.exporting.footage import Footage, Person
from demos.exporting.html import html_bytes
from engine.body.anthropometry import standard_body
from engine.body.skeleton import JOINT_COUNT, Pose
from engine.core.files import write_atomically
from engine.maths import rotations

THING_M = (0.45, -0.25, 1.15)  # what one recoils from, is interested in or reaches for: ahead, to the right
CHANGE_FRAMES, HELD_FRAMES, FPS = 24, 36, 60.0
CAMERA = (-35.0, 8.0, 4.2)  # azimuth and elevation in degrees, distance in metres


def main(page: str = "stances.html") -> None:
    body = standard_body(1.75)
    poses = [solve_stance(body, "posture", 0.0).pose]  # at ease
    for name, entry in SETS.items():
        intensity = entry.high if entry.high > 0.0 else entry.low
        reach_m = THING_M if name.startswith("reach") else None
        stance = solve_stance(body, name, intensity, object_m=THING_M, reach_right_m=reach_m)
        over = f"({stance.com_m[0]:+.2f}, {stance.com_m[1]:+.2f}) m"
        print(f"{name:<20} {intensity:+.0f}  COM over {over}  {entry.meaning}")
        poses.append(stance.pose)

    motion = one_after_the_other([*poses, poses[0]])
    frames = len(motion.root_m)
    person = Person("figure", "male", body, motion, np.full(frames, Phase.PLAY), np.ones((frames, 2), bool))
    footage = Footage("stances", FPS, np.arange(frames) / FPS, (person,), (), ())
    write_atomically(page, html_bytes(footage, CAMERA))
    print(f"{page} shows them in any browser")


def one_after_the_other(poses: list[Pose]) -> Pose:
    """Each pose held for a while, then eased into the next."""
    roots, turns = [np.empty((0, 3))], [np.empty((0, JOINT_COUNT, 4))]
    share = np.linspace(0.0, 1.0, CHANGE_FRAMES, endpoint=False)
    eased = np.concatenate([share**2 * (3.0 - 2.0 * share), np.ones(HELD_FRAMES)])
    for before, after in pairwise(poses):
        roots.append(before.root_m + eased[:, None] * (after.root_m - before.root_m))
        turns.append(rotations.slerp(before.rotations[None], after.rotations[None], eased[:, None]))
    return Pose(np.concatenate(roots), rotations.continuity(np.concatenate(turns)))


if __name__ == "__main__":
    sys.exit(guarded(lambda: main(*sys.argv[1:])))
