"""The degrees of freedom that stances move (section 3, figure 3): six at the root and forty-two at the joints.

The skeleton's joints allow more, because clips use more; what `solve` makes keeps to these. The paper's axes: X bends
forward, Y turns to the left, Z bends to the right. The ankle's two are a turn about X, then one about Z.
"""

from __future__ import annotations

from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    KNEES,
    NECK,
    SHOULDERS,
    WAIST,
    WRISTS,
)

ROOT = 6  # place and orientation of the pelvis
# joint: the paper's name, its axes. The elbow's Y is the turn of the forearm
FREEDOMS = {
    WAIST: ("abdomen", "XYZ"),
    BACK: ("chest", "XYZ"),
    NECK: ("neck", "XYZ"),
    HEAD: ("head", "XYZ"),
    **dict.fromkeys(CLAVICLES, ("collar bone", "YZ")),
    **dict.fromkeys(SHOULDERS, ("shoulder", "XYZ")),
    **dict.fromkeys(ELBOWS, ("elbow, forearm", "XY")),
    **dict.fromkeys(WRISTS, ("wrist", "XZ")),
    **dict.fromkeys(HIPS, ("hip", "XYZ")),
    **dict.fromkeys(KNEES, ("knee", "X")),
    **dict.fromkeys(ANKLES, ("ankle", "XZ")),
}


def count() -> int:
    """All degrees of freedom."""
    return ROOT + sum(len(axes) for _, axes in FREEDOMS.values())
