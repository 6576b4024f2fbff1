"""What a scenario may say: its tables and keys, their defaults and bounds, and what goes with what."""

from __future__ import annotations

import difflib
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, field_validator, model_validator

from behaviours.perceive.threats import KINDS
from engine.body.skeleton import JOINTS
from engine.core.errors import BadInput

Recover = Literal["same", "new", "auto"]
BODY_TARGETS = ("head", "torso", "pelvis")
MOST_TURN_DEG, FARTHEST_M, FASTEST_MPS, MOST_SPIN_RADPS = 360.0, 1000.0, 200.0, 1000.0
Turn = Annotated[float, Field(ge=-MOST_TURN_DEG, le=MOST_TURN_DEG)]
Along = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M)]  # one coordinate
Rate = Annotated[float, Field(ge=-FASTEST_MPS, le=FASTEST_MPS)]
Spin = Annotated[float, Field(ge=-MOST_SPIN_RADPS, le=MOST_SPIN_RADPS)]


def one_of(name: str, known: tuple[str, ...]) -> str:
    """What was expected instead of a name, nearest first."""
    close = difflib.get_close_matches(name, known, n=3, cutoff=0.5)
    rest = [k for k in known if k not in close]
    return f"expected one of {', '.join(close + rest)}"


class Section(BaseModel):
    """A table of a scenario, every key known."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class StanceSpec(Section):
    """A stance worn under everything: a set of `brace stance`, or one of Alberts' words, or a shape of one's own by
    its states and numbers; and how much of it.
    """

    set: str = "posture"
    intensity: Annotated[float, Field(ge=-2, le=2)] = 0.0
    shape: dict[str, bool | float | str] | None = None  # instead of a set

    @field_validator("shape")
    @classmethod
    def _a_shape(cls, values: dict[str, Any] | None) -> dict[str, Any] | None:
        from behaviours.stance.shape import shape

        try:
            shape(**(values or {}))
        except (BadInput, TypeError) as trouble:
            raise ValueError(trouble.message if isinstance(trouble, BadInput) else str(trouble)) from None
        return values


class CharacterSpec(Section):
    """One person: a clip, where to begin in it, where to stand, and how to react."""

    clip: str = "walk"
    start_s: Annotated[float, Field(ge=0)] = 0.0
    position_m: tuple[Along, Along] = (0.0, 0.0)
    heading_deg: Turn = 0.0
    mirrored: bool = False
    stance: StanceSpec = StanceSpec()
    boldness: Annotated[float, Field(ge=-1, le=1)] = 0.0  # -1 timid ... +1 bold
    startle: bool = True
    protects: bool = True  # false: sees nothing coming, goes on, and is hit unprepared
    recover: Recover = "same"
    response_s: Annotated[float, Field(gt=0, le=2)] = 0.08
    sex: Literal["male", "female"] = "male"
    mass_kg: Annotated[float, Field(gt=10, lt=300)] | None = None


def _known_kind(kind: str) -> str:
    if kind not in KINDS:
        raise ValueError(f"unknown kind {kind!r}; {one_of(kind, tuple(KINDS))}")
    return kind


class BallSpec(Section):
    """What flies at somebody, however it comes."""

    kind: Annotated[str, AfterValidator(_known_kind)] = "volleyball"
    at_character: Annotated[int, Field(ge=0)] = 0
    size: Annotated[float, Field(ge=0, le=1)] = 0.5
    size_means: Literal["rule", "radius", "mass", "both"] = "rule"
    speed_range_mps: tuple[float, float] | None = None
    radius_m: Annotated[float, Field(gt=0, le=2)] | None = None
    mass_kg: Annotated[float, Field(gt=0, le=500)] | None = None
    drag: bool = False
    spin_radps: tuple[Spin, Spin, Spin] = (0.0, 0.0, 0.0)

    @field_validator("speed_range_mps")
    @classmethod
    def _rising(cls, speeds: tuple[float, float] | None) -> tuple[float, float] | None:
        if speeds is not None and not speeds[0] < speeds[1]:
            raise ValueError("the first number must be below the second")
        return speeds


class ThreatSpec(BallSpec):
    """One ball. Scripted: given at contact, in the character's frame. Free: given at launch, in the world."""

    target: str | tuple[float, float, float] = "head"
    perceived_s: Annotated[float, Field(ge=0)] | None = None
    contact_s: Annotated[float, Field(ge=0)] | None = None
    azimuth_deg: Turn = 0.0
    elevation_deg: Annotated[float, Field(gt=-90, lt=90)] = 0.0
    speed_mps: Annotated[float, Field(gt=0, le=FASTEST_MPS)] | None = None
    ttc_s: Annotated[float, Field(gt=0, le=10)] | None = None
    free: bool = False
    released_s: Annotated[float, Field(ge=0)] = 0.0
    position_m: tuple[Along, Along, Along] | None = None
    velocity_mps: tuple[Rate, Rate, Rate] | None = None

    @field_validator("target")
    @classmethod
    def _known_target(cls, target: Any) -> Any:
        if isinstance(target, str) and target not in BODY_TARGETS + JOINTS:
            raise ValueError(f"unknown target {target!r}; {one_of(target, BODY_TARGETS + JOINTS)}")
        if not isinstance(target, str) and max(map(abs, target)) > FARTHEST_M:
            raise ValueError(f"a point should be at most {FARTHEST_M:g} m away")
        return target

    @model_validator(mode="after")
    def _one_way_of_saying_it(self) -> ThreatSpec:
        if self.perceived_s is not None and self.contact_s is not None:
            raise ValueError("give perceived_s or contact_s, not both: the time to contact ties them together")
        if not self.free:
            if not isinstance(self.target, str):
                raise ValueError("a point as target needs free = true")
            for key in ("position_m", "velocity_mps"):
                if getattr(self, key) is not None:
                    raise ValueError(f"{key} needs free = true: a scripted threat is given by its state at contact")
            return self
        if self.position_m is None:
            raise ValueError("a free threat needs position_m, where it is released")
        if self.velocity_mps is None and self.speed_mps is None:
            raise ValueError("a free threat needs velocity_mps, or speed_mps to be thrown at its target")
        return self


