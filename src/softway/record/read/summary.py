"""summary.json: a few numbers of a run, computed from its history and its contact events."""

from collections.abc import Mapping
from math import isfinite
from types import MappingProxyType
from typing import Any

import numpy as np

from softway.record.read.findings import gathered, stored
from softway.record.read.heat_summary import dissipated, summarise_solids
from softway.record.storage.table import Table
from softway.record.write.events import MESH
from softway.record.write.history_columns import NODES

FILE = "summary.json"
ENTRIES: Mapping[str, type] = MappingProxyType({"slabs": int, "contacts": dict})
"""Entries of every file, and their types."""
LEAST = ("min_gap", "min_force")
LEFT = ("complementarity", "power_residual", "momentum_error", "energy_error")

UNITS: Mapping[str, str] = MappingProxyType(
    {
        "time_end": "s",
        "slab_shortest": "s",
        "slab_longest": "s",
        "energy_error_worst": "J",
        "energy_error_relative": "ratio",
        "dissipation": "J",
        "work_external": "J",
        "penetration_worst": "m",
        "penetration_nodes": "m",
        "penetration_between": "m",
        "shape_worst": "ratio",
        "power_residual_worst": "J",
        "wall_time": "s",
        "min_gap": "m",
        "min_force": "N",
        "complementarity": "J",
        "power_residual": "J",
        "momentum_error": "kg m/s",
        "energy_error": "J",
        "first_touch": "s",
        "last_release": "s",
        "impulse": "N s",
        "peak_force": "N",
        "peak_force_time": "s",
        "joint_error_worst": "m",
        "joint_velocity_error_worst": "m/s",
        "velocity_change_start": "m/s",
        "spin_change_start": "rad/s",
    }
)
"""Units of all numbers that are not counts."""


def summarise(history: Table, events: Table) -> dict[str, Any]:
    """Summarise a finished or unfinished run in a few numbers.

    ``slab_shortest`` and ``slab_longest`` are lengths of slabs (time steps) [s]; ``energy_error_worst`` is the largest
    ``|energy_error|`` [J]; ``energy_error_relative`` is its ratio to the largest sum of kinetic and strain energy;
    ``dissipation`` is that of friction and material, in solids with a temperature without the column
    ``heat.reversible`` [J]; ``penetration_worst`` is the largest penetration of a contact row at the end of a slab [m].
    ``penetration_nodes`` and ``penetration_between`` are the deepest overlaps of any two surfaces, at nodes and between
    them, in the slabs that were audited [m]; ``shape_worst`` is the least scaled Jacobian of the cells of solids
    of large strain, zero or less where one has folded; ``heat`` is that of solids with a temperature,
    ``findings`` are those of the audit.  ``mesh``, in runs whose meshes change, holds the number of the slabs before
    which a mesh changed, and the greatest and the mean number of the nodes of all solids.
    """
    if history.rows == 0:
        return {"slabs": 0, "contacts": {}, "findings": []}
    worst = float(np.abs(history["energy_error"]).max())
    scale = float((history["energy_kinetic"] + history["energy_strain"]).max())
    contacts = {label: _contact(label, history, events) for label in contacts_of(history)}
    return {
        "slabs": int((history["h"] > 0.0).sum()),
        **_lengths(history),
        "time_end": float(history["time"][-1]),
        "iterations": int(history["iterations"].sum()),
        "energy_error_worst": worst,
        "energy_error_relative": worst / scale if scale > 0.0 else None,
        "dissipation": float(dissipated(history)[-1]),
        "work_external": float(history["work_external"][-1]),
        "penetration_worst": max((c["penetration_worst"] for c in contacts.values()), default=0.0),
        "power_residual_worst": max((c["power_residual_worst"] for c in contacts.values()), default=0.0),
        "penetration_nodes": _deepest("certificate.gap_nodes", history),
        "penetration_between": _deepest("certificate.gap_between", history),
        "shape_worst": _least("certificate.shape", history),
        "certificate": _certificate(history),
        "contacts": contacts,
        "heat": summarise_solids(history),
        "mesh": _changes(history, events),
        "findings": gathered(stored(events)),
        "units": {"time": "s", "energy": "J", "penetration": "m", "impulse": "N s", "force": "N"},
    }


