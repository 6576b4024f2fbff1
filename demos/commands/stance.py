"""`brace stance`: one stance of a shape set, reported, as JSON, as a picture, or as a film of getting there."""

from __future__ import annotations

import argparse
import math
from typing import Any, NamedTuple

from demos.output import print_json, say
from engine.core.files import check_output

STILLS, FILMS = (".png",), (".mp4", ".gif")
MOST_WIDTH_M = 1.5  # between the ankles
REPEATS = 5  # the time reported is the best of these


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "stance",
        help="one stance of a shape set: how somebody stands there",
        description="Solves one stance. SET is a shape set, one of Alberts' words for a posture, such as hunched, or a "
        "shape's .toml, such as the window's Stance panel saves (behaviours/stance/shape_file.py describes it).",
        epilog="example: brace stance recoil-strong --intensity 0.8 --object 1.2,0.4,1.3 -o recoil.png",
    )
    parser.add_argument(
        "set", metavar="SET", nargs="?", help="a shape set, a word such as hunched (`--list` shows all), or FILE.toml"
    )
    parser.add_argument("--list", action="store_true", help="all shape sets with what they mean")
    parser.add_argument(
        "--intensity", type=float, default=1.0, metavar="X", help="how much of it; 1 is a full instance (1)"
    )
    parser.add_argument("--object", metavar="X,Y,Z", help="what it is about and looked at, metres: ahead, left, up")
    parser.add_argument("--reach-left", metavar="X,Y,Z", help="where the left wrist is to be")
    parser.add_argument("--reach-right", metavar="X,Y,Z", help="where the right wrist is to be")
    parser.add_argument("--width", type=float, metavar="M", help="between the ankles, metres")
    parser.add_argument("--height", type=float, default=1.75, metavar="M", help="of the person, metres (1.75)")
    parser.add_argument("--sex", choices=("male", "female"), default="male", help="whose masses and proportions (male)")
    parser.add_argument(
        "--then",
        action="append",
        default=[],
        metavar="SET:X[:M]",
        help="a further stance of the film, stepped into where M is another width between the ankles; may be repeated",
    )
    parser.add_argument(
        "--crouch", action="store_true", help="instead of a SET: crouch, twist of the pelvis, shift of the weight"
    )
    parser.add_argument("--json", action="store_true", help="the report for programs")
    parser.add_argument(
        "-o", "--output", metavar="FILE", help=".png: front and side; .mp4, .gif: from neutral and back"
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from demos.kernels import get_kernels_ready

    if args.list:
        _list()
        return
    get_kernels_ready()
    if args.crouch:
        _run_crouch(args)
    else:
        _run_set(args)


def _list() -> None:
    from behaviours.stance.shape_sets import SETS

    for name, entry in SETS.items():
        print(f"{name:<20} {entry.low:+.0f} to {entry.high:+.0f}  {entry.meaning}")


def _run_set(args) -> None:
    """One stance, and with --then those that follow it: report, picture, film. Words are checked before any work."""
    from behaviours.stance import report
    from behaviours.stance.shape_sets import meaning_of
    from engine.core.errors import BadInput

    if args.set is None:
        raise BadInput("usage", "expected a SET (`brace stance --list` shows them)")
    own = _own_shape(args.set)
    if own is None:
        meaning_of(args.set)
    kind = _kind(args.output)
    further = [_further(text) for text in args.then]
    if further and kind != "film":
        raise BadInput("usage", "--then needs a film: -o FILE.mp4 or FILE.gif")
    body, feet, points = _wanted(args)
    points = {name: point or (own.points.get(name) if own else None) for name, point in points.items()}
    result, milliseconds = _solve(body, args, feet, points, own)
    if kind == "still":
        _write_still(args.output, body, result, points)
    moved_m = None
    if kind == "film":
        moved_m = _write_film(args.output, body, [result, *_more(body, further, result, points)], points)
    told = (body, result, args.set, args.intensity, milliseconds)
    if args.json:
        print_json(report.as_json(*told) | ({} if moved_m is None else {"film_foot_motion_m": moved_m}))
    else:
        print("\n".join(report.lines(*told)))
        if moved_m is not None:
            print(f"  film        the feet move by {1e3 * moved_m:.2g} mm at most")


def _wanted(args) -> tuple[Any, Any, dict[str, Any]]:
    """Body, feet (None: as the set says) and the points that the arguments ask for."""
    from behaviours.stance import footprints
    from engine.body.anthropometry import standard_body
    from engine.core.errors import BadInput

    if not 0.5 <= args.height <= 2.5:
        raise BadInput("usage", f"--height {args.height:g}: expected 0.5 to 2.5 metres")
    if args.width is not None and not 0.0 <= args.width <= MOST_WIDTH_M:
        raise BadInput("usage", f"--width {args.width:g}: expected 0 to {MOST_WIDTH_M:g} metres")
    body = standard_body(args.height, sex=args.sex)
    feet = None if args.width is None else footprints.stand(body, width_m=args.width)
    return body, feet, {
        "object_m": _point(args.object, "--object"),
        "reach_left_m": _point(args.reach_left, "--reach-left"),
        "reach_right_m": _point(args.reach_right, "--reach-right"),
    }  # fmt: skip


def _point(text: str | None, name: str) -> tuple[float, float, float] | None:
    """`1.2,0.4,1.3`. BadInput for anything else."""
    from engine.core.errors import BadInput

    if text is None:
        return None
    try:
        x, y, z = (float(word) for word in text.split(","))
    except ValueError:
        x = y = z = float("nan")
    if not all(map(math.isfinite, (x, y, z))):
        raise BadInput("usage", f"{name} {text!r}: expected three numbers, such as 1.2,0.4,1.3")
    return x, y, z


def _own_shape(name: str):
    """The shape of a .toml file (`shape_file.SavedShape`); None for anything else."""
    if not name.lower().endswith(".toml"):
        return None
    from behaviours.stance.shape_file import read_shape

    return read_shape(name)


def _solve(body, args, feet, points, own) -> tuple[Any, float]:
    """The stance, and how long it took: the best of a few, the first of which may have compiled kernels."""
    import time

    from behaviours.stance.solve import solve_saved, solve_stance

    best = float("inf")
    for _ in range(1 + REPEATS):
        begun = time.perf_counter()
        if own is None:
            result = solve_stance(body, args.set, args.intensity, feet=feet, **points)
        else:
            result = solve_saved(body, own.shape, args.intensity, feet=feet, **points)
        best = min(best, 1000.0 * (time.perf_counter() - begun))
    return result, best


def _kind(output: str | None) -> str | None:
    """`still` or `film`, by the ending; asked before any work."""
    from pathlib import Path

    from engine.core.errors import BadInput

    if output is None:
        return None
    ending = Path(output).suffix.lower()
    if ending not in STILLS + FILMS:
        raise BadInput("usage", f"-o {output}: expected a name that ends in {', '.join(STILLS + FILMS)}")
    check_output(output)
    return "still" if ending in STILLS else "film"


def _write_still(output, body, result, points) -> None:
    from demos.stance_pictures import front_and_side
    from engine.render.capture import write_png

    write_png(output, front_and_side(body, result, _marks(points)))
    say(f"wrote {output}")


def _write_film(output, body, results, points) -> float:
    """Returns how far the feet move in it, metres."""
    from behaviours.stance import sequence
    from demos.stance_pictures import foot_motion_m, there_and_back

    frames = list(sequence.frames(body, *there_and_back(body, results)))
    _film(output, body, frames, points)
    return foot_motion_m(frames)


def _film(output, body, frames, points) -> None:
    from demos.stance_pictures import FPS, film_of
    from engine.render.capture import write_film

    write_film(output, film_of(body, frames, _marks(points)), FPS)
    say(f"wrote {output}")


class _Further(NamedTuple):
    """A stance that follows another."""

    set_name: str
    intensity: float
    width_m: float | None  # between the ankles; None: on the feet as they stand


def _further(text: str) -> _Further:
    """`interest:0.8`, `posture:0.2:0.4`; a name alone means all of it. BadInput for anything else."""
    from behaviours.stance.shape_sets import meaning_of
    from engine.core.errors import BadInput

    name, *numbers = text.split(":")
    try:
        intensity, *width = [float(number) for number in numbers] or [1.0]
    except ValueError:
        intensity, width = math.nan, []
    if not math.isfinite(intensity) or len(width) > 1 or not all(0.0 <= m <= MOST_WIDTH_M for m in width):
        expected = f"SET:X or SET:X:M, such as interest:0.8 or posture:0.2:0.4, M up to {MOST_WIDTH_M:g}"
        raise BadInput("usage", f"--then {text!r}: expected {expected}")
    return _Further(*meaning_of(name, intensity), width[0] if width else None)


def _more(body, further, first, points) -> list[Any]:
    """The stances that follow, each on the feet of the one before unless it says how wide."""
    from behaviours.stance.footprints import stand
    from behaviours.stance.solve import solve_stance

    results, feet = [], first.feet
    for name, intensity, width_m in further:
        feet = feet if width_m is None else stand(body, width_m=width_m)
        results.append(solve_stance(body, name, intensity, feet=feet, **points))
    return results


def _run_crouch(args) -> None:
    """The paper's own proof of balance and feet (7), played and measured; with -o, filmed."""
    from behaviours.stance import sequence
    from behaviours.stance.footprints import neutral_width_m
    from demos.benchmarks.stance_bars import crouch_twist_shift
    from demos.stance_pictures import foot_motion_m
    from engine.core.errors import BadInput

    if args.set is not None or args.then:
        raise BadInput("usage", "--crouch comes instead of a SET")
    if _kind(args.output) == "still":
        raise BadInput("usage", f"-o {args.output}: --crouch is a film, .mp4 or .gif")
    body, _, points = _wanted(args)
    width_m = neutral_width_m(body) if args.width is None else args.width
    frames = list(sequence.frames(body, *crouch_twist_shift(body, width_m)))
    off_m = max(math.hypot(*(frame.com_m[:2] - frame.com_wanted_m)) for frame in frames)
    found = {
        "width_m": width_m, "seconds": len(frames) / sequence.TICK_RATE_HZ, "foot_motion_m": foot_motion_m(frames),
        "balance_error_m": off_m,
    }  # fmt: skip
    if args.output:
        _film(args.output, body, frames, points)
    if args.json:
        print_json(found)
    else:
        print(f"crouch, twist, shift on feet {100 * width_m:.0f} cm apart, {found['seconds']:.1f} s")
        print(f"  feet        moved by {1e3 * found['foot_motion_m']:.2g} mm at most")
        print(f"  balance     off by {1e3 * off_m:.2g} mm at most, on the way")


def _marks(points) -> list[Any]:
    return [point for point in points.values() if point is not None]
