"""Arguments that several commands share."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable


def whole(least: int = 1) -> Callable[[str], int]:
    """An argparse `type`: a whole number of at least this."""

    def read(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = least - 1
        if number < least:
            raise argparse.ArgumentTypeError(f"found {text!r}, expected a whole number from {least}")
        return number

    return read


def seconds(text: str) -> float:
    """An argparse `type`: a moment of a run or a clip, 0 or later."""
    try:
        moment_s = float(text)
    except ValueError:
        moment_s = math.nan
    if not 0.0 <= moment_s < math.inf:
        raise argparse.ArgumentTypeError(f"found {text!r}, expected seconds, 0 or more")
    return moment_s


def add_scenario(parser: argparse.ArgumentParser, default: str | None = None) -> None:
    """SCENARIO and --set."""
    parser.add_argument(
        "scenario", metavar="SCENARIO", nargs="?" if default else None, default=default,
        help=f"a .toml file, or the name of one that comes with Brace{f' ({default} without any)' if default else ''}",
    )  # fmt: skip
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE",
        help="changes one value of the scenario, such as threat.0.speed_mps=28, or one constant of the model, such as "
        "block.offset_m=0.1; may be repeated",
    )  # fmt: skip


def add_filming(parser: argparse.ArgumentParser, size: str = "1280x720", sizes: str = "") -> None:
    """How pictures are made of a run.

    sizes: what the help says of the size where it depends on what is made.
    """
    parser.add_argument("--size", default=size, metavar="WxH", help=f"pixels of a picture ({sizes or size})")
    parser.add_argument("--fps", type=float, default=30.0, metavar="N", help="frames a second (30)")
    parser.add_argument(
        "--camera", default="quarter", metavar="WHERE",
        help="quarter, front, left, right, back, above, or AZIMUTH,ELEVATION[,DISTANCE] about the character (quarter)",
    )  # fmt: skip
    parser.add_argument(
        "--ghosts", nargs="?", const="all", default="", metavar="NAMES",
        help="shows the clip, rules and sustained pose beside the character: all of them, or names with commas",
    )  # fmt: skip
    parser.add_argument("--floor", default="gym", metavar="NAME", help="gym, or plain: pale, without walls (gym)")


def shot_of(args: argparse.Namespace):
    """The Shot that the arguments of `add_filming` ask for. BadInput where they make no sense."""
    from demos.filming import Shot, parse_camera, parse_ghosts, parse_size
    from engine.core.errors import BadInput
    from engine.render.scene import FLOORS

    if not 1.0 <= args.fps <= 240.0:
        raise BadInput("usage", f"--fps {args.fps:g}: expected 1 to 240")
    if args.floor not in FLOORS:
        raise BadInput("usage", f"--floor {args.floor!r}: expected one of {', '.join(FLOORS)}")
    return Shot(parse_size(args.size), args.fps, parse_camera(args.camera), parse_ghosts(args.ghosts), args.floor)
