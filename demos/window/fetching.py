"""Clips brought while the window goes on: `brace clips fetch` in a process of its own, which leaves no half file."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMAND = (sys.executable, "-m", "demos.cli", "clips", "fetch", "--extra")
PATIENCE_S = 5.0  # with one that is told to end


class Fetching:
    """One at a time: `begin`, then ask `ended` now and then."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None

    @property
    def going(self) -> bool:
        return self._process is not None

    def begin(self) -> None:
        """Brings every clip of the library that is not here. Does nothing where that is going on."""
        if self._process is None:
            environment = {**os.environ, "PYTHONPATH": str(ROOT)}
            self._process = subprocess.Popen(
                COMMAND, env=environment, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
            )  # fmt: skip

    def ended(self) -> str | None:
        """None while it goes on; then, once, an empty line if all is here, else the one that says why it is not."""
        if self._process is None or self._process.poll() is None:
            return None
        process, self._process = self._process, None
        _, said = process.communicate()
        return "" if process.returncode == 0 else (said.strip().splitlines() or ["error[fetch]: no reason given"])[-1]

    def stop(self) -> None:
        """Ends it; what was brought by half is gone."""
        if self._process is None:
            return
        process, self._process = self._process, None
        process.terminate()
        try:
            process.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
