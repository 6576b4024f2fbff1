"""`brace capture`: a scenario as a film, a folder of pictures or one filmstrip, without any display."""

from __future__ import annotations

import argparse
import math

from demos.commands.arguments import add_filming, add_scenario, seconds, shot_of, whole
from demos.output import say
from engine.core.errors import BadInput

STRIP_FRAMES = 8
STRIP_COLUMNS = 8  # a row of more is too wide to be looked at
STRIP_SIZE = "400x540"


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "capture",
        help="a scenario as .mp4, .gif, a folder of .png, or one .png filmstrip",
        description="Draws a scenario without any display. The output appears whole, or not at all.",
        epilog="example: brace capture volleyball -o volleyball.mp4 --ghosts",
    )
    add_scenario(parser)
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help="x.mp4, x.gif, x.png (strip) or a folder")
    parser.add_argument("--frames", type=whole(), metavar="N", help=f"pictures in a filmstrip ({STRIP_FRAMES})")
    parser.add_argument("--columns", type=whole(), metavar="N", help=f"pictures in its row (at most {STRIP_COLUMNS})")
    parser.add_argument("--from", type=seconds, dest="from_s", metavar="S", help="only from this second on")
    parser.add_argument("--to", type=seconds, dest="to_s", metavar="S", help="only up to this second")
    parser.add_argument("--slow", action="store_true", help="slow motion just before and after each blow")
    parser.add_argument(
        "--depth", metavar="FOLDER", help="beside a film: distances, 16 bit PNGs, millimetres, 0 nothing"
    )
    parser.add_argument("--mask", metavar="FOLDER", help="beside a film: whose each pixel is, 8 bit PNGs")
    parser.add_argument(
        "--tracks", metavar="FILE.npz", help="beside a film: joints and balls, in space and on the pictures"
    )
    add_filming(parser, size="", sizes=f"a film 1280x720, a strip {STRIP_SIZE}")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from demos.filming import placed_for, studio
    from demos.running import open_scenario, start
    from engine.render.capture import capture_kind

    args.size = args.size or (STRIP_SIZE if args.output.lower().endswith(".png") else "1280x720")
    shot = shot_of(args)
    kind = capture_kind(args.output)
    if kind == "png" and args.slow:
        raise BadInput("usage", "--slow goes with a film or a folder of pictures, not with a strip")
    truth = _ground_truth(args, kind, shot)
    simulation = start(*open_scenario(args.scenario, args.set))
    shot = placed_for(shot, simulation.scenario)._replace(slow=args.slow)
    span = _span(args, simulation.scenario.duration_s)
    with studio() as renderer:
        if kind == "png":
            write_strip(renderer, args.output, simulation, shot, args.frames, args.columns, *span)
        else:
            witness = truth.witness(renderer) if truth else None
            run = (simulation.world, simulation.step, simulation.ticks)
            write_film(renderer, args.output, *run, shot, witness, *span)
    say(f"wrote {args.output}")
    for path in truth.write() if truth else ():
        say(f"wrote {path}")


def _span(args: argparse.Namespace, lasts_s: float) -> tuple[float | None, float | None]:
    """From which second to which. BadInput, before any work, where nothing of the run lies there."""
    if (args.from_s or 0.0) > min(lasts_s, math.inf if args.to_s is None else args.to_s):
        to_s = lasts_s if args.to_s is None else args.to_s
        raise BadInput("usage", f"nothing lies from {args.from_s:g} to {to_s:g} s; the scenario lasts {lasts_s:g} s")
    return args.from_s, args.to_s


def _ground_truth(args: argparse.Namespace, kind: str, shot):
    """What is to be written beside the pictures, its places checked; None where nothing is."""
    from demos.ground_truth import GroundTruth

    if not (args.depth or args.mask or args.tracks):
        return None
    if kind == "png":
        raise BadInput("usage", "--depth, --mask and --tracks go with a film or a folder of pictures, not with a strip")
    if args.tracks and not args.tracks.lower().endswith(".npz"):
        raise BadInput("usage", f"--tracks {args.tracks}: expected a name that ends in .npz")
    return GroundTruth(shot, args.depth, args.mask, args.tracks)


def write_film(renderer, output, world, advance, ticks: int, shot, witness=None, from_s=None, to_s=None) -> None:
    """The run, or from one second of it to another, as moving pictures."""
    from demos.filming import film_pictures, moments
    from demos.frames import frame_count
    from demos.running import with_progress
    from engine.render.capture import write_film

    first, last = from_s or 0.0, math.inf if to_s is None else to_s
    seen = (now for now in moments(world, advance, ticks, shot) if first <= now.time_s <= last)
    is_whole = not shot.slow and from_s is None and to_s is None
    total = frame_count(ticks, shot.fps) if is_whole else None
    write_film(output, with_progress(film_pictures(renderer, seen, shot, witness), "drawing", total), shot.fps)


def write_strip(renderer, output, simulation, shot, frames=None, columns=None, from_s=None, to_s=None) -> None:
    """Chosen moments of the run side by side; see `choose` for the span."""
    from demos.filming import choose, moments, strip_pictures
    from engine.render.capture import write_filmstrip

    seen = list(moments(simulation.world, simulation.step, simulation.ticks, shot._replace(fps=120.0)))
    chosen = choose(seen, frames or STRIP_FRAMES, from_s, to_s)
    captions = [f"{now.time_s:.2f} s\n{now.phase.replace('_', ' ')}" for now in chosen]
    write_filmstrip(
        output, strip_pictures(renderer, chosen, shot), captions, columns=columns or columns_for(len(chosen))
    )


def columns_for(frames: int) -> int:
    """How many pictures a row of a filmstrip has: at most STRIP_COLUMNS, and about as many in each row."""
    rows = -(-frames // STRIP_COLUMNS)
    return -(-frames // rows)
