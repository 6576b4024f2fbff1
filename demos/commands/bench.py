"""`brace bench`: how fast it is on this machine, beside references measured in the same run."""

from __future__ import annotations

import argparse

from demos.commands.arguments import whole
from demos.output import made_folder, print_json, say
from engine.core.errors import BadInput


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "bench",
        help="the benchmarks of the README, each beside a reference measured in the same run",
        description="Times ours and a named reference in turns on this machine; prints medians and ratio.",
        epilog="example: brace bench kinematics --json",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these (all without any)")
    parser.add_argument("--json", action="store_true", help="the same for programs")
    parser.add_argument("--motion", action="store_true", help="how good motion is, over seeded threats at real clips")
    parser.add_argument("--stance", action="store_true", help="how good stances are, over solves of all sets")
    parser.add_argument("--cases", type=whole(), metavar="N", help="of --motion (200) or --stance (504)")
    parser.add_argument("--seed", type=whole(0), default=1, help="with --motion, --stance: of the cases (1)")
    parser.add_argument("--out", metavar="DIR", help="with --motion: the worst cases as filmstrips")
    parser.add_argument("--render", action="store_true", help="what a frame takes to draw, and the quality it picks")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    if args.motion + args.stance + args.render + bool(args.names) > 1:
        raise BadInput("usage", "--motion, --stance, --render and names of benchmarks: expected one of them at a time")
    if args.out and not args.motion:
        raise BadInput("usage", "--out goes with --motion: it draws the worst of its cases")
    from demos.benchmarks import NAMES, measure
    from demos.cli import nearest

    if args.motion:
        bench_motion(args)
        return
    if args.stance:
        bench_stance(args)
        return
    if args.render:
        bench_render(args)
        return
    for name in args.names:
        if name not in NAMES:
            raise BadInput("name", f"unknown benchmark {name!r}; {nearest(name, NAMES)}")
    timings = []
    for name in args.names or NAMES:
        say(f"measuring {name}")
        timings.append(measure(name))
    if args.json:
        print_json({"benchmarks": [{**timing._asdict(), "times_faster": timing.times_faster} for timing in timings]})
        return
    print(f"{'benchmark':<36} {'ours':>10} {'reference':>10} {'faster':>8}  reference")
    for timing in timings:
        print(
            f"{timing.what:<36} {seconds(timing.ours_s):>10} {seconds(timing.reference_s):>10} "
            f"{timing.times_faster:>7.1f}x  {timing.reference_name}"
        )


def bench_motion(args: argparse.Namespace) -> None:
    """The table of figures and their bars, and where they arise; with --out, the worst cases to look at."""
    from demos.benchmarks.motion import bench
    from demos.benchmarks.motion_films import write_worst
    from demos.benchmarks.motion_table import figures_of
    from demos.kernels import get_kernels_ready
    from demos.running import with_progress

    get_kernels_ready()
    folder = made_folder(args.out) if args.out else None
    found = bench(args.cases or 200, args.seed, lambda rows, total: with_progress(rows, "throwing", total))
    figures = figures_of(found.rows, found.poses)
    if folder:
        for path in write_worst(figures, found.clips, folder):
            say(f"wrote {path}")
    if args.json:
        print_json(_motion_data(found, figures))
    else:
        print("\n".join(_motion_lines(found, figures)))


def _motion_lines(found, figures) -> list[str]:
    from demos.benchmarks.motion_cases import get_ups_here, where_from
    from demos.benchmarks.motion_phases import phase_lines, search_lines, searching, some_figures
    from demos.benchmarks.motion_table import lines_of

    table, *counted = "\n".join(lines_of(figures)).split("\n\n")
    falls, new = some_figures(found.falls), some_figures(searching(found.rows))
    search = search_lines(found.rows, get_ups_here(), found.falls)
    many = f"{len(found.rows)} threats at {len(found.clips)} clips, {len(found.falls)} knock-downs"
    return [
        f"{many}; {where_from(found.clips)}",
        *("", table),
        *("", *phase_lines(found.rows)),
        *("", *search),
        *("", "of those who go on with a new motion", *lines_of(new)[: len(new) + 1]),
        *("", "of the knock-downs", *lines_of(falls)[: len(falls) + 1]),
        *("", *counted),
    ]


def _motion_data(found, figures) -> dict:
    from demos.benchmarks.motion_phases import searching, some_figures

    def plain(figure) -> dict:
        return figure._asdict() | {"worst": figure.worst_words or None}

    return {
        "cases": len(found.rows),
        "knock_downs": len(found.falls),
        "clips": list(found.clips),
        "figures": [plain(figure) for figure in figures],
        "of_new_motions": [plain(figure) for figure in some_figures(searching(found.rows))],
        "of_knock_downs": [plain(figure) for figure in some_figures(found.falls)],
        "poses": found.poses._asdict(),
    }


def bench_stance(args: argparse.Namespace) -> None:
    """The table of figures of stances, each with its bar."""
    from demos.benchmarks.stance_bars import CASES, bars, table
    from demos.running import with_progress

    found = bars(args.cases or CASES, args.seed, lambda cases: with_progress(cases, "solving", len(cases)))
    if args.json:
        print_json({"figures": [bar._asdict() for bar in found]})
        return
    print("\n".join(table(found)))


def bench_render(args: argparse.Namespace) -> None:
    """The table of frame times."""
    from demos.benchmarks.render import bench, lines_of
    from demos.running import with_progress

    rows = list(with_progress(bench(), "drawing", 4))
    if args.json:
        print_json({"frames": [{**row._asdict(), "fps": row.fps, "wanted_fps": row.wanted_fps} for row in rows]})
        return
    print("\n".join(lines_of(rows)))


def seconds(value_s: float) -> str:
    """A time with three digits and the unit that suits it."""
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if value_s >= scale:
            return f"{value_s / scale:.3g} {unit}"
    return f"{value_s / 1e-9:.3g} ns"
