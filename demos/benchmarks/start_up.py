"""How long `brace --help` takes, against a Python that only starts and reads its arguments."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from demos.benchmarks import Benchmark

ROOT = Path(__file__).resolve().parent.parent.parent


def prepare() -> Benchmark:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}

    def run(*words):
        done = subprocess.run([sys.executable, *words], env=environment, capture_output=True, text=True, check=True)
        return done.stdout

    def check(ours, reference):
        assert "capture" in ours
        assert reference == ""

    return Benchmark(
        "brace --help",
        lambda: run("-m", "demos.cli", "--help"),
        "python -c 'import argparse'",
        lambda: run("-c", "import argparse"),
        check,
    )
