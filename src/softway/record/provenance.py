"""provenance.json: what computed a run, when, and why it stopped."""

import json
import os
import platform
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

FILE = "provenance.json"
PACKAGES = ("softway", "numpy", "scipy", "h5py", "fenics-basix", "meshio", "pint")
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, slots=True)
class Stop:
    """Why a run stopped.

    Parameters
    ----------
    reason
        ``running``, ``done``, ``interrupted`` or ``failed``.
    message
        What failed, or nothing.
    """

    reason: str
    message: str = ""


RUNNING, DONE, INTERRUPTED = Stop("running"), Stop("done"), Stop("interrupted")


def begin(folder: Path, title: str) -> Mapping[str, Any]:
    """Write the file at the start of a run; returns what :func:`end` completes."""
    record = {
        "title": title,
        "versions": {"python": platform.python_version(), **{p: v for p in PACKAGES if (v := _version(p))}},
        "platform": {"system": platform.platform(), "machine": platform.machine()},
        "threads": {"processors": os.cpu_count(), **{t: os.environ[t] for t in THREADS if t in os.environ}},
        "commit": _commit(),
        "start": _now(),
        "stop": None,
        "stop_reason": RUNNING.reason,
        "message": "",
    }
    _save(folder, record)
    return record


def end(folder: Path, record: Mapping[str, Any], stop: Stop) -> None:
    """Complete the file at the end of a run."""
    _save(folder, {**record, "stop": _now(), "stop_reason": stop.reason, "message": stop.message})


def save_json(path: Path, record: Mapping[str, Any]) -> None:
    """Write a whole file or none: readers never see half of it."""
    partial = path.with_name(f".{path.name}.partial")
    partial.write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")
    partial.replace(path)


def _save(folder: Path, record: Mapping[str, Any]) -> None:
    save_json(folder / FILE, record)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _commit() -> str | None:
    """Commit of the checkout that this file is tracked in, if any."""
    here = Path(__file__)
    try:
        _git("ls-files", "--error-unmatch", here.name, folder=here.parent)
        return _git("rev-parse", "HEAD", folder=here.parent)
    except (OSError, subprocess.SubprocessError):
        return None


def _git(*command: str, folder: Path) -> str:
    done = subprocess.run(["git", *command], cwd=folder, capture_output=True, text=True, timeout=5, check=True)
    return done.stdout.strip()
