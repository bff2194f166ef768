"""Summary of the heat of a run, computed from its history, and told in sentences."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.record.storage.table import Table
from softway.record.write.history_columns import LIQUID, RIGID

BALANCED = 1e-9
"""Error of the balance of heat, relative to the heat that moved, that passes for rounding."""


def summarise_heat(history: Table) -> dict[str, Any]:
    """Summarise the finished or unfinished run of conductors in a few numbers.

    ``heat_error_worst`` is the largest ``|heat_error|`` [J]; ``entropy_least`` is the least entropy that a slab
    produced [J/K]; ``liquid`` holds the volumes of liquid at the end [m^3].
    """
    if history.rows == 0:
        return {"slabs": 0, "contacts": {}, "findings": []}
    liquid = {name.removeprefix(LIQUID): float(history[name][-1]) for name in history if name.startswith(LIQUID)}
    return {
        "slabs": history.rows - 1,
        "time_end": float(history["time"][-1]),
        "iterations": int(history["iterations"].sum()),
        "heat_content_end": float(history["heat_content"][-1]),
        "heat_in": float(history["heat_in"][-1]),
        "heat_out": float(history["heat_out"][-1]),
        "heat_error_worst": float(abs(history["heat_error"]).max()),
        "heat_error_relative": float(history["heat_error_relative"][-1]),
        "entropy_produced": float(history["entropy_produced"].sum()),
        "entropy_least": float(history["entropy_produced"].min()),
        "liquid": liquid,
        "contacts": {},
        "findings": [],
        "units": {"time": "s", "heat": "J", "liquid": "m^3"},
    }


def dissipated(history: Table) -> Array:
    """Energy (t,) dissipated by friction and material [J]: without what the heat of solids took and may give back.

    Examples
    --------
    >>> columns = {"dissipation": np.array([0.0, 14.5]), "heat.reversible": np.array([0.0, 14.0])}
    >>> dissipated(Table(columns)).tolist(), dissipated(Table({"dissipation": np.ones(1)})).tolist()
    ([0.0, 0.5], [1.0])
    """
    given = history.get("heat.reversible", 0.0)  # earlier versions lack it
    return np.asarray(history["dissipation"] - given)


def summarise_solids(history: Table) -> dict[str, float]:
    """Summarise the heat of the solids of a run; empty if they have none.

    ``error_worst`` is the largest error of the balance of energy and heat [J], ``entropy_least`` the least entropy that
    a slab produced [J/K]; at the end, the heat content [J], volumes of liquid [m^3] and temperatures of rigid bodies
    [K].
    """
    if "heat.content" not in history:
        return {}
    ends = [name for name in history if name.startswith((LIQUID, RIGID))]
    entropy = history["heat.entropy"]  # produced since the start
    return {
        **{f"heat_{name}": float(history[f"heat.{name}"][-1]) for name in ("brought", "received", "friction")},
        **({"heat_reversible": float(history["heat.reversible"][-1])} if "heat.reversible" in history else {}),
        "heat_content_end": float(history["heat.content"][-1]),
        "cold_work": float(history["heat.cold_work"][-1]),
        "heat_error_worst": float(abs(history["heat.error"]).max()),
        "entropy_produced": float(entropy[-1]),
        "entropy_least": float(np.diff(entropy, prepend=0.0).min()),
        **{name: float(history[name][-1]) for name in ends},
    }


def told_of_heat(found: Mapping[str, Any]) -> tuple[str, ...]:
    """Sentences that say what happened.

    Examples
    --------
    >>> for sentence in told_of_heat({"slabs": 10, "time_end": 60.0, "heat_in": 5.0, "heat_out": 0.0,
    ...                               "heat_error_worst": 0.0, "heat_error_relative": 0.0, "entropy_produced": 2.0,
    ...                               "entropy_least": 0.1, "liquid": {"pond": 0.25}}):
    ...     print(sentence)
    Heat was conducted for 60 s in 10 slabs (time steps): 5 J came in, 0 J went out.
    The balance of heat holds to 0 J, 0 of the heat that moved.
    The slabs produced 2 J/K of entropy, by conduction and by their length, and none of them less than none.
    Of pond 0.25 m^3 are liquid at the end.
    """
    if not found["slabs"]:
        return ("No heat has been conducted yet.",)
    falls = found["entropy_least"] < -BALANCED * abs(found["entropy_produced"])
    least = f"but one of them {found['entropy_least']:.2g} J/K" if falls else "and none of them less than none"
    holds = "holds" if found["heat_error_relative"] < BALANCED else "misses, it holds only"
    return (
        f"Heat was conducted for {found['time_end']:.6g} s in {found['slabs']} slabs (time steps): "
        f"{found['heat_in']:.6g} J came in, {found['heat_out']:.6g} J went out.",
        f"The balance of heat {holds} to {found['heat_error_worst']:.2g} J, "
        f"{found['heat_error_relative']:.2g} of the heat that moved.",
        f"The slabs produced {found['entropy_produced']:.4g} J/K of entropy, by conduction and by their length, "
        f"{least}.",
        *(f"Of {name} {volume:.6g} m^3 are liquid at the end." for name, volume in found["liquid"].items()),
    )
