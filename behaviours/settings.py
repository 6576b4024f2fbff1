"""Every constant of the anticipation model, in one place: named, with its default, unit and section.

The numbers are those of Hermens, *Anticipating Impacts* (2006); a section like 3.2.5 or a table is the thesis's, one
like A4 is the project's specification, which settles what the thesis leaves open. A group is a NamedTuple of plain
numbers, so that a kernel takes it whole. Radians inside; `behaviours.overriding` changes constants by name.
"""

from __future__ import annotations

from math import radians
from typing import Annotated, NamedTuple


class Constant(NamedTuple):
    """What a field means: its unit, the section it comes from, and a sentence."""

    unit: str
    section: str
    meaning: str


Triple = tuple[float, float, float]


def _xyz_deg(x: float, y: float, z: float) -> Triple:
    """Greatest rotations about X, Y, Z, written in the degrees of table 3.2."""
    return (radians(x), radians(y), radians(z))


class LeanTurn(NamedTuple):
    """Lean and turn away (3.2.2, 3.2.3): greatest rotations of the upper half of table 3.2."""

    neck_rad: Annotated[Triple, Constant("rad", "table 3.2", "neck, about X, Y, Z")] = _xyz_deg(50, 50, 65)
    back_rad: Annotated[Triple, Constant("rad", "table 3.2", "back")] = _xyz_deg(25, 25, 8)
    waist_rad: Annotated[Triple, Constant("rad", "table 3.2", "waist")] = _xyz_deg(10, 10, 12)
    pelvis_rad: Annotated[Triple, Constant("rad", "table 3.2", "pelvis")] = _xyz_deg(15, 15, 20)
    back_share: Annotated[float, Constant("1", "3.2.3", "of the turn that the neck leaves over")] = 0.5
    waist_share: Annotated[float, Constant("1", "3.2.3", "of the turn that the neck leaves over")] = 0.3
    pelvis_share: Annotated[float, Constant("1", "3.2.3", "of the turn that the neck leaves over")] = 0.2
    dead_ahead_rad: Annotated[float, Constant("rad", "A3.2", "azimuths below this keep the side last chosen")] = (
        radians(2)
    )


class Recoil(NamedTuple):
    """Recoil and startle (3.2.4, 3.2.6): greatest rotations of the lower half of table 3.2, as magnitudes."""

    clavicle_rad: Annotated[Triple, Constant("rad", "table 3.2", "raises (X) and brings forward (Y)")] = _xyz_deg(
        35, 25, 0
    )
    shoulder_rad: Annotated[Triple, Constant("rad", "table 3.2", "lifts the upper arm sideways (X)")] = _xyz_deg(
        30, 0, 0
    )
    elbow_rad: Annotated[Triple, Constant("rad", "table 3.2", "flexes (Y)")] = _xyz_deg(0, 150, 0)


class Block(NamedTuple):
    """Block (3.2.5): where the palms go, and the elbows."""

    reach_far_m: Annotated[float, Constant("m", "3.2.5", "palm from its own shoulder, control 0")] = 0.9
    reach_near_m: Annotated[float, Constant("m", "3.2.5", "palm from its own shoulder, control 1")] = 0.3
    arm_share: Annotated[float, Constant("1", "A3.4", "of the arm's length that the far reach may use")] = 0.97
    clearance_m: Annotated[float, Constant("m", "A3.4", "palm from the target, along the line, at least")] = 0.20
    offset_m: Annotated[float, Constant("m", "A3.4", "each palm to its own side of the line")] = 0.08
    offset_fade: Annotated[
        float, Constant("1", "A3.4", "cosine, shoulders to across the line, below which the offset fades")
    ] = 0.1
    swivel_small_rad: Annotated[float, Constant("rad", "3.2.5", "elbow away from down, control 0")] = radians(70)
    swivel_large_rad: Annotated[float, Constant("rad", "3.2.5", "elbow away from down, control 1")] = radians(10)
    fingers_up_until: Annotated[
        float, Constant("1", "A3.4", "cosine, arm to straight down, up to which fingers point up")
    ] = 0.3
    fingers_down_from: Annotated[float, Constant("1", "A3.4", "and from which on they point down and inwards")] = 0.85
    fingers_down_rad: Annotated[float, Constant("rad", "A3.4", "how far from up that is, going round inwards")] = (
        radians(150)
    )
    fingers_apart_m: Annotated[
        float, Constant("m", "A3.4", "added to each palm's offset where fingers point at each other")
    ] = 0.06
    soften_m: Annotated[float, Constant("m", "A3.4", "width over which reach, clearance and plane meet")] = 0.02


