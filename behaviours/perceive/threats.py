"""Threats (thesis 3.1): what a kind of thing is, and how a ball flies.

To add a kind, copy a neighbour in `KINDS`: scenarios, commands and the window's panel then have it. A *scripted* threat
is given by its state at contact and flown backwards to where it is perceived; a *free* one is given at its release and
may miss. Both fly by `engine.maths.ballistics`, which is also what the character predicts with.
"""

from __future__ import annotations

from typing import NamedTuple

from engine.maths.ballistics import drag_per_m


class Kind(NamedTuple):
    """The physical make of a threat, and what the rules' abstract 0 ... 1 may mean on it."""

    radius_m: float
    mass_kg: float
    radius_range_m: tuple[float, float]  # at size 0 and 1, where size means the radius
    mass_range_kg: tuple[float, float]  # at size 0 and 1, where size means the mass
    speed_range_mps: tuple[float, float]  # what 0 and 1 mean to the rules
    drag_per_m: float  # quadratic drag: a = -k |v| v, k = rho C_d A / 2 m; used where a threat asks for drag
    restitution: float  # off a hard floor
    friction: float


# Volleyball: FIVB official size and weight; spike speeds 22.8 - 29.7 m/s (Forthomme et al. 2005, in the thesis);
# C_d 0.2 past the drag crisis (Asai et al. 2010).
KINDS = {
    "volleyball": Kind(
        radius_m=0.105,
        mass_kg=0.27,
        radius_range_m=(0.06, 0.20),
        mass_range_kg=(0.1, 2.0),
        speed_range_mps=(22.8, 29.7),
        drag_per_m=drag_per_m(radius_m=0.105, mass_kg=0.27, coefficient=0.2),
        restitution=0.75,
        friction=0.6,
    ),
    "custom": Kind(
        radius_m=0.105,
        mass_kg=0.27,
        radius_range_m=(0.05, 0.30),
        mass_range_kg=(0.05, 10.0),
        speed_range_mps=(22.8, 29.7),
        drag_per_m=drag_per_m(radius_m=0.105, mass_kg=0.27, coefficient=0.45),
        restitution=0.5,
        friction=0.6,
    ),
}


class Make(NamedTuple):
    """One threat's body and what the rules are told of it."""

    radius_m: float
    mass_kg: float
    drag_per_m: float
    speed_norm: float
    size_norm: float


def normalised(value: float, low: float, high: float) -> float:
    """(value - low) / (high - low), clamped to [0, 1] (thesis 3.2.1)."""
    return min(max((value - low) / (high - low), 0.0), 1.0)


def make_threat(
    kind: str,
    speed_mps: float,
    size: float,
    *,
    size_means: str = "rule",
    radius_m: float | None = None,
    mass_kg: float | None = None,
    speed_range_mps: tuple[float, float] | None = None,
    drag: bool = False,
) -> Make:
    """The threat that a speed and an abstract size stand for. A radius or mass that is given wins over what size
    means.
    """
    of = KINDS[kind]
    radius, mass = of.radius_m, of.mass_kg
    if size_means in ("radius", "both"):
        radius = of.radius_range_m[0] + size * (of.radius_range_m[1] - of.radius_range_m[0])
    if size_means in ("mass", "both"):
        mass = of.mass_range_kg[0] + size * (of.mass_range_kg[1] - of.mass_range_kg[0])
    radius = radius if radius_m is None else radius_m
    mass = mass if mass_kg is None else mass_kg
    # the drag table was made for the kind's own ball: k goes with area over mass
    k = of.drag_per_m * (radius / of.radius_m) ** 2 * (of.mass_kg / mass) if drag else 0.0
    return Make(radius, mass, k, normalised(speed_mps, *(speed_range_mps or of.speed_range_mps)), size)
