"""Report of a race: a record of plain numbers, a JSON file and a picture."""

import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from softway.errors import InputError
from softway.record.storage.provenance import THREADS, save_json
from softway.record.view.plots.comparison import picture
from softway.solve.methods.newton import Newton
from softway.studies.race.penalty import Penalty
from softway.studies.race.result import Entrant, Result

FILE, PICTURE = "race.json", "race.png"


def record(results: Sequence[Result], title: str = "", scenario: str = "") -> dict[str, Any]:
    """Record of all numbers of a race, ready for JSON.

    Parameters
    ----------
    results
        Results of a contest. Distances refer to the final state of the method with the fewest rejected slabs.
    title, scenario
        Title, and text of the scenario.

    Examples
    --------
    >>> record((), title="nobody")["title"]
    'nobody'
    """
    ahead = min((r for r in results if not r.reason and r.laps), key=lambda r: r.rejected, default=None)
    return {
        "title": title,
        "versions": {"python": platform.python_version(), **{p: _version(p) for p in ("softway", "numpy", "scipy")}},
        "machine": platform.machine(),
        "threads": {"processors": os.cpu_count(), **{t: os.environ[t] for t in THREADS if t in os.environ}},
        "scenario": scenario,
        "reference": ahead.name if ahead is not None else None,
        "methods": {r.name: _numbers(r, ahead) for r in results},
    }


def save(found: Mapping[str, Any], folder: Path) -> tuple[Path, Path]:
    """Write the record of a race and its picture into a folder.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    files = folder / FILE, folder / PICTURE
    try:
        folder.mkdir(parents=True, exist_ok=True)
        save_json(files[0], found)
    except OSError as error:
        raise InputError("out", f"cannot write '{files[0]}': {error.strerror}", "a folder that you can write") from None
    picture(found, files[1])
    return files


def described(method: Entrant) -> str:
    """Description of a method.

    Examples
    --------
    >>> described(Newton()), described(Penalty())
    ('Newton', 'penalty Newton, springs of 50 E A / l, force of a slab: last')
    """
    match method:
        case Penalty():
            return f"penalty Newton, springs of {method.stiffness:g} E A / l, force of a slab: {method.mean}"
        case Newton():
            return "Newton" if method.renew == "iterate" else "modified Newton: one factor per slab"
    depth = getattr(method, "depth", None)
    if depth is None:
        return "central differences"
    return "accelerated fixed point" if depth else "plain fixed point"


def _numbers(result: Result, ahead: Result | None) -> dict[str, Any]:
    """Totals and single slabs of a method."""
    taken = result.iterations
    return {
        "method": described(result.method),
        "tolerance": getattr(result.method, "tolerance", None),
        "slabs": len(result.laps),
        "iterations_mean": float(taken.mean()) if len(taken) else None,
        "iterations_max": int(taken.max(initial=0)),
        "factorisations": result.factorisations,
        "rejected": result.rejected,
        "wall": result.wall,
        "cpu": result.cpu,
        "first_slab_cpu": result.first,
        "slab_cpu": result.usual,
        "energy_drift": result.drift,
        "penetration": result.penetration,
        "least_force": result.least_force,
        "distance": _distance(result, ahead),
        "reason": result.reason,
        "initial_energy": result.initial,
        "laps": [asdict(lap) for lap in result.laps],
    }


def _distance(result: Result, ahead: Result | None) -> float | None:
    """Greatest distance of a node from its final position in the reference [m]; None if the end was not reached."""
    if ahead is None or result.reason or not result.laps:
        return None
    there = ahead.displacement
    return max(float(np.abs(u - there[name]).max()) for name, u in result.displacement.items())


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