class Wrap(NamedTuple):
    """A threat from behind the shoulders (3.4, fig. 3.11): hands behind the head, elbows around its sides."""

    behind_low: Annotated[float, Constant("1", "A5", "facing . threat at and below which the arms wrap fully")] = -0.15
    behind_high: Annotated[float, Constant("1", "A5", "facing . threat at and above which they block fully")] = 0.15
    palm_gap_m: Annotated[
        float, Constant("m", "3.4", "skin of the hand off the head: it gives way before the head does")
    ] = 0.03
    palm_aside_rad: Annotated[
        float, Constant("rad", "3.4", "each palm from the middle of the head's back to its own side")
    ] = radians(40)
    follow_rad: Annotated[
        float, Constant("rad", "A5", "how far the hands follow a threat around the head, at most")
    ] = radians(30)
    palm_below_m: Annotated[float, Constant("m", "3.4", "palms below the head's centre")] = 0.0
    fingers_inward_rad: Annotated[float, Constant("rad", "3.4", "fingers from upright towards each other")] = radians(
        65
    )
    elbow_aside_rad: Annotated[float, Constant("rad", "3.4", "elbows from straight ahead to their sides")] = radians(45)
    beside_aside_rad: Annotated[
        float, Constant("rad", "A5", "on the way from block to wrap: palms from the middle of the head's back")
    ] = radians(115)
    beside_fingers_inward_rad: Annotated[float, Constant("rad", "A5", "and their fingers from upright")] = radians(15)
    beside_elbow_aside_rad: Annotated[float, Constant("rad", "A5", "and elbows from straight ahead")] = radians(20)


class Pelvis(NamedTuple):
    """A threat to the pelvis (3.4, fig. 3.12): arms kept close, the pelvis alone leans, towards the threat."""

    reach_far_m: Annotated[float, Constant("m", "3.4", "palm from its own shoulder, control 0")] = 0.5
    reach_near_m: Annotated[float, Constant("m", "3.4", "palm from its own shoulder, control 1")] = 0.4
    lean_sign: Annotated[float, Constant("1", "3.4", "the pelvis's lean is negated")] = -1.0


class Startle(NamedTuple):
    """Startle (3.2.6): the reflex before the considered defence."""

    recoil_weight: Annotated[float, Constant("1", "3.2.6", "weight of the full recoil pose; the clip has the rest")] = (
        0.2
    )
    head_turn_share: Annotated[float, Constant("1", "3.2.6", "of the way the head turns towards the threat")] = 0.4
    least_sustained_s: Annotated[
        float, Constant("s", "A3", "skipped when less would be left for the sustained blend")
    ] = 0.15


class Balance(NamedTuple):
    """Static balance and bracing (3.3), and how the feet are planted for it."""

    brace_m: Annotated[float, Constant("m", "3.3", "COM wanted this far towards the threat")] = 0.10
    leg_share: Annotated[float, Constant("1", "A4", "of a leg's length that planting may use")] = 0.99
    lower_for_foot_m: Annotated[
        float, Constant("m", "A4", "the pelvis goes at most this much down to put a foot on the ground")
    ] = 0.06
    lift_over_m: Annotated[float, Constant("m", "A4", "a foot that moves farther is lifted on an arc")] = 0.03
    lift_height_m: Annotated[float, Constant("m", "A4", "height of that arc")] = 0.05
    step_s: Annotated[
        float, Constant("s", "A4", "a step takes this long where legs reach: nobody waits on one leg")
    ] = 0.4
    limit_margin_rad: Annotated[
        float, Constant("rad", "A", "hips, ankles and shoulders keep this far inside their limits")
    ] = radians(0.5)
    foot_tolerance_m: Annotated[float, Constant("m", "A4", "planted feet end where they were planted within this")] = (
        1e-4
    )


