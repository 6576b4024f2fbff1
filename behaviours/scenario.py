"""Scenario files: who plays which clip, what is thrown at them, and which constants differ from their defaults.

A scenario is TOML (see the README for a whole one). Every key is checked; an unknown or impossible one is reported with
its path and, where the file tells, its line.
"""

from __future__ import annotations

import difflib
import itertools
import re
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from behaviours.perceive.threats import KINDS
from behaviours.settings import Settings
from engine.body.skeleton import JOINTS
from engine.core.errors import BadInput

Recover = Literal["same", "new", "auto"]
PLAIN_WORDS = {  # for what pydantic says in words of Python
    "tuple_type": "expected a list",
    "too_short": "expected at least one",
    "model_type": "expected a table of keys",
    "dict_type": "expected a table of keys",
    "missing": "is missing",
}
BODY_TARGETS = ("head", "torso", "pelvis")


MOST_TURN_DEG, FARTHEST_M, FASTEST_MPS, MOST_SPIN_RADPS = 360.0, 1000.0, 200.0, 1000.0
Turn = Annotated[float, Field(ge=-MOST_TURN_DEG, le=MOST_TURN_DEG)]
Along = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M)]  # one coordinate
Rate = Annotated[float, Field(ge=-FASTEST_MPS, le=FASTEST_MPS)]
Spin = Annotated[float, Field(ge=-MOST_SPIN_RADPS, le=MOST_SPIN_RADPS)]


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class StanceSpec(_Section):
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


class CharacterSpec(_Section):
    """One person: a clip, where to begin in it, where to stand, and how to react."""

    clip: str = "walk"
    start_s: Annotated[float, Field(ge=0)] = 0.0
    position_m: tuple[Along, Along] = (0.0, 0.0)
    heading_deg: Turn = 0.0
    mirrored: bool = False
    stance: StanceSpec = StanceSpec()
    boldness: Annotated[float, Field(ge=-1, le=1)] = 0.0  # -1 timid ... +1 bold
    startle: bool = True
    protects: bool = True  # false: sees nothing coming, for comparison
    recover: Recover = "same"
    response_s: Annotated[float, Field(gt=0, le=2)] = 0.08
    sex: Literal["male", "female"] = "male"
    mass_kg: Annotated[float, Field(gt=10, lt=300)] | None = None


def _known_kind(kind: str) -> str:
    if kind not in KINDS:
        raise ValueError(f"unknown kind {kind!r}; {_nearest(kind, tuple(KINDS))}")
    return kind


class ThreatSpec(_Section):
    """One ball. Scripted: given at contact, in the character's frame. Free: given at launch, in the world."""

    kind: Annotated[str, AfterValidator(_known_kind)] = "volleyball"
    target: str | tuple[float, float, float] = "head"
    at_character: Annotated[int, Field(ge=0)] = 0
    perceived_s: Annotated[float, Field(ge=0)] | None = None
    contact_s: Annotated[float, Field(ge=0)] | None = None
    azimuth_deg: Turn = 0.0
    elevation_deg: Annotated[float, Field(gt=-90, lt=90)] = 0.0
    speed_mps: Annotated[float, Field(gt=0, le=FASTEST_MPS)] | None = None
    size: Annotated[float, Field(ge=0, le=1)] = 0.5
    size_means: Literal["rule", "radius", "mass", "both"] = "rule"
    speed_range_mps: tuple[float, float] | None = None
    radius_m: Annotated[float, Field(gt=0, le=2)] | None = None
    mass_kg: Annotated[float, Field(gt=0, le=500)] | None = None
    ttc_s: Annotated[float, Field(gt=0, le=10)] | None = None
    drag: bool = False
    spin_radps: tuple[Spin, Spin, Spin] = (0.0, 0.0, 0.0)
    free: bool = False
    released_s: Annotated[float, Field(ge=0)] = 0.0
    position_m: tuple[Along, Along, Along] | None = None
    velocity_mps: tuple[Rate, Rate, Rate] | None = None

    @field_validator("target")
    @classmethod
    def _known_target(cls, target: Any) -> Any:
        if isinstance(target, str) and target not in BODY_TARGETS + JOINTS:
            raise ValueError(f"unknown target {target!r}; {_nearest(target, BODY_TARGETS + JOINTS)}")
        if not isinstance(target, str) and max(map(abs, target)) > FARTHEST_M:
            raise ValueError(f"a point should be at most {FARTHEST_M:g} m away")
        return target

    @model_validator(mode="after")
    def _one_way_of_saying_it(self) -> ThreatSpec:
        if self.speed_range_mps is not None and not self.speed_range_mps[0] < self.speed_range_mps[1]:
            raise ValueError("speed_range_mps: the first number must be below the second")
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


