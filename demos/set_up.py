"""What is left to set up once Python's packages are there: the real clips and the compiled kernels.

`./run` calls it until it has succeeded once in a cache. No network is no obstacle: the embedded clip needs none.
"""

from __future__ import annotations

import sys
import time

from demos.cli import guarded
from demos.kernels import terminal_line, warm_up
from engine.core.errors import BraceError

DONE = "set-up.done"


def main() -> None:
    """Fetches and compiles what is missing. Clips that stay missing are no failure here: they are named when needed."""
    complete = _fetch_clips()
    _compile_kernels()
    if complete:
        from engine.clips.library import cache_folder

        (cache_folder() / DONE).touch()


def _fetch_clips() -> bool:
    """Whether all real clips are there now."""
    from engine.clips.library import fetch

    try:
        fetch(_say)
    except BraceError as trouble:
        _say(f"{trouble.message}; going on with the embedded clip `sway` (`./run clips fetch` tries again)")
        return False
    return True


def _compile_kernels() -> None:
    begun = time.monotonic()
    _say("compiling kernels, once")
    compiled = warm_up(terminal_line)
    terminal_line("")
    _say(f"{compiled} kernels compiled in {time.monotonic() - begun:.0f} s")


def _say(line: str) -> None:
    print(f"brace: {line}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(guarded(main))