class Objective(NamedTuple):
    """The total error (3.3, eq. 3.3) as the solver sees it: `squares` (A4), the thesis's `literal` sum, or it
    `smoothed`.
    """

    form: Annotated[str, Constant("name", "A4", "squares | literal | smoothed")] = "squares"
    balance_weight: Annotated[float, Constant("1", "A4", "weight of the COM's distance")] = 5.0
    hands_weight: Annotated[float, Constant("1", "A4", "weight of each palm's distance")] = 1.0
    torso_weight: Annotated[float, Constant("1", "A4", "weight of sin(half angle): pelvis, waist, back")] = 1.0
    pelvis_height_weight: Annotated[float, Constant("1", "A4", "weight of the pelvis's height")] = 1.0
    feet_weight: Annotated[float, Constant("1", "A4", "weight of each foot's distance")] = 5.0
    control_weight: Annotated[float, Constant("1", "A4", "weight of each control's change")] = 0.1
    limits_weight: Annotated[float, Constant("1/rad", "A", "weight of what joint limits forbid each leg")] = 3.0
    outside_weight: Annotated[float, Constant("1", "A4", "weight of a control's excess over [0, 1]")] = 1.0
    smoothing_m: Annotated[float, Constant("m", "A4", "rounding of the smoothed form's norms")] = 0.01


class Solver(NamedTuple):
    """The quasi-Newton search (3.3) and its bounded least-squares companion."""

    method: Annotated[str, Constant("name", "A4", "bfgs | least_squares")] = "bfgs"
    offset: Annotated[float, Constant("m or 1", "3.3", "finite difference to either side")] = 0.01
    tolerance: Annotated[float, Constant("1", "A4", "relative decrease that ends the search")] = 1e-4
    iterations: Annotated[int, Constant("count", "A4", "at most")] = 60
    restarts: Annotated[
        int, Constant("count", "A4", "BFGS begins again with fresh curvature, while that still gains")
    ] = 0
    polish: Annotated[
        bool, Constant("yes/no", "A4", "least squares goes on from where BFGS ends (squares form only)")
    ] = True
    polish_tolerance: Annotated[float, Constant("1", "A4", "relative decrease that ends least squares")] = 1e-5


class Timing(NamedTuple):
    """When things happen (4.2, fig. 4.1)."""

    ttc_model: Annotated[str, Constant("name", "A6", "equation | text: which of the thesis's two accounts")] = (
        "equation"
    )
    ttc_least_s: Annotated[float, Constant("s", "eq. 4.1", "time to contact of the fastest threat")] = 0.25
    ttc_range_s: Annotated[float, Constant("s", "eq. 4.1", "added for the slowest")] = 0.75
    ttc_side_gain: Annotated[float, Constant("1", "eq. 4.1", "more time from the side")] = 0.2
    ttc_side_gain_text: Annotated[float, Constant("1", "4.2", "the same, where the text rules")] = 0.1
    angle_free: Annotated[bool, Constant("yes/no", "A6", "from the side: start earlier, move no slower")] = False
    startle_ahead_s: Annotated[float, Constant("s", "4.2", "look-ahead into the clip, startle")] = 1.0 / 12.0
    sustained_ahead_s: Annotated[
        float, Constant("s", "4.2", "look-ahead into the clip, sustained pose and re-entry")
    ] = 1.0 / 6.0
    startle_s: Annotated[float, Constant("s", "4.2", "the blend to the startle pose")] = 15.0 / 120.0
    slack_share: Annotated[float, Constant("1", "4.2", "how much longer than the TTC the blend takes")] = 0.05


