"""provenance.json: software, machine, input and times of a run, and the reason of its stop."""

import hashlib
import json
import logging
import os
import platform
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import MappingProxyType
from typing import Any

from softway.errors import InputError, Note
from softway.record.storage.atomic_file import replaced
from softway.record.storage.lock import written_now

LOG = logging.getLogger(__name__)
FILE = "provenance.json"
ENTRIES: Mapping[str, type] = MappingProxyType({"title": str, "versions": dict, "stop_reason": str, "message": str})
"""Entries of every file, and their types."""
PACKAGES = ("softway", "numpy", "scipy", "h5py", "fenics-basix", "meshio", "pint")
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
PATIENCE = 60.0
"""Time after which git is given up [s]; a busy machine needs seconds for its first answer."""


@dataclass(frozen=True, slots=True)
class Stop:
    """Reason of the stop of a run.

    Parameters
    ----------
    reason
        ``running``, ``done``, ``interrupted``, ``cancelled`` or ``failed``.
    message
        Message of the failure, or the machine on which the run is said to go on if it is another; otherwise empty.
    """

    reason: str
    message: str = ""


RUNNING, DONE, INTERRUPTED, CANCELLED = Stop("running"), Stop("done"), Stop("interrupted"), Stop("cancelled")


def stop_of(folder: Path, read: Callable[[], Mapping[str, Any]]) -> Stop:
    """Reason of the stop of a run; a run whose process ended without a word is ``interrupted``.

    The lock of the folder tells whether a process of this machine still writes.  What another machine does cannot be
    told, and the message says so.

    Parameters
    ----------
    folder
        Folder of the run.
    read
        Function that reads its record; it is called again after the lock was seen to be free, since the run may have
        ended in between.
    """
    record = read()
    if record["stop_reason"] == RUNNING.reason:
        host = record.get("host")
        if host not in (None, platform.node()):
            return Stop(RUNNING.reason, f"on {host}, as far as can be told from here")
        if written_now(folder) is False:
            record = read()
            if record["stop_reason"] == RUNNING.reason:
                return INTERRUPTED
    return Stop(record["stop_reason"], record["message"])


def begin(
    folder: Path, title: str, texts: Mapping[str, str], notes: Sequence[Note] = (), ranks: int = 0
) -> Mapping[str, Any]:
    """Write the file at the start of a run with the input ``texts`` by name and the ``notes`` on it, and the number of
    ``ranks`` if there are any.

    Returns the record for :func:`end`.
    """
    record = {
        "title": title,
        **_surroundings(),
        "host": platform.node(),
        "input": digest(texts),
        "notes": [asdict(note) for note in notes],
        "start": _now(),
        "stop": None,
        "stop_reason": RUNNING.reason,
        "message": "",
        **({"ranks": ranks} if ranks else {}),
    }
    _save(folder, record)
    return record


def end(folder: Path, record: Mapping[str, Any], stop: Stop) -> None:
    """Complete the file at the end of a run."""
    _save(folder, {**record, "stop": _now(), "stop_reason": stop.reason, "message": stop.message})


def resume(folder: Path, record: Mapping[str, Any], slabs: int, time: float) -> Mapping[str, Any]:
    """Note in the file that the run is resumed after ``slabs`` slabs at a time [s]; return the record for :func:`end`.

    An entry of ``resumed`` holds the date, the slab and time of the restart, the reason of the stop, and the changes of
    software and machine.
    """
    now = _surroundings()
    entry = {
        "at": _now(),
        "slabs": slabs,
        "time": time,
        "stopped": INTERRUPTED.reason if record["stop_reason"] == RUNNING.reason else record["stop_reason"],
        "changed": {k: v for k, v in now.items() if record.get(k) != v},
    }
    past = [*record.get("resumed", []), entry]
    here = {"host": platform.node(), "stop": None, "stop_reason": RUNNING.reason, "message": ""}
    again = {**record, "resumed": past, **here}
    _save(folder, again)
    return again


def require_same(folder: Path, record: Mapping[str, Any], texts: Mapping[str, str]) -> None:
    """Refuse to resume a run with another input or version of softway; warn of changes that may affect rounding.

    Raises
    ------
    InputError
        If the scenario or a file that it needs was changed, or if the version of softway is different.
    """
    before, now = record["versions"].get("softway"), _version("softway")
    if record.get("input") != digest(texts):
        what = ", ".join(texts)
        raise InputError(
            str(folder / next(iter(texts))),
            f"differs from the input at the start of the run ({what})",
            "restore the original files, or start a new run: softway run FILE --out FOLDER",
        )
    if before != now:
        remedy = f"pip install softway=={before}, or start a new run: softway run {folder / next(iter(texts))}"
        raise InputError(str(folder), f"was computed with softway {before}, but this is softway {now}", remedy)
    for name, value in _surroundings().items():
        if record.get(name) != value:
            LOG.warning("%s: %s was %s, now %s; the last digits may differ", folder, name, record.get(name), value)


def digest(texts: Mapping[str, str]) -> str:
    """Checksum of the input files of a run."""
    return hashlib.sha256(json.dumps(dict(sorted(texts.items()))).encode()).hexdigest()


def save_json(path: Path, record: Mapping[str, Any]) -> None:
    """Write a JSON file atomically."""
    replaced(path, (json.dumps(record, indent=2) + "\n").encode())


def _save(folder: Path, record: Mapping[str, Any]) -> None:
    save_json(folder / FILE, record)


def _surroundings() -> dict[str, Any]:
    """Software and machine, on which the rounding errors of a computation may depend."""
    return {
        "versions": {"python": platform.python_version(), **{p: v for p in PACKAGES if (v := _version(p))}},
        "platform": {"system": platform.platform(), "machine": platform.machine()},
        "threads": {"processors": os.cpu_count(), **{t: os.environ[t] for t in THREADS if t in os.environ}},
        "commit": _commit(),
    }


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _commit() -> str | None:
    """Commit of the git checkout that tracks this file, if any."""
    here = Path(__file__)
    try:
        _git("ls-files", "--error-unmatch", here.name, folder=here.parent)
        return _git("rev-parse", "HEAD", folder=here.parent)
    except (OSError, subprocess.SubprocessError):
        return None


def _git(*command: str, folder: Path) -> str:
    done = subprocess.run(["git", *command], cwd=folder, capture_output=True, text=True, timeout=PATIENCE, check=True)
    return done.stdout.strip()