class ThrowSpec(_Section):
    """A ball that somebody throws from somewhere, in the world; it may miss."""

    at_character: Annotated[int, Field(ge=0)] = 0
    position_m: tuple[Along, Along, Along]
    velocity_mps: tuple[Rate, Rate, Rate]
    kind: Annotated[str, AfterValidator(_known_kind)] = "volleyball"
    size: Annotated[float, Field(ge=0, le=1)] = 0.5


class CommandSpec(_Section):
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
            given = self.throw.model_dump(mode="json")
            return {"do": "throw", "at": given.pop("at_character"), **given}
        assert self.threat is not None
        return {"do": "threaten", "threat": self.threat.model_dump(mode="json", exclude_defaults=True)}


class Scenario(_Section):
    """A whole run, checked. `settings` holds overrides of the thesis's constants, dotted in groups."""

    version: Literal[1] = 1
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    duration_s: Annotated[float, Field(gt=0, le=600)] = 4.0
    character: Annotated[tuple[CharacterSpec, ...], Field(min_length=1)] = (CharacterSpec(),)
    threat: tuple[ThreatSpec, ...] = ()
    command: tuple[CommandSpec, ...] = ()  # applied before the tick of their moment
    library: tuple[str, ...] | None = (
        None  # clips that a search for a new motion looks through; None: all that are here
    )
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


