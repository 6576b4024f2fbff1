"""What is left to set up once Python's packages are there: `python -m demos.set_up clips kernels`, either or both.

`./run` calls it once for a cache and once for an environment. No network is no obstacle: the embedded clip needs none.
"""

from __future__ import annotations

import sys
import time

from demos.cli import guarded
from demos.kernels import announce_compiling
from engine.core.errors import BraceError


def main() -> None:
    """Does what the words on the command line name."""
    if "clips" in sys.argv[1:]:
        fetch_clips()
    if "kernels" in sys.argv[1:]:
        compile_kernels()


def fetch_clips() -> None:
    """Brings the real clips; without network it says so and goes on."""
    from engine.clips.library import fetch

    try:
        fetch(_say)
    except BraceError as trouble:
        _say(f"{trouble.message}; going on with the embedded clip 'sway' (./run clips fetch tries again)")


def compile_kernels() -> None:
    """Runs a whole reaction on the embedded clip, so that set-up pays for compiling and no tick ever does."""
    from demos.running import open_scenario, start

    begun = time.monotonic()
    _say("compiling kernels, once")
    compiled = announce_compiling()
    simulation = start(*open_scenario("sway"))
    for _ in range(simulation.ticks):
        simulation.step()
    _say(f"{len(compiled)} kernels compiled in {time.monotonic() - begun:.0f} s")


def _say(line: str) -> None:
    print(f"brace: {line}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(guarded(main))
