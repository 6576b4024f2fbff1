"""What the world knows about characters and threats: every column of state that the systems read and write.

One row a character or a ball. Poses are kept as `root_m` (3,) and `rotations` (21, 4), see `engine.body.skeleton.Pose`.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from engine.body.overlap import PAIRS
from engine.body.skeleton import JOINT_COUNT
from engine.core.world import Component, column
from engine.physics.layout import SHAPES, STATE_SIZE, SUB_STEPS

NOBODY = -1


class Phase(IntEnum):
    """The regions of fig. 4.1, by the names that reports use."""

    PLAY = 0
    STARTLE = 1
    PROTECT = 2
    HOLD = 3  # the threat never arrived
    RESPOND = 4
    RECOVER_BLEND = 5  # part one: simulation into the sustained pose
    RECOVER_RETURN = 6  # part two: on to the return pose
    DOWN = 7  # knocked off the feet: the body stays with the physics
    STOPPED = 8  # its state was no number any more: stands still as it last was


class Playback(Component):
    """The clip that a character plays, and where its path lies in the world."""

    clip = column(dtype=np.int64)  # row of world.assets.clips
    offset_s = column()  # clip time at tick 0, at its own pace: time = offset + tick / 120
    own_pace = column()  # the tick from which on it has that: after a reaction it is taken up slowly
    place_m = column(2)  # the clip's origin in the world
    heading_rad = column()  # and the clip's yaw there


class Posture(Component):
    """The pose shown now and the one shown a tick ago (drawing runs between them; velocities come from them)."""

    root_m = column(3)
    rotations = column(JOINT_COUNT, 4)
    before_root_m = column(3)
    before_rotations = column(JOINT_COUNT, 4)


class Character(Component):
    """Who this is and what makes them react as they do."""

    body = column(dtype=np.int64)  # row of world.assets.bodies
    startle = column(dtype=bool)
    protects = column(dtype=bool)  # without it nothing is noticed, and balls are aimed at who goes on
    response_s = column()
    boldness = column()  # -1 timid ... +1 bold
    turn_side = column(dtype=np.int64)  # the side last turned to: kept when a threat comes from dead ahead


class Reaction(Component):
    """Where a character is on fig. 4.1."""

    phase = column(dtype=np.int64)
    since = column(dtype=np.int64)  # the tick at which this phase began
    perceived = column(dtype=np.int64)  # tick of perception
    contact = column(dtype=np.int64)  # tick at which contact is expected
    threat = column(dtype=np.int64)  # handle of the ball perceived, or NOBODY
    clip_s = column()  # clip time at perception
    struck = column(dtype=bool)
    flinches = column(dtype=bool)  # startles at what passes close, and does no more


class Blend(Component):
    """The two still ends of the blend that runs now, and its clock (thesis 4.3)."""

    from_root_m = column(3)
    from_rotations = column(JOINT_COUNT, 4)
    to_root_m = column(3)
    to_rotations = column(JOINT_COUNT, 4)
    lead_s = column()  # of a way back: so much of the clip is played on the way, up to the second end; 0: that is still
    since = column(dtype=np.int64)
    ticks = column()  # how long it lasts; not whole, since slack stretches it
    lands = column(dtype=np.int64)  # up to this tick of protection the first end flies on as the clip does, then lands
    support = column(dtype=np.int64)  # the primary support foot: side 0 or 1, or NOBODY: both ends lie
    modes = column(2, dtype=np.int64)  # left, right: how the arms go, see `behaviours.blends.arm_ways`,
    bends = column(2, 2, 4)  # and how far their ways are bent, radians
    first_modes = column(2, dtype=np.int64)  # likewise in part one of recovery, from the simulation into this blend
    first_bends = column(2, 2, 4)
    knees_m = column(2, 3)  # where the knees were at the last tick


class Sustained(Component):
    """The protective pose in force, and what it was made from."""

    root_m = column(3)
    rotations = column(JOINT_COUNT, 4)
    rules_root_m = column(3)
    rules_rotations = column(JOINT_COUNT, 4)
    controls = column(7)
    com_wanted_m = column(2)
    case = column(dtype=np.int64)
    held = column(2, dtype=bool)  # the feet that stand in it


class Ragdoll(Component):
    """The physics of a character that was struck: MuJoCo's whole integration state."""

    state = column(STATE_SIZE)
    before = column(STATE_SIZE)  # a tick earlier
    head_mps = column(SUB_STEPS, 3)  # velocity of the head at the sub-steps of the last tick
    sunk_m = column(SHAPES)  # how deep each of its shapes may lie in the floor
    arriving = column(2, JOINT_COUNT, 3)  # turns beyond the sustained pose when it was taken over, and their velocities
    half_life_s = column(JOINT_COUNT)  # of those
    taken = column(dtype=np.int64)  # the tick of that
    stepped = column(dtype=np.int64)  # the tick that the state is of
    active = column(dtype=bool)


SAMPLES, STRIDE_TICKS = 5, 2  # of a window of motion, and from one to the next
WINDOW_TICKS = (SAMPLES - 1) * STRIDE_TICKS + 2  # velocities need one more tick


