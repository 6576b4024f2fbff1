"""`brace export`: a run for other programs, or as a web page."""

from __future__ import annotations

import argparse
from pathlib import Path

from demos.commands.arguments import add_scenario
from demos.output import say
from engine.core.files import check_output


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "export",
        help="a scenario as .bvh, .glb, .npz or .html",
        description="Runs a scenario and writes it whole: .bvh (the skeleton of one character), .glb (glTF: skinned "
        "people and balls, moving), .npz (numpy arrays; engine/clips/own_npz.py lists them), .html (one page that "
        "plays it in any browser, offline). The output appears whole, or not at all.",
        epilog="example: brace export volleyball -o volleyball.html",
    )
    add_scenario(parser)
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help="x.bvh, x.glb, x.npz or x.html")
    parser.add_argument(
        "--fps", type=float, metavar="N", help="frames a second, 1 to 120 (.bvh, .npz: 120, every tick; others: 60)"
    )
    parser.add_argument(
        "--character", type=int, default=0, metavar="N", help="whose motion a .bvh or .npz is, counted from 0 (0)"
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from demos.exporting.files import USUAL_FPS, ending_of, export_bytes
    from demos.exporting.footage import film
    from demos.filming import Shot, placed_for
    from demos.running import open_scenario, start
    from engine.core.errors import BadInput
    from engine.core.files import write_atomically

    ending = ending_of(args.output)
    check_output(args.output)
    fps = USUAL_FPS[ending] if args.fps is None else args.fps
    if not 1.0 <= fps <= 120.0:
        raise BadInput("usage", f"--fps {fps:g}: expected 1 to 120")
    scenario, folder = open_scenario(args.scenario, args.set)
    if not 0 <= args.character < len(scenario.character):
        raise BadInput("usage", f"--character {args.character}: expected 0 to {len(scenario.character) - 1}")
    footage = film(start(scenario, folder), fps, Path(args.scenario).stem)
    camera = placed_for(Shot(), scenario).camera
    write_atomically(args.output, export_bytes(ending, footage, args.character, camera))
    say(f"wrote {args.output}")