class Temper(NamedTuple):
    """What boldness does to a threat as it is felt (S9)."""

    size_share: Annotated[
        float, Constant("1", "S9", "a timid character takes it for this much larger, a bold one smaller")
    ] = 0.5
    speed_share: Annotated[float, Constant("1", "S9", "and for this much faster: it leans farther away")] = 0.65


class Threats(NamedTuple):
    """How scripted threats are flown back from contact (3.1)."""

    low_path: Annotated[
        str, Constant("name", "A1", "raise | shorten: the elevation or the time, where the path would be under ground")
    ] = "raise"


class Senses(NamedTuple):
    """How a free threat is noticed (A6)."""

    horizon_s: Annotated[float, Constant("s", "A6", "how far ahead a flight is predicted")] = 1.6
    hit_within_m: Annotated[
        float, Constant("m", "A6", "skin of the ball to the middle of head, torso or pelvis: less is a hit")
    ] = 0.28
    flinch_within_m: Annotated[
        float, Constant("m", "A6", "farther than a hit but within this: it startles, and no more")
    ] = 0.50
    strayed_m: Annotated[
        float, Constant("m", "A6", "a ball that will pass this far off its line is not coming any more")
    ] = 0.40
    gone_m: Annotated[float, Constant("m", "A6", "a ball that goes away beyond this is no threat any more")] = 1.0


class Blend(NamedTuple):
    """Moving between two poses (4.3)."""

    overshoot_share: Annotated[float, Constant("1", "A6", "amplitude of the damped overshoot that fills a pause")] = (
        0.06
    )
    overshoot_period_s: Annotated[float, Constant("s", "A6", "its period")] = 0.5
    overshoot_half_life_s: Annotated[float, Constant("s", "A6", "its half-life")] = 0.12
    knee_rule: Annotated[
        str, Constant("name", "4.3, A7", "ends | least: knees go from end to end, or move least since the last frame")
    ] = "ends"
    seam_half_life_s: Annotated[float, Constant("s", "A7", "half-life of what a seam leaves over")] = 0.07


class Response(NamedTuple):
    """The dynamic response (4.1.2; Zordan et al. 2005).

    Inflated balls dropped on a hard floor return with 0.75 - 0.8 of their speed (normal drop tests as of Haron and
    Ismail 2012) and lose more the faster they come, a soccer ball at 25 m/s another 0.1 (Price, Jones and Harland
    2006); flesh takes its part. Hollow balls grip at almost every angle: friction 0.5 and up (Cross 2014, Oblique
    bounce of a ball).
    """

    restitution: Annotated[float, Constant("1", "A8", "ball against body")] = 0.55
    friction: Annotated[float, Constant("1", "A8", "ball against body")] = 0.5
    contact_s: Annotated[float, Constant("s", "A8", "how long the ball presses, half a sine; 0 is an instant")] = 0.010
    least_Ns: Annotated[float, Constant("N s", "A8", "a weaker touch turns the ball away and moves nobody")] = 0.4
    least_mps: Annotated[
        float, Constant("m/s", "A8", "so does a slower one, or a ball that lies on somebody holds them down")
    ] = 1.0
    longest_s: Annotated[float, Constant("s", "A8", "physics alone, at most, however heavy the blow")] = 0.4
    reel_over_mps: Annotated[
        float, Constant("m/s", "A8", "a blow that gives the whole body more than this is left to the physics longer")
    ] = 0.2
    reel_s_per_mps: Annotated[float, Constant("s per m/s", "A8", "by so much")] = 0.2
    quiet_s: Annotated[float, Constant("s", "A8", "control comes back no sooner than this after the last contact")] = (
        0.04
    )
    fall_share: Annotated[float, Constant("1", "A8", "how far a falling body goes from its pose to that of a fall")] = (
        0.8
    )
    falling_share: Annotated[float, Constant("1", "A8", "of that strength that is left while falling")] = 0.7
    down_share: Annotated[float, Constant("1", "A8", "and once it lies")] = 0.05
    arrives_half_life_s: Annotated[
        float, Constant("s", "A8", "half-life of the movement that the blow has cut short")
    ] = 0.15
    stiffness: Annotated[float, Constant("1", "A8", "strength of the tracking servos, 1 is usual")] = 1.0
    damping: Annotated[float, Constant("1", "A8", "their damping, 1 is critical")] = 1.0