def _lengths(history: Table) -> dict[str, float]:
    """Lengths of the shortest and of the longest slab [s]; none before the first slab."""
    spans = history["h"][history["h"] > 0.0]
    return {"slab_shortest": float(spans.min()), "slab_longest": float(spans.max())} if len(spans) else {}


def _changes(history: Table, events: Table) -> dict[str, Any]:
    """Changes of the meshes of a run; empty where meshes stay."""
    if NODES.name not in history:
        return {}
    nodes = history[NODES.name]
    changes = len(np.unique(events["time"][events["kind"] == MESH]))
    return {
        "changes": changes,
        "most_nodes": int(nodes.max()),
        "mean_nodes": float(nodes[min(1, history.rows - 1) :].mean()),
    }


def status(reason: str, found: Mapping[str, Any]) -> str:
    """Reason of the stop of a run with the summary ``found``: ``done, with findings`` if its audit found something.

    Examples
    --------
    >>> status("done", {"findings": []}), status("done", {"findings": [{"kind": "overlap"}]})
    ('done', 'done, with findings')
    """
    return f"{reason}, with findings" if found.get("findings") else reason


def _deepest(name: str, history: Table) -> float | None:
    """Deepest overlap that the audit has seen [m]; None if nothing was audited."""
    least = _least(name, history)
    return None if least is None else max(0.0, -least)


def _least(name: str, history: Table) -> float | None:
    """Least of the numbers of a column; None if there is none."""
    values = history[name] if name in history else np.zeros(0)
    seen = values[~np.isnan(values)]
    return float(seen.min()) if len(seen) else None


def _certificate(history: Table) -> dict[str, float | None]:
    """Worst residuals of the contact conditions and balances over all slabs."""
    worst = {name: float(np.abs(history[f"certificate.{name}"]).max()) for name in LEFT}
    least = {name: float(history[f"certificate.{name}"].min()) for name in LEAST}
    return {name: value if isfinite(value) else None for name, value in (least | worst).items()}


def contacts_of(history: Table) -> tuple[str, ...]:
    """Names of the contacts that have columns in a history.

    Examples
    --------
    >>> contacts_of(Table({"time": np.zeros(1), "contact.bar.right-wall.force_n": np.zeros(1)}))
    ('bar.right-wall',)
    """
    return _labels(history, "contact.", ".force_n")


def ties_of(history: Table) -> tuple[str, ...]:
    """Labels of the ties that break of a run.

    Examples
    --------
    >>> ties_of(Table({"time": np.zeros(1), "tie.a.top-b.bottom.broken": np.zeros(1)}))
    ('a.top-b.bottom',)
    """
    return _labels(history, "tie.", ".broken")


def _labels(history: Table, head: str, tail: str) -> tuple[str, ...]:
    """Labels between the head and the tail of the names of columns."""
    return tuple(c[len(head) : -len(tail)] for c in history if c.startswith(head) and c.endswith(tail))


def _contact(label: str, history: Table, events: Table) -> dict[str, Any]:
    force, gap = history[f"contact.{label}.force_n"], history[f"contact.{label}.min_gap"]
    peak = int(np.argmax(np.abs(force)))
    return {
        "first_touch": _instant(label, "touch", 0, events),
        "last_release": _instant(label, "release", -1, events),
        "touches": _count(label, "touch", events),
        "releases": _count(label, "release", events),
        "impulse": float((force * history["h"]).sum()),
        "peak_force": float(force[peak]),
        "peak_force_time": float(history["time"][peak]),
        "penetration_worst": max(0.0, -float(gap.min())) if isfinite(gap.min()) else 0.0,
        "power_residual_worst": float(np.abs(history[f"contact.{label}.power_residual"]).max()),
    }


def _chosen(label: str, kind: str, events: Table) -> np.ndarray[Any, np.dtype[np.bool_]]:
    return np.asarray((events["contact"] == label) & (events["kind"] == kind))


def _instant(label: str, kind: str, which: int, events: Table) -> float | None:
    times = np.sort(events["time"][_chosen(label, kind, events)])
    return float(times[which]) if len(times) else None


def _count(label: str, kind: str, events: Table) -> int:
    return int(_chosen(label, kind, events).sum())
