"""`brace replay`: a recording, checked tick for tick, filmed, or seen in the window."""

from __future__ import annotations

import argparse

from demos.commands.arguments import add_filming, shot_of
from demos.output import say


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "replay",
        help="plays a recording; --check simulates it again and compares every tick",
        description="Simulates a recording again. Every tick is compared with what was recorded: a run that comes out "
        "differently ends with exit code 4.",
        epilog="example: brace replay run.brace --check",
    )
    parser.add_argument("file", metavar="FILE", help="what `brace react --record` or R in the window wrote")
    parser.add_argument("--check", action="store_true", help="compare every tick, draw nothing")
    parser.add_argument("-o", "--output", metavar="OUT", help="x.mp4, x.gif or a folder: film it")
    add_filming(parser)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from demos.running import replayed, with_progress
    from engine.core.journal_file import load_journal

    shot = shot_of(args)
    if args.output:
        from engine.render.capture import capture_kind

        capture_kind(args.output)
    journal = load_journal(args.file)
    ticks = journal.last_tick - journal.first_tick
    simulation, recorder = replayed(journal, args.file)
    if args.output:
        from demos.commands.capture import write_film
        from demos.filming import placed_for, studio

        shot = placed_for(shot, simulation.scenario)
        with studio() as renderer:
            write_film(renderer, args.output, simulation.world, recorder.advance, ticks, shot)
        say(f"wrote {args.output}")
        return
    for _ in with_progress(range(ticks), "simulating", ticks):
        recorder.advance()
    print(f"{ticks} ticks simulated again, every one equal; digest {simulation.world.digest()}")
