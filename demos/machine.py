"""What this machine has of what Brace needs, and what to do about what is missing. `brace doctor` prints it."""

from __future__ import annotations

import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

GOOD, WARNING, MISSING = "good", "warning", "missing"
PYTHONS = ((3, 11), (3, 14))
ROOM_BYTES = 200 * 2**20  # clips, kernels and a minute of video

_GL_PROBE = """
from engine.render.context import make_context
with make_context(headless=True, size=(16, 16)) as context:
    print(context.gl.info["GL_RENDERER"], "|", context.gl.info["GL_VERSION"])
"""
_THREADS_PROBE = """
import numba, numpy
@numba.njit(parallel=True)
def total(x):
    out = 0.0
    for i in numba.prange(len(x)):
        out += x[i]
    return out
total(numpy.ones(8))
print(numba.threading_layer(), "|", numba.get_num_threads())
"""


class Finding(NamedTuple):
    """One line of the report."""

    name: str
    state: str  # good | warning | missing; only `missing` makes the machine unfit
    detail: str
    advice: str = ""


def examine() -> list[Finding]:
    """Every check, in the order in which a newcomer would want to read them. Takes a few seconds: it really tries."""
    return [_python(), _packages(), _graphics(), _display(), _ffmpeg(), _threads(), _clips(), _cache(), _disk()]


def cache_folder() -> Path:
    """Where clips are kept."""
    from engine.clips.library import cache_folder

    return cache_folder()


def _python() -> Finding:
    detail = f"{platform.python_version()} at {sys.executable}"
    if PYTHONS[0] <= sys.version_info[:2] <= PYTHONS[1]:
        return Finding("python", GOOD, detail)
    return Finding("python", MISSING, detail, "use Python 3.11 to 3.14")


def _packages() -> Finding:
    """Whether what the distribution declares is there; a checkout declares it in pyproject.toml."""
    wanted = _declared_packages()
    lost = []
    for name in wanted:
        try:
            metadata.version(name)
        except metadata.PackageNotFoundError:
            lost.append(name)
    if lost:
        return Finding("packages", MISSING, f"not installed: {', '.join(lost)}", "./run doctor, or pip install brace")
    main = ", ".join(f"{name} {metadata.version(name)}" for name in ("numpy", "numba", "mujoco-core", "moderngl"))
    return Finding("packages", GOOD, f"all {len(wanted)}: {main} ...")


def _declared_packages() -> list[str]:
    import tomllib

    checkout = Path(__file__).resolve().parent.parent / "pyproject.toml"
    if checkout.is_file():
        declared = tomllib.loads(checkout.read_text(encoding="utf-8"))["project"]["dependencies"]
    else:
        declared = [line for line in metadata.requires("brace") or [] if "extra ==" not in line]
    return [re.split(r"[^\w.-]", line, maxsplit=1)[0] for line in declared]


def _graphics() -> Finding:
    """Really makes a context, in a process of its own: a broken driver may crash instead of complaining."""
    code, out, trouble = _try_python(_GL_PROBE)
    if code == 0:
        renderer, version = (part.strip() for part in out.split("|"))
        return Finding("graphics", GOOD, f"{renderer}, GL {version}")
    debian = "sudo apt-get install libegl1 libgl1 libx11-6 libxext6"
    advice = debian if shutil.which("apt-get") else "install Mesa's EGL and GL libraries"
    return Finding("graphics", MISSING, trouble or f"the driver ended with code {code}", advice)


def _display() -> Finding:
    for name in ("WAYLAND_DISPLAY", "DISPLAY"):
        if os.environ.get(name):
            return Finding("display", GOOD, f"{name}={os.environ[name]}")
    return Finding("display", WARNING, "none: `brace demo` captures pictures instead of opening a window")


def _ffmpeg() -> Finding:
    path = shutil.which("ffmpeg")
    if path is None:
        try:
            import imageio_ffmpeg

            path = imageio_ffmpeg.get_ffmpeg_exe()
        except (ImportError, RuntimeError):
            return Finding("ffmpeg", MISSING, "neither on PATH nor in imageio-ffmpeg", "sudo apt-get install ffmpeg")
    try:
        told = subprocess.run([path, "-version"], capture_output=True, text=True, timeout=30, check=True).stdout
    except (OSError, subprocess.SubprocessError) as trouble:
        return Finding("ffmpeg", MISSING, f"{path} does not run: {trouble}", "sudo apt-get install ffmpeg")
    return Finding("ffmpeg", GOOD, f"{' '.join(told.split()[1:3])} at {path}")


def _threads() -> Finding:
    """The threading layer of parallel kernels: `workqueue` keeps its pace beside other busy processes."""
    code, out, trouble = _try_python(_THREADS_PROBE)
    if code != 0:
        return Finding("threads", MISSING, trouble or f"a parallel kernel ended with code {code}", "reinstall numba")
    layer, threads = (part.strip() for part in out.split("|"))
    detail = f"{layer}, {threads} threads on {os.cpu_count()} processors"
    if layer == "workqueue":
        return Finding("threads", GOOD, detail)
    return Finding("threads", WARNING, detail, "unset NUMBA_THREADING_LAYER: other layers stutter on a busy machine")


def _clips() -> Finding:
    from engine.clips.library import list_clips

    listed = list_clips()
    ready = [clip.name for clip in listed if clip.ready]
    absent = [clip.name for clip in listed if not clip.ready and not clip.extra]
    if absent:
        return Finding("clips", WARNING, f"{', '.join(ready)}; not here: {', '.join(absent)}", "brace clips fetch")
    return Finding("clips", GOOD, ", ".join(ready))


def _cache() -> Finding:
    folder = cache_folder()
    try:
        with tempfile.TemporaryFile(dir=_existing(folder)):
            pass
    except OSError as trouble:
        return Finding("cache", WARNING, f"{folder}: {trouble.strerror}", "set BRACE_CACHE to another folder")
    used = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()) if folder.exists() else 0
    return Finding("cache", GOOD, f"{folder}, {used / 2**20:.1f} MiB")


def _disk() -> Finding:
    place = _existing(cache_folder())
    free = shutil.disk_usage(place).free
    detail = f"{free / 2**30:.1f} GiB free at {place}"
    return Finding("disk", GOOD, detail) if free >= ROOM_BYTES else Finding("disk", WARNING, detail, "make some room")


def _existing(folder: Path) -> Path:
    """The folder, or the nearest above it that is there."""
    return next(place for place in (folder, *folder.absolute().parents) if place.is_dir())


def _try_python(code: str) -> tuple[int, str, str]:
    """Exit code, output and last line of complaint of a few lines of Python in a process of their own."""
    root = str(Path(__file__).resolve().parent.parent)
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-c", code], capture_output=True, text=True, timeout=120,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))},
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return 124, "", "did not answer within two minutes"
    complaint = done.stderr.strip().splitlines()
    return done.returncode, done.stdout, _without_class(complaint[-1]) if complaint else ""


def _without_class(line: str) -> str:
    return re.sub(r"^[\w.]+: ", "", line)


def as_json(findings: list[Finding]) -> dict[str, Any]:
    """The report for programs."""
    return {
        "fit": all(finding.state != MISSING for finding in findings),
        "checks": [finding._asdict() for finding in findings],
    }
