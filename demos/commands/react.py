"""`brace react`: a scenario without graphics, and what came of it in words or JSON."""

from __future__ import annotations

import argparse
from typing import Any

from demos.commands.arguments import add_scenario
from demos.output import print_json, say
from engine.core.files import check_output

# said already, or handles that mean nothing to people
UNSAID = ("t_s", "kind", "entity", "character", "at", "ball", "threat")


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "react",
        help="runs a scenario without graphics and reports what happened",
        description="Runs a scenario as fast as it can, without graphics, and reports events, phases and measures.",
        epilog="example: brace react volleyball --set threat.0.speed_mps=28 --json",
    )
    add_scenario(parser)
    parser.add_argument("--json", action="store_true", help="the report for programs")
    parser.add_argument("--record", metavar="FILE", help="keeps the run for `brace replay`")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from demos.running import open_scenario, recorder_of, start, with_progress
    from engine.core.journal_file import save_journal

    if args.record:
        check_output(args.record)
    scenario, folder = open_scenario(args.scenario, args.set)
    simulation = start(scenario, folder, observe=True)
    recorder = recorder_of(simulation, folder) if args.record else None
    advance = recorder.advance if recorder else simulation.step
    for _ in with_progress(range(simulation.ticks), "simulating", simulation.ticks):
        advance()
    if recorder:
        save_journal(recorder.journal, args.record)
        say(f"wrote {args.record}")
    report = simulation.report()
    if args.json:
        print_json(report)
    else:
        print("\n".join(report_lines(report)))


def report_lines(report: dict[str, Any]) -> list[str]:
    """The same report for people: what happened when, and to whom if there are several; the phases, the measures."""
    characters = report.get("characters", [report])
    several = len(characters) > 1
    lines = ["events, and which character" if several else "events"]
    for event in report["events"]:
        rest = ", ".join(f"{key} {_short(value)}" for key, value in event.items() if key not in UNSAID)
        who = f"{_short(event['character']):>3}  " if several else ""
        lines.append(f"  {event['t_s']:7.3f} s  {who}{event['kind']:<12} {rest}".rstrip())
    for number, account in enumerate(characters):
        of = f" of character {number}" if several else ""
        lines.append(f"phases{of}")
        lines += [f"  {phase['from_s']:7.3f} - {phase['to_s']:7.3f} s  {phase['name']}" for phase in account["phases"]]
        lines.append(f"measures{of}")
        lines += [f"  {name:<32} {_short(value)}" for name, value in account["metrics"].items()]
    return [*lines, f"{report['ticks']} ticks, digest {report['digest']}"]


def _short(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, (list, tuple)):
        return f"({', '.join(_short(part) for part in value)})"
    return str(value)
