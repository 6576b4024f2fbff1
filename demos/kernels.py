"""Compiled kernels: made once, with progress, and never stale.

Numba keeps a compiled kernel beside its source and looks only at that one file's date: a kernel that calls another
module's goes on running the old code after the other was changed. So here a compiled kernel is thrown away when it is
older than its own source *or* any source of ours that it imports, however indirectly.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ROOMS = ("engine", "behaviours", "demos")
WITH_KERNELS = ("engine/maths", "engine/body", "engine/clips", "engine/physics", "behaviours")  # what ticks run
_IMPORT = re.compile(r"^(?:from[ ]+([\w.]+)[ ]+import[ ]+(?:\(([^)]*)\)|(.*))|import[ ]+([\w.]+))", re.MULTILINE)


def forget_stale(root: Path = ROOT) -> list[str]:
    """Removes the compiled kernels that an edit has made stale, and returns the modules they belong to.

    A tree that cannot be written is left alone: it was installed, and its sources do not change.
    """
    paths = [path for room in ROOMS for path in sorted((root / room).rglob("*.py"))]
    sources = {path.relative_to(root).as_posix(): path for path in paths}
    dates = {name: path.stat().st_mtime_ns for name, path in sources.items()}
    compiled = _compiled_beside(sources)
    oldest = min((date for files in compiled.values() for date in files.values()), default=None)
    if oldest is None or oldest >= max(dates.values()):
        return []  # the usual case costs no more than looking at dates
    imports = {name: _imported(path.read_text(encoding="utf-8"), sources) for name, path in sources.items()}
    stale = []
    for name, files in compiled.items():
        newest = max(dates[other] for other in _reached(name, imports))
        if any(date < newest for date in files.values()):
            stale.append(name)
            with contextlib.suppress(OSError):
                for file in files:
                    file.unlink(missing_ok=True)
                    file.with_name(re.sub(r"\.\d+\.nbc$", ".nbi", file.name)).unlink(missing_ok=True)
    return stale


def newest_kernel_source_s(root: Path = ROOT) -> float:
    """When what ticks run was last edited, seconds as files have them."""
    return max(path.stat().st_mtime for room in WITH_KERNELS for path in (root / room).rglob("*.py"))


def _compiled_beside(sources: dict[str, Path]) -> dict[str, dict[Path, int]]:
    """Numba's files of compiled code of each module, with their dates. There are a thousand: a folder is read once."""
    found: dict[str, dict[Path, int]] = {name: {} for name in sources}
    names = {(path.parent, path.stem): name for name, path in sources.items()}
    for folder in dict.fromkeys(path.parent for path in sources.values()):
        with contextlib.suppress(FileNotFoundError), os.scandir(folder / "__pycache__") as files:
            for file in files:
                name = names.get((folder, file.name.partition(".")[0]))
                if name and file.name.endswith(".nbc"):
                    with contextlib.suppress(FileNotFoundError):  # another process may be tidying too
                        found[name][Path(file.path)] = file.stat().st_mtime_ns
    return found


def _reached(name: str, imports: dict[str, set[str]]) -> set[str]:
    """The module itself and everything that it imports, directly or not."""
    reached, waiting = {name}, [name]
    while waiting:
        new = imports[waiting.pop()] - reached
        reached |= new
        waiting.extend(new)
    return reached


def _imported(text: str, known: dict[str, Path]) -> set[str]:
    found: set[str] = set()
    for package, wrapped, names, plain in _IMPORT.findall(text):
        base = (package or plain).replace(".", "/")
        words = [word.split()[0] for word in (wrapped or names).split(",") if word.split()]
        found.update(f"{candidate}.py" for candidate in (base, *(f"{base}/{word}" for word in words)))
    return found & known.keys()


def get_kernels_ready() -> None:
    """Before a command's first kernel: they match their sources, and at a terminal one sees what must be compiled."""
    forget_stale()
    if sys.stderr.isatty():
        announce_compiling()


def announce_compiling() -> None:
    """From now on whoever sits at a terminal sees which kernel is being compiled."""
    names: list[str] = []

    def tell(name: str) -> None:
        if name:
            names.append(name)
        terminal_line(f"compiling kernels: {len(names)}, {name}" if name else "")

    on_compiling(tell)


def on_compiling(tell: Callable[[str], None]) -> None:
    """From now on `tell` hears the name of each kernel that is compiled, and '' whenever no more is for now.

    Kernels that are compiled already only cost their loading and are not named.
    """
    from numba.core import event

    class Listener(event.Listener):
        under_way = 0  # a kernel that calls others compiles them inside its own compilation

        def on_start(self, happening):
            function = happening.data["dispatcher"].py_func
            self.under_way += 1
            tell(f"{function.__module__}.{function.__qualname__}")

        def on_end(self, happening):
            self.under_way -= 1
            if self.under_way == 0:
                tell("")

    event.register("numba:compile", Listener())


def terminal_line(text: str) -> None:
    """Progress that overwrites itself on a terminal, where it must fit into one line, and is silent in a pipe."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K{text[: shutil.get_terminal_size().columns - 1]}")
        sys.stderr.flush()
