"""The same motion on another body: every rotation kept, the path scaled to the new legs, the feet on the floor.

Lengths along the ground and heights over the floor go with the length of the legs, so a stride stays a stride; what is
lowest (a sole, a knee, a back) decides how high the body is, so the leg that carries it keeps its bend. Then each foot
is put, by leg IK, where the old one was on that scale: its ball over the same place, its lowest sole point at the same
height. So a foot that stood still stands still, and one that touched the floor touches it, heel, flat or toe."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np

from engine.body.anthropometry import stature_m
from engine.body.footing import drop_to_reach, leg_length_m, lowest_m
from engine.body.kinematics import joints_into
from engine.body.limb_ik import apply_leg, leg_swivel
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, TOES, Body, Pose
from engine.body.support import sole_points
from engine.clips.clip import Clip
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

KNEELING, CROUCHING = 0.12, 0.35  # a knee's height in shares of the leg: it bears weight, or the foot alone does


def retarget_clip(clip: Clip, body: Body) -> Clip:
    """The clip as somebody with this body would move; the clip itself if it is theirs already."""
    if same_body(clip.body, body):
        return clip
    root_m, local = np.empty_like(clip.pose.root_m), np.array(clip.pose.rotations)
    retarget_frames(clip.body, body, np.ascontiguousarray(clip.pose.root_m), root_m, local)
    scale = legs_m(body) / legs_m(clip.body)
    return replace(
        clip,
        pose=Pose(root_m, local),
        body=body,
        loop=clip.loop._replace(x_m=clip.loop.x_m * scale, y_m=clip.loop.y_m * scale),
        report=replace(
            clip.report,
            leg_length_m=clip.report.leg_length_m * scale,
            height_m=stature_m(body.offset_m),
            notes=[*clip.report.notes, f"moved to another body, {scale:.3f} of its own legs"],
        ),
        key=hashlib.sha256(f"retargeted {clip.key} {content_of(body)}".encode()).hexdigest(),
    )


def same_body(a: Body, b: Body) -> bool:
    """Whether two bodies are equal to the last bit."""
    return all(np.array_equal(x, y) for x, y in zip(a, b, strict=True))


def content_of(body: Body) -> str:
    """A name for a body's numbers."""
    content = hashlib.sha256()
    for value in body:
        content.update(np.ascontiguousarray(value).tobytes())
    return content.hexdigest()


def legs_m(body: Body) -> float:
    """Hip to ankle of the straight legs, on average."""
    return 0.5 * float(leg_length_m(body, 0) + leg_length_m(body, 1))


@njit(cache=True)
def retarget_frames(old, new, old_root_m, root_m, rotations):
    """Writes the new root (F, 3), and moves the legs of rotations (F, J, 4), given as the old body's, in place."""
    old_at, at = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 3))
    old_turned, turned = np.empty((JOINT_COUNT, 4)), np.empty((JOINT_COUNT, 4))
    ankles_m = np.empty((2, 3))
    scale = (leg_length_m(new, 0) + leg_length_m(new, 1)) / (leg_length_m(old, 0) + leg_length_m(old, 1))
    for f in range(len(root_m)):
        joints_into(old.offset_m, old_root_m[f], rotations[f], old_at, old_turned)
        root_m[f] = 0.0
        joints_into(new.offset_m, root_m[f], rotations[f], at, turned)
        for k in range(2):
            hips, own = old_at[HIPS[0], k] + old_at[HIPS[1], k], at[HIPS[0], k] + at[HIPS[1], k]
            root_m[f, k] = 0.5 * (scale * hips - own)
        root_m[f, 2] = scale * lowest_m(old, old_at, old_turned) - lowest_m(new, at, turned)
        joints_into(new.offset_m, root_m[f], rotations[f], at, turned)
        ankle_goals(old, new, scale, old_at, old_turned, at, turned, ankles_m)
        put_feet(new, ankles_m, root_m[f], rotations[f], at, turned)


@inner_kernel
def ankle_goals(old, new, scale, old_at, old_turned, at, turned, ankles_m):
    """Where the new ankles have to be, (2, 3): ball over its scaled place, lowest sole point at its scaled height.

    The new feet are turned as the old ones, so all that is asked of them is where they are now. As a knee comes down to
    the floor, its leg goes over to keeping its rotations, which keep the knee there."""
    old_soles, soles = sole_points(old, old_at, old_turned), sole_points(new, at, turned)
    legs = leg_length_m(old, 0)
    for side in range(2):
        ankle, toe = ANKLES[side], TOES[side]
        shift = (
            scale * old_at[toe, 0] - at[toe, 0],
            scale * old_at[toe, 1] - at[toe, 1],
            scale * old_soles[side, :, 2].min() - soles[side, :, 2].min(),
        )
        up = (old_at[KNEES[side], 2] / legs - KNEELING) / (CROUCHING - KNEELING)
        up = min(max(up, 0.0), 1.0)
        for k in range(3):
            ankles_m[side, k] = at[ankle, k] + up * up * (3.0 - 2.0 * up) * shift[k]


@inner_kernel
def put_feet(body, ankles_m, root_m, rotations, positions, orientations):
    """Leg IK of both legs onto their ankle goals, feet turned as they are; the pelvis sinks for a leg too short."""
    drop = 0.0
    for side in range(2):
        drop = max(drop, drop_to_reach(body, positions[HIPS[side]], ankles_m[side], side))
    root_m[2] -= drop
    for j in range(JOINT_COUNT):
        positions[j, 2] -= drop
    for side in range(2):
        foot = orientations[ANKLES[side]]
        turned = quaternion.normalise((foot[0], foot[1], foot[2], foot[3]))
        swivel = leg_swivel(positions, orientations, side)
        apply_leg(body, rotations, positions, orientations, side, ankles_m[side], turned, swivel, 0.0)
