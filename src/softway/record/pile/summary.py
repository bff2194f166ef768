"""Summary of the run of a pile, computed from its history, and told in sentences."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from softway.record.storage.table import Table

BALANCED = 1e-9
"""Error of the energy balance relative to the energies that passes for rounding."""


def summarise_pile(history: Table, balls: int) -> dict[str, Any]:
    """Summarise the finished or unfinished run of a pile of a number of balls in a few numbers.

    ``energy_error_worst`` is the largest ``|energy_error|`` [J]; ``energy_error_relative`` is its ratio to the largest
    kinetic energy or change of the potential energy.  ``overlap_worst`` [m] is the greatest overlap at the end of a
    slab, ``slip_error_worst`` [m/s] the greatest velocity by which a contact misses the law of friction, in
    ``unfinished`` slabs.
    """
    if history.rows == 0:
        return {"slabs": 0, "contacts": {}, "findings": []}
    worst, scale = float(np.abs(history["energy_error"]).max()), energy_scale(history)
    return {
        "slabs": int(history["slabs"][-1]),
        "time_end": float(history["time"][-1]),
        "balls": balls,
        "iterations": int(history["sweeps"].sum()),
        "energy_error_worst": worst,
        "energy_error_relative": worst / scale if scale > 0.0 else None,
        "dissipation": float(history["dissipation"][-1]),
        "overlap_worst": float(history["overlap"].max()),
        "slip_error_worst": float(history["slip_error"].max()),
        "unfinished": int(history["unfinished"].sum()),
        "touches": int(history["touches"].sum()),
        "closed_contacts": int(history["closed_contacts"][-1]),
        "energy_kinetic_end": float(history["energy_kinetic"][-1]),
        "contacts": {},
        "findings": [],
        "units": {"time": "s", "energy": "J", "overlap": "m", "slip_error": "m/s"},
    }


def energy_scale(history: Table) -> float:
    """Largest kinetic energy, or change of the potential energy, whichever is larger [J]."""
    return max(float(history["energy_kinetic"].max()), float(np.ptp(history["energy_potential"])))


def told_of_pile(found: Mapping[str, Any]) -> tuple[str, ...]:
    """Sentences that say what happened.

    Examples
    --------
    >>> for sentence in told_of_pile({"slabs": 100, "time_end": 0.5, "balls": 3, "energy_error_worst": 0.0,
    ...                               "energy_error_relative": 0.0, "dissipation": 2.0, "overlap_worst": 1e-13,
    ...                               "slip_error_worst": 0.0, "unfinished": 0, "touches": 4, "closed_contacts": 2}):
    ...     print(sentence)
    3 balls moved for 0.5 s in 100 slabs (time steps); they touched 4 times, 2 contacts are closed at the end.
    They overlapped by at most 1e-13 m.
    The energy balance holds to 0 J, 0 of the energies.
    Impacts and friction dissipated 2 J.
    """
    if not found["slabs"]:
        return ("The balls have not moved yet.",)
    relative = found["energy_error_relative"]
    share = "" if relative is None else f", {relative:.2g} of the energies"
    holds = "holds" if relative is None or relative < BALANCED else "misses, it holds only"
    sentences = [
        f"{found['balls']} balls moved for {found['time_end']:.6g} s in {found['slabs']} slabs (time steps); they "
        f"touched {found['touches']} times, {found['closed_contacts']} contacts are closed at the end.",
        f"They overlapped by at most {found['overlap_worst']:.2g} m.",
        f"The energy balance {holds} to {found['energy_error_worst']:.2g} J{share}.",
    ]
    if found["dissipation"]:
        sentences.append(f"Impacts and friction dissipated {found['dissipation']:.4g} J.")
    if found["unfinished"]:
        sentences.append(
            f"In {found['unfinished']} slabs the sweeps ended before friction met its law; contacts miss it by up to "
            f"{found['slip_error_worst']:.2g} m/s. More of them: pile.sweeps, or a shorter time.step."
        )
    return tuple(sentences)
