"""`brace doctor`: what this machine has, and what to do about what is missing."""

from __future__ import annotations

import argparse

from demos.output import print_json
from engine.core.errors import EXIT_ENVIRONMENT, EXIT_GOOD

MARKS = {"good": "ok", "warning": "--", "missing": "!!"}


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "doctor",
        help="what this machine has (Python, GL, ffmpeg, threads, clips, cache) and what is missing",
        description="Tries everything that Brace needs and says what to do about what is missing. "
        "Exit code 3 if something is missing that it cannot do without.",
        epilog="example: brace doctor --json",
    )
    parser.add_argument("--json", action="store_true", help="the same for programs")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    from demos.machine import MISSING, as_json, examine

    findings = examine()
    if args.json:
        print_json(as_json(findings))
    else:
        for finding in findings:
            advice = f"  ->  {finding.advice}" if finding.advice else ""
            print(f"{MARKS[finding.state]}  {finding.name:<9} {finding.detail}{advice}")
    return EXIT_ENVIRONMENT if any(finding.state == MISSING for finding in findings) else EXIT_GOOD