class ThrowSpec(BallSpec):
    """A ball that somebody throws from somewhere, in the world; it may miss."""

    position_m: tuple[Along, Along, Along]
    velocity_mps: tuple[Rate, Rate, Rate]


class CommandSpec(Section):
    """What came in from outside in the window: a throw, or a threat that begins to come at that moment."""

    at_s: Annotated[float, Field(ge=0)]
    throw: ThrowSpec | None = None
    threat: ThreatSpec | None = None

    @model_validator(mode="after")
    def _one_of_them(self) -> CommandSpec:
        if (self.throw is None) == (self.threat is None):
            raise ValueError("a command is either a throw = {...} or a threat = {...}")
        if self.threat is not None and self.threat.free:
            raise ValueError("a free threat is a throw = {...} here")
        return self

    def as_command(self) -> dict[str, Any]:
        """The same in the words of a recording; see `behaviours.simulation.apply_command`."""
        if self.throw is not None:
            given = self.throw.model_dump(mode="json", exclude_unset=True)
            return {"do": "throw", "at": given.pop("at_character", 0), **given}
        assert self.threat is not None
        return {"do": "threaten", "threat": self.threat.model_dump(mode="json", exclude_defaults=True)}


class Scenario(Section):
    """A whole run, checked. `settings` holds overrides of the thesis's constants, dotted in groups."""

    version: Literal[1] = 1
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    duration_s: Annotated[float, Field(gt=0, le=600)] = 4.0
    character: Annotated[tuple[CharacterSpec, ...], Field(min_length=1)] = (CharacterSpec(),)
    threat: tuple[ThreatSpec, ...] = ()
    command: tuple[CommandSpec, ...] = ()  # applied before the tick of their moment
    library: tuple[str, ...] | None = None  # clips that a search for a new motion looks through; None: all here
    settings: dict[str, Any] = {}

    @model_validator(mode="after")
    def _threats_have_a_character(self) -> Scenario:
        for i, threat in enumerate(self.threat):
            if threat.at_character >= len(self.character):
                raise ValueError(
                    f"threat.{i}.at_character is {threat.at_character}; there are {len(self.character)} characters"
                )
        for i, command in enumerate(self.command):
            given = command.throw or command.threat
            if given is not None and given.at_character >= len(self.character):
                raise ValueError(
                    f"command.{i} is at character {given.at_character}; there are {len(self.character)} characters"
                )
        return self
