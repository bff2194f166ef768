"""Quantities of interest: the values of a case, compared with reference and tolerance."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, nan
from typing import Any

import numpy as np

Value = float | Sequence[Any]
"""A number, or nested lists of numbers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """Quantity of interest, compared with its reference.

    Parameters
    ----------
    name
        Name of the quantity.
    reference, value
        Number or nested lists of numbers; ``value`` is None if nothing was computed.
    error
        Greatest difference of an entry; infinite if the shapes differ, ``nan`` if nothing was computed.
    tolerance
        Greatest error that passes.
    worst
        Index of the entry with the greatest error in the flattened values.
    why
        Known cause of a miss.
    """

    name: str
    reference: Value
    value: Value | None
    error: float
    tolerance: float
    worst: int = 0
    why: str = ""

    @property
    def passed(self) -> bool:
        """True if the error is within the tolerance."""
        return self.error <= self.tolerance


def compared(case: Mapping[str, Any], values: Mapping[str, Any]) -> tuple[Quantity, ...]:
    """Compare the values of a case with its references, one quantity for each.

    Parameters
    ----------
    case
        Data of the case. ``qoi`` lists ``name``, ``value``, and ``tol_abs``, ``tol_rel`` or both; the larger tolerance
        is used. ``tol_rel`` is relative to the largest magnitude in the value (or to 1 if that is zero).
    values
        Values by the names of the quantities; other names are ignored.

    Examples
    --------
    >>> asked = [{"name": "force", "value": 2.0, "tol_rel": 0.01}, {"name": "gap", "value": 0.0, "tol_abs": 1e-12}]
    >>> [(q.name, q.passed, q.value) for q in compared({"qoi": asked}, {"force": 2.019})]
    [('force', True, 2.019), ('gap', False, None)]
    """
    return tuple(_compared(asked, values.get(asked["name"])) for asked in case["qoi"])


def _compared(asked: Mapping[str, Any], value: Any) -> Quantity:
    reference = np.atleast_1d(np.asarray(asked["value"], float))
    scale = float(np.max(np.abs(reference))) or 1.0
    found = None if value is None else np.atleast_1d(np.asarray(value, float))
    error, worst = _error(reference, found)
    return Quantity(
        name=asked["name"],
        reference=asked["value"],
        value=None if value is None else np.asarray(value, float).tolist(),
        error=error,
        tolerance=max(asked.get("tol_abs", 0.0), asked.get("tol_rel", 0.0) * scale),
        worst=worst,
        why=asked.get("why", ""),
    )


def _error(reference: Any, found: Any) -> tuple[float, int]:
    """Greatest difference and the index of its entry."""
    if found is None:
        return nan, 0
    if found.shape != reference.shape:
        return inf, 0
    difference = np.abs(found - reference).ravel()
    worst = int(np.argmax(np.where(np.isnan(difference), inf, difference)))
    return float(difference[worst]), worst
