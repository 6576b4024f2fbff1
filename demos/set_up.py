"""What is left to set up once Python's packages are there: `python -m demos.set_up clips kernels`, either or both.

`./run` calls it once for a cache and once for an environment. No network is no obstacle: the embedded clip needs none.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import time
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from demos.cli import guarded
from demos.kernels import ROOT, get_kernels_ready, newest_kernel_source_s, on_compiling, terminal_line
from engine.clips.cache import cache_folder
from engine.core.errors import BraceError


def main() -> None:
    """Does what the words on the command line name."""
    if "clips" in sys.argv[1:]:
        fetch_clips()
    if "kernels" in sys.argv[1:]:
        compile_kernels()
    for part in (*PARTS, *LATER):
        if f"kernels-{part}" in sys.argv[1:]:
            _compile_part(part)


def fetch_clips() -> None:
    """Brings the real clips; without network it says so and goes on."""
    from engine.clips.library import fetch

    try:
        fetch(_say)
    except BraceError as trouble:
        _say(f"{trouble.message}; going on with the embedded clip 'sway' (./run clips fetch tries again)")


def compile_kernels() -> None:
    """Runs a whole reaction on the embedded clip, so that set-up pays for compiling and no tick ever does.

    Before that, each part of it in a process of its own where there is more than one processor: they have few kernels
    in common. Whatever a part did not manage is compiled by the whole run.
    """
    begun = time.monotonic()
    _say("compiling kernels, once")
    _tidy_seldom()
    before_s = time.time()
    count = _compile_parts() if len(os.sched_getaffinity(0)) > 1 else 0
    compiled: list[str] = []
    on_compiling(lambda name: compiled.append(name) if name else None)
    _run("sway")
    _say(f"{count + len(compiled)} kernels compiled in {time.monotonic() - begun:.0f} s")
    _date_mark(before_s)  # what was edited meanwhile counts as new
    if count + len(compiled):
        _compile_later()


def compile_what_changed() -> None:
    """After an update or an edit of sources that hold kernels, before a window opens: it would stand still meanwhile.
    Of what is compiled later the terminal tells.
    """
    get_kernels_ready()
    mark = _mark()
    if not mark.exists() and not _date_mark(0.0):
        return  # where nothing can be remembered, every window would wait
    if newest_kernel_source_s() > mark.stat().st_mtime:
        compile_kernels()


def _mark() -> Path:
    """The file in the cache whose date is that of the last compilation of this tree by this Python."""
    return cache_folder() / f"kernels-{zlib.crc32(f'{ROOT} {sys.version}'.encode()):08x}"


def _date_mark(date_s: float) -> bool:
    """Whether it could be written."""
    mark = _mark()
    try:
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()
        os.utime(mark, (date_s, date_s))
    except OSError:
        return False
    return True


def _compile_later() -> subprocess.Popen:
    """Has what no first picture needs compiled behind it, when nothing else runs; who is quicker compiles it then.

    It outlives the command that it began with, and so keeps no stream of it open.
    """
    quiet: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    return subprocess.Popen(
        _to_compile(LATER), env=_environment(), start_new_session=True, preexec_fn=lambda: os.nice(19), **quiet
    )


def _to_compile(parts: Iterable[str]) -> list[str]:
    """The command that compiles these."""
    return [sys.executable, "-P", "-m", "demos.set_up", *(f"kernels-{part}" for part in parts)]


def _environment() -> dict[str, str]:
    """Ours, in which these packages are found from wherever this was called."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def _compile_parts() -> int:
    """Has all PARTS compiled at once, and returns how many kernels that were; on a terminal, which one it is now."""
    reading, writing = os.pipe()
    parts = [subprocess.Popen(_to_compile([part]), env=_environment(), stdout=writing) for part in PARTS]
    os.close(writing)
    count = 0
    with open(reading, encoding="utf-8") as names:
        for count, name in enumerate(names, 1):
            terminal_line(f"compiling kernels: {count}, {name.strip()}")
    terminal_line("")
    for part in parts:
        part.wait()
    return count


def _compile_part(part: str) -> None:
    """One of PARTS or LATER; the name of every kernel goes to standard output."""
    on_compiling(lambda name: print(name, flush=True) if name else None)
    _tidy_seldom()
    (PARTS | LATER)[part]()


def _tidy_seldom() -> None:
    """A compiler makes objects by the million and keeps most: looking for cycles among them is a tenth of its time."""
    gc.set_threshold(200_000)


def _protect() -> None:
    """A protective pose alone."""
    from demos.benchmarks.protection import standing_task

    standing_task()


def _be_struck() -> None:
    """A ball at the ankle, where nobody expects one: a blow and the recovery from it, without any protection."""
    ball = "threat=[{free=true, target='left_ankle', position_m=[4.0, 0.0, 0.3], speed_mps=26.0}]"
    _run("sway", ball)


def _stand() -> None:
    """A stance that reaches for what is near. What a hard reach needs besides is left to the first one."""
    from behaviours.stance.solve import solve_stance
    from engine.body.anthropometry import standard_body

    solve_stance(standard_body(), "reach-eager", 0.5, reach_right_m=(0.45, -0.25, 1.2))


def _sculpt() -> None:
    """No kernels, but as long a wait: the figures of all clips that are here, as fine as pictures mostly want them."""
    from engine.clips.library import find_clip, list_clips
    from engine.render import mesh_cache

    for clip in list_clips():
        if clip.ready:
            for coarser in MOSTLY_SEEN:
                mesh_cache.cached_mesh(find_clip(clip.name).body, coarser)


PARTS = {"protection": _protect, "blow": _be_struck, "figures": _sculpt}
LATER = {"stance": _stand}
MOSTLY_SEEN = (1.4, 2.0)  # of engine.render.passes.figures.DETAIL: a person fills the height of a film, or half of it


def _run(scenario: str, *overrides: str) -> None:
    from demos.running import open_scenario, start

    simulation = start(*open_scenario(scenario, overrides))
    for _ in range(simulation.ticks):
        simulation.step()


def _say(line: str) -> None:
    print(f"brace: {line}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(guarded(main))
