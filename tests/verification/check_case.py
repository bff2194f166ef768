"""Compare results with a verification case: ``python check_case.py CASE.json RESULTS.json``.

A case lists quantities of interest: ``name``, ``value`` (a number or nested lists of numbers), and ``tol_abs``,
``tol_rel`` or both; the larger of the two tolerances counts, the relative one times the largest magnitude in the
value.  Results map names to values.
"""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """Outcome for one quantity: ``verdict`` is ``pass``, ``fail`` or ``not given``."""

    name: str
    error: float
    tolerance: float
    verdict: str


def check(case: Mapping[str, Any], results: Mapping[str, Any]) -> list[Row]:
    """One row for each quantity of the case.

    >>> quantities = [{"name": "force", "value": 2.0, "tol_rel": 0.01}, {"name": "gap", "value": 0.0, "tol_abs": 1e-12}]
    >>> [(r.name, r.verdict) for r in check({"qoi": quantities}, {"force": 2.019})]
    [('force', 'pass'), ('gap', 'not given')]
    """
    return [_compared(quantity, results) for quantity in case["qoi"]]


def _compared(quantity: Mapping[str, Any], results: Mapping[str, Any]) -> Row:
    name, reference = quantity["name"], np.atleast_1d(np.asarray(quantity["value"], float))
    scale = float(np.max(np.abs(reference))) or 1.0
    tolerance = max(quantity.get("tol_abs", 0.0), quantity.get("tol_rel", 0.0) * scale)
    if name not in results:
        return Row(name=name, error=np.nan, tolerance=tolerance, verdict="not given")
    value = np.atleast_1d(np.asarray(results[name], float))
    error = float(np.max(np.abs(value - reference))) if value.shape == reference.shape else np.inf
    return Row(name=name, error=error, tolerance=tolerance, verdict="pass" if error <= tolerance else "fail")


def main(arguments: list[str]) -> int:
    """Print a table; 0 when something was compared and nothing failed."""
    if len(arguments) != 2:
        print(__doc__)
        return 2
    case, results = (json.loads(Path(a).read_text(encoding="utf-8")) for a in arguments)
    rows = check(case, results)
    print(f"{case['id']}  {case['title']}")
    for row in rows:
        print(f"  {row.verdict:9}  error {row.error:10.3e}  tolerance {row.tolerance:10.3e}  {row.name}")
    verdicts = {row.verdict for row in rows}
    return 0 if "pass" in verdicts and "fail" not in verdicts else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
