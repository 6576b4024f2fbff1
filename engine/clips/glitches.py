"""One- and two-frame glitches of captured motion: found, and bridged from the frames around them.

Where a marker is lost or taken for another, a part of the body leaves its path for a frame or two and comes straight
back. That is told from fast motion by three things, all of which it must have: it is farther from where the frames
around have it than anybody could have gone there and back (GREATEST); it stands out of what that part does just before
and after (STANDS_OUT); and without it the path is smooth at once (SMOOTHER), which a punch that lands or a foot that
strikes, whose velocity stays changed, is not. A bridge is the cubic through two frames on either side, as by the peak
filters of motion-capture tools.

Parts are looked at as they are turned in the world, where markers saw them: a pelvis alone astray turns hips and waist
the other way, and to bridge the one without the others would shake all that hangs on them. Nothing else is touched."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body.skeleton import ELBOWS, JOINT_COUNT, JOINTS, KNEES, PARENT, Pose
from engine.maths import rotations

LONGEST_S, MOST_FRAMES = 0.018, 2
# an excursion counts from this on: of a part's orientation, and of the root's place
LEAST_RAD, LEAST_M = np.radians(4.0), 0.01
# and from what the fastest could do in the time: a kicking knee's, a struck body's
GREATEST_RADPS2, GREATEST_MPS2 = 2000.0, 300.0
STANDS_OUT = 6.0  # times the usual bend of the path there
SMOOTHER, CLEAN = 0.25, 0.02  # what may be left of the bend once it is bridged; what counts as nothing
# what hangs together with a part that is astray, as hips do with a pelvis, is bridged with it from this share on
WITH_IT = 0.25
KEPT_RAD = np.radians(0.25)  # a joint that a bridge turns by less keeps its own rotation
AROUND_S = 0.15  # what "usual" is taken from, on either side
BESIDE = 3  # frames on either side of a glitch that are looked at with it
PREFER_SHORT = 1.5  # a bridge of two frames must leave so many times less of a bend than one of a single frame
ROUNDS = 4  # glitches beside each other hide one another
DOWN = np.array([0.0, 0.0, -1.0])  # along every limb's bones
ROOT = JOINT_COUNT  # the channel after those of the joints
NEXT = np.zeros((ROOT + 1, ROOT + 1), bool)  # which channels hang together: a part and its parent, pelvis and root
NEXT[np.arange(1, ROOT), PARENT[1:]] = NEXT[ROOT, 0] = True
NEXT |= NEXT.T


class Glitch(NamedTuple):
    """Frames first to last, in which these joints were astray; "root" is where the pelvis is."""

    first: int
    last: int
    joints: tuple[str, ...]


class Motion(NamedTuple):
    """F frames as seen in the world."""

    root_m: np.ndarray  # (F, 3)
    turned: np.ndarray  # (F, J, 4)


class Tried(NamedTuple):
    """Bridges of one length, tried at N places."""

    frame: np.ndarray  # (N,) the first that is bridged
    channel: np.ndarray  # (N,) a joint's part, or ROOT
    bridge: np.ndarray  # (N, length, 3) from the frame before: rotation vectors or metres
    excursion: np.ndarray  # (N,) how far the frames are from it, at most
    bend: np.ndarray  # (N,) the greatest second difference in and beside it
    left: np.ndarray  # (N,) the share of that bend that is left once it is bridged


@np.errstate(under="ignore")  # the square of next to no turn is none
def mend_glitches(pose: Pose, fps: float) -> tuple[Pose, list[Glitch]]:
    """The motion (F frames) without its glitches, and what they were, in the order of their frames. The very pose that
    was given where there are none."""
    if len(pose.root_m) <= 2 * BESIDE:
        return pose, []
    motion = Motion(pose.root_m.copy(), _in_world(pose.rotations))
    usual = _usual_bend(_bends(motion), fps)
    frames: set[int] = set()
    for _ in range(ROUNDS):
        windows = _best_apart(motion, usual, fps)
        for first, length in windows:
            _bridge(motion, first, length, usual, fps)
            frames.update(range(first, first + length))
        if not windows:
            break
    return _with_bridges(pose, motion, sorted(frames)) if frames else (pose, [])


def _in_world(local: np.ndarray) -> np.ndarray:
    """World orientations (F, J, 4) of rotations local to parent."""
    turned = local.copy()
    for joint in range(1, JOINT_COUNT):
        turned[:, joint] = rotations.multiply(turned[:, PARENT[joint]], local[:, joint])
    return turned


def _with_bridges(pose: Pose, motion: Motion, frames: list[int]) -> tuple[Pose, list[Glitch]]:
    """The pose with what the bridges changed in these frames, and what that is, frames in a row taken together."""
    turned, own = motion.turned[frames], pose.rotations[frames]
    local = turned.copy()
    local[:, 1:] = rotations.multiply(rotations.conjugate(turned[:, PARENT[1:]]), turned[:, 1:])
    changed = rotations.angle_between(own, local) > KEPT_RAD
    rotated, root_m = pose.rotations.copy(), motion.root_m
    rotated[frames] = np.where(changed[..., None], rotations.normalise(local), own)
    moved = (root_m[frames] != pose.root_m[frames]).any(axis=1)
    glitches = []
    for row in np.split(np.arange(len(frames)), np.flatnonzero(np.diff(frames) > 1) + 1):
        names = [name for j, name in enumerate(JOINTS) if changed[row, j].any()] + ["root"] * bool(moved[row].any())
        glitches.append(Glitch(frames[row[0]], frames[row[-1]], tuple(names)))
    return Pose(root_m, rotations.continuity(rotated)), glitches


def _floors(fps: float) -> np.ndarray:
    """(channels,) the least excursion that counts: an apex of that height takes two frames, there and back."""
    least = np.full(JOINT_COUNT + 1, max(LEAST_RAD, 0.5 * GREATEST_RADPS2 / fps**2))
    least[ROOT] = max(LEAST_M, 0.5 * GREATEST_MPS2 / fps**2)
    return least


def _lengths(fps: float) -> range:
    return range(1, max(1, min(MOST_FRAMES, round(LONGEST_S * fps))) + 1)


def _bends(motion: Motion) -> np.ndarray:
    """(F, channels) how much each path bends at a frame: its second difference, rotation vectors or metres; zero at the
    ends."""
    turned = motion.turned
    steps = rotations.to_rotation_vector(rotations.multiply(rotations.conjugate(turned[:-1]), turned[1:]))
    bends = np.zeros((len(turned), JOINT_COUNT + 1))
    bends[1:-1, :ROOT] = np.linalg.norm(np.diff(steps, axis=0), axis=-1)
    bends[1:-1, ROOT] = np.linalg.norm(np.diff(motion.root_m, 2, axis=0), axis=-1)
    return bends


def _usual_bend(bends: np.ndarray, fps: float) -> np.ndarray:
    """(F, channels) the median bend around each frame, what is near enough to be part of its own glitch left out."""
    reach = max(2 * BESIDE, round(AROUND_S * fps))
    padded = np.pad(bends[1:-1], ((reach + 1, reach + 1), (0, 0)), mode="symmetric")
    offsets = [k for k in range(2 * reach + 1) if abs(k - reach) > BESIDE]
    return np.median([padded[k : k + len(bends)] for k in offsets], axis=0)


def _best_apart(motion: Motion, usual: np.ndarray, fps: float) -> list[tuple[int, int]]:
    """Windows (first frame, length) that are a glitch of some channel, best explained first, none near another."""
    floors, bends, found = _floors(fps), _bends(motion), []
    sharp = np.argwhere(bends > np.maximum(0.9 * floors, STANDS_OUT * usual))
    for length in _lengths(fps):
        # the sharpest bend is at one of the frames that are astray
        places = np.unique(np.concatenate([sharp - [back, 0] for back in range(length)]), axis=0)
        tried = _try(motion, places, length)
        is_one = _stands_out(tried, usual, floors) & (tried.left < SMOOTHER)
        worth = np.maximum(tried.left, CLEAN) * (PREFER_SHORT if length > 1 else 1.0)
        found += [(float(worth[k]), int(tried.frame[k]), length) for k in np.flatnonzero(is_one)]
    apart: list[tuple[int, int]] = []
    for _, first, length in sorted(found):
        if all(first + length + BESIDE <= f or f + n + BESIDE <= first for f, n in apart):
            apart.append((first, length))
    return apart


def _stands_out(tried: Tried, usual: np.ndarray, floors: np.ndarray) -> np.ndarray:
    """(N,) bool: too far to go there and back, and not as the path goes before and after."""
    return (tried.excursion > floors[tried.channel]) & (tried.bend > STANDS_OUT * usual[tried.frame, tried.channel])


def _bridge(motion: Motion, first: int, length: int, usual: np.ndarray, fps: float) -> None:
    """Bridges every channel that is astray in this window, in place."""
    places = np.stack([np.full(ROOT + 1, first), np.arange(ROOT + 1)], axis=1)
    tried = _try(motion, places, length)
    itself = _stands_out(tried, usual, _floors(fps)) & (tried.left < SMOOTHER)
    with_it = _stands_out(tried, WITH_IT * usual, WITH_IT * _floors(fps)) & (tried.left < 1.0)
    astray = itself
    for _ in range(ROOT):
        astray = astray | (with_it & (NEXT & astray).any(axis=1))
    frames = slice(first, first + length)
    for channel in np.flatnonzero(astray):
        if channel == ROOT:
            motion.root_m[frames] = motion.root_m[first - 1] + tried.bridge[channel]
        else:
            turn = rotations.from_rotation_vector(tried.bridge[channel])
            motion.turned[frames, channel] = rotations.multiply(motion.turned[first - 1, channel], turn)
    for hinge in (*ELBOWS, *KNEES):
        if astray[[hinge, PARENT[hinge]]].any():
            _keep_hinge(motion.turned, first, length, hinge)


def _keep_hinge(turned: np.ndarray, first: int, length: int, joint: int) -> None:
    """Swings a bridged forearm or shin the least that has it bend as far out of its hinge's plane, normal to Y, as in
    the frames beside: bones bridged one by one leave it a little. turned (F, J, 4) in place."""
    upper = turned[first - 1 : first + length + 1, PARENT[joint]]
    lower = turned[first - 1 : first + length + 1, joint]
    bone = rotations.unrotate(upper, rotations.rotate(lower, DOWN))
    inside = np.arange(1, length + 1)
    aside = np.interp(inside, [0, length + 1], bone[[0, -1], 1])
    wanted = bone[inside] * [1.0, 0.0, 1.0]
    wanted *= np.sqrt((1.0 - aside**2) / np.sum(wanted**2, axis=1))[:, None]
    wanted[:, 1] = aside
    swing = rotations.between(bone[inside], wanted)
    local = rotations.multiply(rotations.conjugate(upper[inside]), lower[inside])
    turned[first : first + length, joint] = rotations.multiply(upper[inside], rotations.multiply(swing, local))


def _try(motion: Motion, places: np.ndarray, length: int) -> Tried:
    """What bridges over `length` frames would come to at places (N, 2) of first frame and channel; those too near the
    clip's ends are left out."""
    enough = (places[:, 0] >= BESIDE) & (places[:, 0] + length + BESIDE <= len(motion.root_m))
    frame, channel = places[enough].T
    path = _path(motion, frame, channel, length)
    inside = slice(BESIDE, BESIDE + length)
    ends = path[[BESIDE - 2, BESIDE - 1, BESIDE + length, BESIDE + length + 1]]
    bridge = np.einsum("te,enc->tnc", _cubic(length), ends)
    excursion = np.linalg.norm(path[inside] - bridge, axis=-1).max(axis=0, initial=0.0)
    bend = _sharpest(path)
    path[inside] = bridge
    left = _sharpest(path) / np.maximum(bend, 1e-12)
    return Tried(frame, channel, np.moveaxis(bridge, 0, 1), excursion, bend, left)


def _path(motion: Motion, frame: np.ndarray, channel: np.ndarray, length: int) -> np.ndarray:
    """(BESIDE + length + BESIDE, N, 3) the paths in and beside windows, from the frame before each."""
    frames = frame + np.arange(-BESIDE, length + BESIDE)[:, None]
    of_root, joint = channel == ROOT, np.minimum(channel, ROOT - 1)
    before = rotations.conjugate(motion.turned[frame - 1, joint])
    turned = rotations.to_rotation_vector(rotations.multiply(before, motion.turned[frames, joint]))
    return np.where(of_root[:, None], motion.root_m[frames] - motion.root_m[frame - 1], turned)


def _cubic(length: int) -> np.ndarray:
    """(length, 4) the weights of two frames before and two after in the cubic between them (Lagrange)."""
    at = np.array([-2.0, -1.0, length, length + 1.0])
    return np.array([
        [np.prod([(t - b) / (a - b) for b in at if b != a]) for a in at] for t in range(length)
    ])  # fmt: skip


def _sharpest(path: np.ndarray) -> np.ndarray:
    """(N,) the greatest second difference along paths (K, N, 3)."""
    return np.linalg.norm(np.diff(path, 2, axis=0), axis=-1).max(axis=0, initial=0.0)
