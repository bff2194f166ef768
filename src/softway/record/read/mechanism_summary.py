"""Summary of the run of a mechanism, computed from its history and the events of its stops, and told in sentences."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from softway.record.storage.table import Table

KINDS = MappingProxyType(
    {"touches": "touch", "rests": "rest", "releases": "release", "jams": "jam", "slips": "slip", "sticks": "stick"}
)
BALANCED = 1e-9
"""Error of the energy balance relative to the energies that passes for rounding."""

ROUNDED = 1e-6
"""Change of a velocity or spin at the start relative to the greatest one that passes for rounding of what is given."""


def summarise_mechanism(history: Table, motion: Table, events: Table, outline: Mapping[str, Any]) -> dict[str, Any]:
    """Summarise the finished or unfinished run of a mechanism in a few numbers.

    ``outline`` names the stops and the given motion.  ``energy_error_worst`` is the largest ``|energy_error|`` [J];
    ``energy_error_relative`` is its ratio to the largest kinetic energy, or change of the potential energy or work,
    whichever is larger.  ``joint_error_worst`` [m] and ``joint_velocity_error_worst`` [m/s] are the largest errors of
    the joints.  ``velocity_change_start`` [m/s] and ``spin_change_start`` [rad/s] are the largest changes of given
    velocities and spins by joints and impacts at the start.  ``stops`` counts the events of each stop, with the
    instants of the first touch and of the last release [s], and the sum of the impulses of its impacts [N s].
    """
    if history.rows == 0:
        return {"slabs": 0, "contacts": {}, "stops": {}, "findings": []}
    worst = float(np.abs(history["energy_error"]).max())
    scale = energy_scale(history)
    names = dict.fromkeys(
        [*(str(stop["name"]) for stop in outline["stops"]), *(str(name) for name in events["contact"])]
    )
    return {
        "slabs": int(history["slabs"][-1]),
        "time_end": float(history["time"][-1]),
        "iterations": int(history["iterations"].sum()),
        "energy_error_worst": worst,
        "energy_error_relative": worst / scale if scale > 0.0 else None,
        "dissipation": float(history["dissipation"][-1]),
        "work_external": float(history["work_external"][-1]),
        "joint_error_worst": float(history["joint_error"].max()),
        "joint_velocity_error_worst": float(history["joint_velocity_error"].max()),
        **_changes(motion, outline),
        "contacts": {},
        "stops": {name: _stop(name, events) for name in names},
        "findings": [],
        "units": {"time": "s", "energy": "J", "joint": "m", "impulse": "N s"},
    }


def _changes(motion: Table, outline: Mapping[str, Any]) -> dict[str, float]:
    """Largest changes of the given velocities [m/s] and spins [rad/s] at the start; zero where they are rounding."""
    if not motion.rows:
        return {"velocity_change_start": 0.0, "spin_change_start": 0.0}
    axes = "xyz"[: outline["dim"]]
    size = float(np.ptp([*outline["bodies"].values(), *_points(outline)], axis=0).max())
    velocity, quick = _change(motion, outline["velocities"], [f"velocity_{a}" for a in axes])
    spin, turning = _change(motion, outline["spins"], ["spin"] if len(axes) == 2 else [f"spin_{a}" for a in axes])
    return {
        "velocity_change_start": velocity if velocity > ROUNDED * max(quick, turning * size) else 0.0,
        "spin_change_start": spin if spin > ROUNDED * max(turning, quick / size if size else 0.0) else 0.0,
    }


def _points(outline: Mapping[str, Any]) -> list[list[float]]:
    """Points of the joints, stops and springs."""
    return [point for key in ("joints", "stops", "springs") for part in outline[key] for point in part["points"]]


def _change(motion: Table, given: Mapping[str, Sequence[float]], columns: Sequence[str]) -> tuple[float, float]:
    """Largest change of a vector of a body at the start, and the largest vector."""
    pairs = [
        (np.asarray(vector, float), np.array([motion[f"{name}.{column}"][0] for column in columns]))
        for name, vector in given.items()
    ]
    change = max(float(np.linalg.norm(after - before)) for before, after in pairs)
    return change, max(float(np.linalg.norm(vector)) for pair in pairs for vector in pair)


def energy_scale(history: Table) -> float:
    """Largest kinetic energy, change of the potential energy, or work of torques, whichever is larger [J]."""
    changes = (history["energy_kinetic"], np.ptp(history["energy_potential"]), history["work_external"])
    return max(float(np.abs(values).max()) for values in changes)


def _stop(name: str, events: Table) -> dict[str, Any]:
    mine = events["contact"] == name
    found: dict[str, Any] = {key: int((mine & (events["kind"] == kind)).sum()) for key, kind in KINDS.items()}
    touched, released = (events["time"][mine & (events["kind"] == kind)] for kind in ("touch", "release"))
    found["first_touch"] = float(touched.min()) if len(touched) else None
    found["last_release"] = float(released.max()) if len(released) else None
    found["impulse"] = float(events["impulse"][mine].sum())
    return found


def told(found: Mapping[str, Any]) -> tuple[str, ...]:
    """Sentences that say what happened.

    Examples
    --------
    >>> stop = {"touches": 2, "rests": 1, "releases": 0, "jams": 0, "first_touch": 0.25, "last_release": None,
    ...         "impulse": 1.5}
    >>> for sentence in told({"slabs": 10, "time_end": 0.5, "energy_error_worst": 0.0, "energy_error_relative": 0.0,
    ...                       "dissipation": 2.0, "work_external": 0.0, "joint_error_worst": 1e-17,
    ...                       "velocity_change_start": 0.0, "spin_change_start": 0.0, "stops": {"floor": stop}}):
    ...     print(sentence)
    The mechanism moved for 0.5 s in 10 slabs (time steps).
    The joints hold to 1e-17 m.
    The energy balance holds to 0 J, 0 of the energies.
    Impacts, friction and dampers dissipated 2 J.
    The stop 'floor' was touched 2 times, first at 0.25 s, with impulses of 1.5 N s in all; it came to rest once.
    """
    if not found["slabs"]:
        return ("The mechanism has not moved yet.",)
    relative = found["energy_error_relative"]
    share = "" if relative is None else f", {relative:.2g} of the energies"
    holds = "holds" if relative is None or relative < BALANCED else "misses, it holds only"
    sentences = [
        f"The mechanism moved for {found['time_end']:.6g} s in {found['slabs']} slabs (time steps).",
        f"The joints hold to {found['joint_error_worst']:.2g} m.",
        f"The energy balance {holds} to {found['energy_error_worst']:.2g} J{share}.",
    ]
    changes = [
        f"{word} by up to {found[key]:.4g} {unit}"
        for key, word, unit in (("velocity_change_start", "velocities", "m/s"), ("spin_change_start", "spins", "rad/s"))
        if found[key]
    ]
    if changes:
        sentences.insert(0, f"Joints or stops changed the motion given at the start: {' and '.join(changes)}.")
    if abs(found["dissipation"]) > found["energy_error_worst"]:
        sentences.append(f"Impacts, friction and dampers dissipated {found['dissipation']:.4g} J.")
    if found["work_external"]:
        sentences.append(f"Forces, torques and motors did work of {found['work_external']:.4g} J.")
    return (*sentences, *(_of_stop(name, stop) for name, stop in found["stops"].items()))


def _of_stop(name: str, stop: Mapping[str, Any]) -> str:
    """Sentence on a stop."""
    parts = []
    if not stop["touches"] and not stop["rests"]:
        parts.append("had no touch" + ("" if stop["releases"] else ": what was open or closed there stayed so"))
    if stop["touches"]:
        first = f", first at {stop['first_touch']:.6g} s" if stop["touches"] > 1 else f" at {stop['first_touch']:.6g} s"
        parts.append(f"was touched {_times(stop['touches'])}{first}, with impulses of {stop['impulse']:.4g} N s in all")
    if stop["rests"]:
        parts.append(f"{'it ' if parts else ''}came to rest {_times(stop['rests'])}")
    if stop["releases"]:
        parts.append(f"it was released {_times(stop['releases'])}, last at {stop['last_release']:.6g} s")
    if stop.get("slips") or stop.get("sticks"):
        begun, ended = _times(stop["slips"]), _times(stop["sticks"])
        parts.append(f"its sliding began {begun} and ended {ended}")
    if stop.get("jams"):
        parts.append(f"its sliding jammed {_times(stop['jams'])}: it ended at once, without a touch")
    return f"The stop '{name}' {'; '.join(parts)}."


def _times(count: int) -> str:
    return {0: "never", 1: "once"}.get(count, f"{count} times")