def load_scenario(path: str | Path, overrides: tuple[str, ...] = ()) -> Scenario:
    """Reads and checks a scenario file, after `key=value` overrides such as `threat.0.speed_mps=28`.

    BadInput names the file, the line where the key stands if it can be found, and what was expected.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as trouble:
        raise BadInput("scenario", f"cannot be read: {trouble.strerror or trouble}", str(path)) from None
    except UnicodeDecodeError:
        raise BadInput("scenario", "is not text; a scenario is a TOML file", str(path)) from None
    return parse_scenario(text, str(path), overrides)


def parse_scenario(text: str, where: str = "scenario", overrides: tuple[str, ...] = ()) -> Scenario:
    """A scenario from its text; `where` names it in errors."""
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as trouble:
        line = re.search(r"at line (\d+)", str(trouble))
        raise BadInput("toml", str(trouble), f"{where}:{line[1]}" if line else where) from None
    for override in overrides:
        _override(raw, override)
    return check_scenario(raw, where, text, overrides)


def check_scenario(
    raw: dict[str, Any], where: str = "scenario", text: str = "", overrides: tuple[str, ...] = ()
) -> Scenario:
    """A scenario from plain data, every key checked. BadInput on the first trouble, counting the rest.

    text, overrides: what the data was read from, so that the trouble's line, or its `--set`, can be named.
    """
    try:
        return Scenario.model_validate(raw)
    except ValidationError as trouble:
        errors = trouble.errors()
        first = errors[0]
        keys = [str(key) for key in first["loc"] if key not in ("str", "tuple[float, float, float]")]
        message = _explain(first, keys)
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise BadInput("scenario", message + more, _place_of(keys, where, text, overrides)) from None


def check_threat(raw: dict[str, Any]) -> ThreatSpec:
    """One scripted threat from plain data. BadInput on the first trouble."""
    try:
        return ThreatSpec.model_validate(raw)
    except ValidationError as trouble:
        first = trouble.errors()[0]
        raise BadInput("threat", _explain(first, ["threat", *(str(key) for key in first["loc"])])) from None


def _explain(error: Any, keys: list[str]) -> str:
    dotted = ".".join(keys)
    if error["type"] == "extra_forbidden":
        sections: dict[str, type[_Section]] = {"character": CharacterSpec, "threat": ThreatSpec, "command": CommandSpec}
        section = StanceSpec if "stance" in keys[:-1] else sections.get(keys[0], Scenario)
        return f"unknown key {dotted!r}; {_nearest(keys[-1], tuple(section.model_fields))}"
    reason = PLAIN_WORDS.get(error["type"]) or error["msg"].removeprefix("Value error, ")
    given = error.get("input")
    shown = "" if isinstance(given, dict) or given is None else f", found {given!r}"
    return f"{dotted}: {reason}{shown}" if dotted else reason


def _place_of(keys: list[str], where: str, text: str, overrides: tuple[str, ...]) -> str:
    """Where a value comes from: the `--set` that gave it, else the file and, where it can be told, its line."""
    for override in reversed(overrides):
        given = override.partition("=")[0].strip().split(".")
        if keys[: len(given)] == given:
            return f"--set {override}"
    line = _line_of(text, keys)
    return f"{where}:{line}" if line else where


def _nearest(name: str, known: tuple[str, ...]) -> str:
    close = difflib.get_close_matches(name, known, n=3, cutoff=0.5)
    rest = [k for k in known if k not in close]
    return f"expected one of {', '.join(close + rest)}"


def _line_of(text: str, keys: list[str]) -> int | None:
    """The line of a key such as threat.1.speed_mps in the text; None where it cannot be told."""
    section, nth, seen = keys[0] if keys else "", 0, -1
    if len(keys) > 1 and keys[1].isdigit():
        nth = int(keys[1])
    inside = len(keys) <= 1
    for number, line in enumerate(text.splitlines(), 1):
        head = re.match(r"\s*\[\[?\s*([\w.]+)\s*\]\]?", line)
        if head:
            seen += head[1] == section
            inside = head[1] == section and seen == nth
        elif inside and keys and re.match(rf"\s*{re.escape(keys[-1])}\s*=", line):
            return number
    return None


def _override(raw: dict[str, Any], text: str) -> None:
    """Sets one `a.0.b=value` in the raw data; the value is read as TOML, else taken as a plain word. A constant may be
    named without its `settings.`, as everywhere else.
    """
    dotted, equals, value_text = text.partition("=")
    keys = dotted.strip().split(".")
    if keys[0] in Settings._fields:
        keys.insert(0, "settings")
    if not equals or not all(keys):
        raise BadInput("set", f"{text!r} is not of the form key=value, for instance threat.0.speed_mps=28")
    try:
        value = tomllib.loads(f"v = {value_text}")["v"]
    except tomllib.TOMLDecodeError:
        value = value_text.strip()
    at: Any = raw
    for key, following in itertools.pairwise(keys):
        if isinstance(at, list):
            at = at[_row(at, key, text)]
        else:
            at = at.setdefault(key, [{}] if following.isdigit() else {})
        if not isinstance(at, (dict, list)):
            raise BadInput("set", f"{text!r}: {key!r} holds a value, nothing lies below it")
    if isinstance(at, list):
        at[_row(at, keys[-1], text)] = value
    else:
        at[keys[-1]] = value


def _row(rows: list[Any], key: str, text: str) -> int:
    if not key.isdigit() or int(key) >= len(rows):
        raise BadInput("set", f"{text!r}: there is no entry {key!r}, only 0 to {len(rows) - 1}")
    return int(key)
