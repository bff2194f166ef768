"""Programs in processes of their own, with an environment that holds nothing but what they need."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

HERE = Path(__file__).resolve().parent
KEPT = ("PATH", "HOME", "LANG", "TMPDIR", "TEMP", "SYSTEMROOT", "LD_LIBRARY_PATH", "NUMBA_CACHE_DIR")
COUNTS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
PATIENCE = 900.0
"""Time after which a program is given up [s]."""


class Absent(Exception):
    """A peer that is not installed, or that failed."""


class Failed(Exception):
    """A program of our own that failed."""


def environment(threads: int, **more: str) -> dict[str, str]:
    """The environment of a program that may use so many threads."""
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    return kept | {name: str(threads) for name in COUNTS} | {"MPLBACKEND": "Agg"} | more


def line(command: list[str], environment: dict[str, str]) -> dict[str, Any]:
    """The last line that a program prints, read as JSON; what else it writes, it writes to a folder that goes."""
    settings = {"env": environment, "capture_output": True, "text": True, "timeout": PATIENCE, "check": True}
    try:
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(command, cwd=folder, **settings)
        return dict(json.loads(done.stdout.strip().splitlines()[-1]))
    except (OSError, subprocess.SubprocessError, IndexError, ValueError) as problem:
        told = (getattr(problem, "stderr", None) or str(problem)).strip().splitlines()
        raise Absent(told[-1] if told else type(problem).__name__) from problem


def alone(problem: str, threads: int = 1, variables: dict[str, str] | None = None, **options: Any) -> dict[str, Any]:
    """A problem of ``alone.py``: its ``result``, ``peak`` memory [MB] and the ``elapsed`` time of the process [s]."""
    start = perf_counter()
    command = [sys.executable, str(HERE / "alone.py"), problem, json.dumps(options)]
    try:
        found = line(command, environment(threads, **(variables or {})))
    except Absent as why:
        raise Failed(f"{problem} {options}: {why}") from why
    return found | {"elapsed": perf_counter() - start}
