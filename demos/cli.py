"""The `brace` command: its words, its errors in one line, its exit codes.

Each word is a module of `demos.commands` with `register(subparsers)` and `run(args)`. Those modules import nothing
heavy at their top, so that `brace --help` answers in a blink; whatever a command needs it imports when it runs.
"""

from __future__ import annotations

import argparse
import difflib
import importlib
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from typing import NoReturn

from engine.core.errors import EXIT_GOOD, EXIT_INTERRUPTED, BadInput, BraceError

COMMANDS = ("demo", "capture", "react", "pose", "figure", "stance", "replay", "export", "clips", "bench", "doctor")
EXIT_INTERNAL = 1
EXIT_BROKEN_PIPE = 141  # what the shell reports of any program whose reader went away


class Parser(argparse.ArgumentParser):
    """argparse, with its complaints as one line of ours."""

    def error(self, message: str) -> NoReturn:
        raise BadInput("usage", f"{message} (see {self.prog} --help)")


def build_parser() -> argparse.ArgumentParser:
    """The whole command line; every word registers itself."""
    parser = Parser(
        prog="brace",
        description="A character that sees an impact coming, protects itself, takes the hit and carries on.",
        epilog="example: brace capture volleyball -o volleyball.mp4",
    )
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", dest="command", required=True)
    for name in COMMANDS:
        importlib.import_module(f"demos.commands.{name}").register(subparsers)
    return parser


def main(argv: list[str] | None = None) -> int:
    """Runs one command and returns its exit code; nothing that a user can cause leaves as a traceback."""
    words = sys.argv[1:] if argv is None else argv
    return guarded(lambda: _run(words))


def guarded(work: Callable[[], int | None]) -> int:
    """Does the work and returns its exit code; every failure becomes one line and the code that stands for it."""
    _prepare_process()
    try:
        try:
            code = work()
        finally:  # also after --help, which leaves by SystemExit
            sys.stdout.flush()  # a reader that went away is noticed here, not at interpreter exit
        return EXIT_GOOD if code is None else code
    except BraceError as trouble:
        print(trouble.line(), file=sys.stderr)
        return trouble.exit_code
    except KeyboardInterrupt as stop:
        return 128 + stop.args[0] if stop.args else EXIT_INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return EXIT_BROKEN_PIPE
    except Exception as trouble:
        if os.environ.get("BRACE_DEBUG") == "1":
            traceback.print_exc()
        else:
            what = " ".join(f"{type(trouble).__name__}: {trouble}".split())
            print(f"error[internal]: {what}; please report this, with BRACE_DEBUG=1 for the details", file=sys.stderr)
        return EXIT_INTERNAL


def _run(words: list[str]) -> int | None:
    _check_word(words)
    args = build_parser().parse_args(words)
    return args.run(args)


def nearest(name: str, known: tuple[str, ...] | list[str]) -> str:
    """`expected one of ...`, all that are known, nearest to the name first."""
    close = difflib.get_close_matches(name, known, n=3, cutoff=0.5)
    return f"expected one of {', '.join(close + [word for word in known if word not in close])}"


def _prepare_process() -> None:
    """What must be so before the first heavy import, whatever the machine's locale."""
    # with another busy process the OpenMP layer's median rose from 0.26 to 16 ms
    os.environ.setdefault("NUMBA_THREADING_LAYER", "workqueue")
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by whoever called: `>&-`
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115  # for as long as the process lives
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    # a log-out or a `kill` cleans up as Ctrl-C does: no half file, no ffmpeg or pip left behind
    if threading.current_thread() is threading.main_thread():
        for ending in (signal.SIGTERM, signal.SIGHUP):
            if signal.getsignal(ending) is signal.SIG_DFL:
                signal.signal(ending, _stop)


def _stop(signum: int, frame: object) -> NoReturn:
    signal.signal(signum, signal.SIG_DFL)  # who asks twice does not want to wait for the cleaning up
    raise KeyboardInterrupt(signum)


def _check_word(words: list[str]) -> None:
    """An unknown command is met with its nearest neighbours, which argparse would not offer."""
    if words and not words[0].startswith("-") and words[0] not in COMMANDS:
        raise BadInput("usage", f"unknown command {words[0]!r}; {nearest(words[0], COMMANDS)}")


if __name__ == "__main__":
    sys.exit(main())