class Recovery(NamedTuple):
    """Back to a meaningful motion (4.1.3)."""

    part_one_s: Annotated[float, Constant("s", "4.2", "simulation blends into the held sustained pose")] = 0.260
    part_two_s: Annotated[float, Constant("s", "4.2", "the rest of the way to the return pose")] = 0.375
    lead_s: Annotated[
        float, Constant("s", "A7", "of the clip, played on the way back to it: it takes twice that to its own pace")
    ] = 0.15
    part_one_share: Annotated[float, Constant("1", "4.1.3", "of the return blend that is over after part one")] = 0.25
    hold_s: Annotated[float, Constant("s", "4.2", "the sustained pose is held when nothing was touched")] = 1.0 / 3.0
    land_within_s: Annotated[
        float, Constant("s", "A6", "where no foot stands at re-entry: the clip's next landing, if it comes within this")
    ] = 0.6
    capture_beyond_m: Annotated[float, Constant("m", "A8", "capture point this far outside the feet: knocked down")] = (
        0.45
    )
    fallen_hip_share: Annotated[
        float, Constant("1", "A8", "hips below this share of the leg's length: knocked down")
    ] = 0.55


class Search(NamedTuple):
    """Which motion a struck character goes on with (4.1.3; Zordan et al. 2005), where a new one may be searched for."""

    auto_over_m: Annotated[
        float, Constant("m", "A9", "auto: a new motion if the blow moved the body more than this")
    ] = 0.06
    own_clip: Annotated[bool, Constant("yes/no", "A9", "whether the clip that was played counts as new")] = False
    velocity_s: Annotated[float, Constant("s", "A9", "a velocity counts as the distance it goes in this time")] = 0.1
    candidates: Annotated[int, Constant("count", "A9", "windows of the prefilter that are compared exactly")] = 192
    least_left_s: Annotated[float, Constant("s", "A9", "of a motion that ends, after it is entered")] = 1.0
    rest_mps: Annotated[float, Constant("m/s", "A8", "mean speed of a body that has come to rest")] = 0.12
    rest_s: Annotated[float, Constant("s", "A8", "how long it lies still before it gets up")] = 0.4
    get_up_within_m: Annotated[float, Constant("m", "A8", "a get-up that begins farther off is not begun")] = 0.45
    get_up_blend_s: Annotated[float, Constant("s", "A8", "from lying as fallen to lying as the get-up begins")] = 0.7


class Settings(NamedTuple):
    """All of it. Immutable: `behaviours.overriding.override` gives a changed copy."""

    lean_turn: LeanTurn = LeanTurn()
    recoil: Recoil = Recoil()
    block: Block = Block()
    wrap: Wrap = Wrap()
    pelvis: Pelvis = Pelvis()
    startle: Startle = Startle()
    balance: Balance = Balance()
    objective: Objective = Objective()
    solver: Solver = Solver()
    timing: Timing = Timing()
    temper: Temper = Temper()
    threats: Threats = Threats()
    senses: Senses = Senses()
    blend: Blend = Blend()
    response: Response = Response()
    recovery: Recovery = Recovery()
    search: Search = Search()


CHOICES = {
    "objective.form": ("squares", "literal", "smoothed"),
    "solver.method": ("bfgs", "least_squares"),
    "blend.knee_rule": ("ends", "least"),
    "timing.ttc_model": ("equation", "text"),
    "threats.low_path": ("raise", "shorten"),
}