class Struck(Component):
    """The last moments under the physics, for the search of a motion that goes on from there."""

    recover = column(dtype=np.int64)  # Recover
    joints_m = column(WINDOW_TICKS, JOINT_COUNT, 3)  # at the last ticks, the latest first
    count = column(dtype=np.int64)  # how many of them there are since the blow
    played = column(dtype=np.int64)  # row of world.assets.clips: what was played before the blow
    rests = column(dtype=np.int64)  # ticks for which a body that is down has lain still
    said = column(dtype=bool)  # that it stays down
    impulse_Ns = column(3)  # all that has been dealt since the response began
    com_mps = column(3)  # how the body as a whole moved when it began


class Recover(IntEnum):
    """What a character goes back to."""

    SAME = 0
    NEW = 1
    AUTO = 2


class Blow(Component):
    """A blow that is being dealt to a character: an impulse on its way, over the time that the ball presses."""

    ball = column(dtype=np.int64)  # handle, or NOBODY
    joint = column(dtype=np.int64)
    place_m = column(3)  # in the joint's frame
    impulse_Ns = column(3)  # on the body, all of it, world
    turning_Nms = column(3)  # on the ball, about its centre, world
    normal = column(3)  # from the body to the ball
    elapsed_s = column()  # since contact, also after it is over
    lasts_s = column()


class Feet(Component):
    """What each foot is about: it goes with the pose, is held where it stands, or makes one step. Axis 0 is left,
    right.
    """

    mode = column(2, dtype=np.int64)  # FootMode
    ankle_m = column(2, 3)  # held here, or stepping to here
    turned = column(2, 4)  # the ankle's orientation in the world, likewise
    toe = column(2, 4)  # the toe's rotation in the ankle's frame, likewise
    from_m = column(2, 3)  # a step begins here
    from_turned = column(2, 4)
    from_toe = column(2, 4)
    from_down = column(2)  # 1 where it stood when the step was planned, else 0
    lift_m = column(2)
    since = column(2, dtype=np.int64)
    ticks = column(2)
    goes_on = column(2, dtype=bool)  # its step ends where the clip's foot is by then, and as fast as that moves
    planted = column(2, dtype=bool)  # flagged: stands, and must not slide


class FootMode(IntEnum):
    FREE = 0
    HELD = 1
    STEPPING = 2


class Residual(Component):
    """What is left of the motion before the last seam: offsets to the pose that die away (inertialisation).

    Offsets and their velocities as they were at tick `since`: root (3,), every joint as a rotation vector (21, 3), both
    ankles' places and turns (2, 3) each.
    """

    since = column(dtype=np.int64)
    root = column(2, 3)  # offset, velocity
    joints = column(2, JOINT_COUNT, 3)
    beyond = column(2, JOINT_COUNT, 3)  # how far the old pose was beyond its limits drawn in, radians; how fast it went
    ankles = column(2, 2, 3)
    ankle_turns = column(2, 2, 3)
    stretch = column(2, 2)  # how much longer either leg was than the source's,
    deeper_m = column(len(PAIRS))  # and how much deeper arms were in the body, for each of `engine.body.overlap.PAIRS`


class Flight(Component):
    """A ball: it flies, spins, bounces on the floor and off people."""

    kind = column(dtype=np.int64)  # row of behaviours.perceive.threats.KINDS
    position_m = column(3)
    velocity_mps = column(3)
    spin_radps = column(3)
    turned = column(4)
    before_m = column(3)
    before_turned = column(4)
    radius_m = column()
    mass_kg = column()
    drag_per_m = column()
    restitution = column()  # off the floor; off people it is the settings'
    friction = column()
    held = column(dtype=bool)  # pressed against a body just now: it moves with the contact
    rested = column(dtype=np.int64)  # ticks for which it has lain still, or been far from everybody


class Threat(Component):
    """What a ball means to the character that it comes at."""

    at = column(dtype=np.int64)  # handle of the character
    aim = column(dtype=np.int64)  # row of behaviours.perceive.perceived.AIMS
    contact = column(dtype=np.int64)  # tick at which it is expected to arrive
    line_m = column(3)  # a point of its line of approach: where its centre is expected to be then
    tangent = column(3)  # unit, of its path there
    travel = column(3)  # unit, D: from where it was perceived to its target
    speed_norm = column()
    size_norm = column()
    scripted = column(dtype=bool)
    noticed = column(dtype=bool)  # it has been perceived
    taken_up = column(dtype=bool)  # and the character has decided about it
    spent = column(dtype=bool)  # has struck, or gone past
    passes = column(dtype=bool)  # it was noticed, but will only come close
    strayed = column(dtype=bool)  # something has turned it off its line


class Script(Component):
    """A threat of the scenario that has not been launched yet."""

    spec = column(dtype=np.int64)  # row of world.assets.threats


COMPONENTS = (
    Playback,
    Posture,
    Character,
    Reaction,
    Blend,
    Sustained,
    Ragdoll,
    Struck,
    Blow,
    Feet,
    Residual,
    Flight,
    Threat,
    Script,
)
