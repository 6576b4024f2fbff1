"""`brace figure`: the figures of the sources, drawn from the running system."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from demos.output import made_folder, say

ALL, LIST = "all", "list"
SCALE = 2.0  # pixels for a unit: a full page is 2000 pixels wide


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "figure",
        help="the figures of the sources, drawn from the running system",
        description="Draws one figure (.png, .pdf or .svg), or all of them into a folder; `list` names them.",
        epilog="example: brace figure 3.2 -o rules.png",
    )
    parser.add_argument("name", metavar="NAME", help="a figure's number or word, `all`, or `list`")
    parser.add_argument("-o", "--output", metavar="OUT", help="the file; for `all` a folder")
    parser.add_argument(
        "--scale",
        type=float,
        default=SCALE,
        metavar="N",
        help=f"pixels for a unit ({SCALE:g}); a page is 1000 units wide",
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from demos.figures import FIGURES, find_figure
    from engine.core.errors import BadInput

    if args.name == LIST:
        print("\n".join(f"{entry.name:<19} {entry.shows}" for entry in FIGURES))
        return
    chosen = FIGURES if args.name == ALL else (find_figure(args.name),)
    if args.output is None:
        raise BadInput("usage", f"brace figure {args.name} needs -o {'FOLDER' if args.name == ALL else 'FILE.png'}")
    if not 0.2 <= args.scale <= 8.0:
        raise BadInput("usage", f"--scale {args.scale:g}: expected 0.2 to 8")
    paths = _paths(args.name, args.output, [entry.name for entry in chosen])
    _print_all([entry.name for entry in chosen], paths, args.scale)


def _paths(name: str, output: str, names: list[str]) -> list[Path]:
    """Where each figure goes, found writable before any is drawn."""
    from demos.figures.sheet import check_figure_output

    if name != ALL:
        check_figure_output(output)
        return [Path(output)]
    paths = [made_folder(output) / f"{each}.png" for each in names]
    for path in paths:
        check_figure_output(path)
    return paths


def _print_all(names: list[str], paths: list[Path], scale: float) -> None:
    from demos.figures import draw_figure
    from demos.figures.press import Press
    from demos.filming import studio
    from demos.kernels import get_kernels_ready
    from demos.running import with_progress

    get_kernels_ready()
    with studio() as renderer:
        for name, path in with_progress(zip(names, paths, strict=True), "drawing", len(names)):
            press = Press(renderer, scale)
            draw_figure(name, press).save(path)
            if missing := ", ".join(press.missing):
                print(
                    f"figure {name}: `sway` stands in for {missing}, which `brace clips fetch` brings",
                    file=sys.stderr,
                )
            say(f"wrote {path}")
