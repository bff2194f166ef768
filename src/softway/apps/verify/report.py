"""Table of the suite as rows, as text and as JSON."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from softway.apps.verify.quantity import Quantity, Value
from softway.apps.verify.result import Result
from softway.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """Row of the table as text; of an array, the entry with the greatest error is shown."""

    case: str
    quantity: str
    reference: str
    ours: str
    error: str
    tolerance: str
    passed: bool


def rows(results: Iterable[Result]) -> tuple[Row, ...]:
    """Rows of the table, one for each quantity.

    Examples
    --------
    >>> from softway.apps.verify import chosen, examined
    >>> row = rows([examined(chosen(["A01"])[0])])[2]
    >>> row.case, row.reference, row.tolerance, row.passed
    ('A01', '3.46410', '3.5e-06', True)
    """
    return tuple(_row(result, quantity) for result in results for quantity in result.quantities)


def _row(result: Result, quantity: Quantity) -> Row:
    reference, ours = _number(quantity.reference, quantity.worst), _number(quantity.value, quantity.worst)
    many = np.size(quantity.reference)
    return Row(
        case=result.case.id,
        quantity=quantity.name + (f" (worst of {many})" if many > 1 else ""),
        reference=reference,
        ours=ours,
        error=f"{quantity.error:.1e}" if isfinite(quantity.error) else "-",
        tolerance=f"{quantity.tolerance:.1e}",
        passed=quantity.passed,
    )


def _number(value: Value | None, entry: int) -> str:
    """Entry with six digits."""
    if value is None:
        return "-"
    flat = np.ravel(np.asarray(value, float))
    return f"{flat[entry]:#.6g}" if entry < flat.size else "-"


def causes(results: Iterable[Result]) -> tuple[str, ...]:
    """Causes of quantities outside their tolerance and of cases not computed, one sentence each."""
    found = []
    for result in results:
        if result.complaint:
            found.append(f"{result.case.id}: not computed: {result.complaint}")
            continue
        for quantity in result.quantities:
            if not quantity.passed:
                why = quantity.why or "the cause is not known"
                found.append(f"{result.case.id}, {quantity.name}: {why}")
    return tuple(found)


def table(results: Iterable[Result]) -> list[dict[str, Any]]:
    """Table as plain data: case, quantity, reference, value, error, tolerance, pass.

    ``value`` and ``error`` are None if nothing was computed or a number is not finite.
    """
    return [
        {
            "case": result.case.id,
            "quantity": quantity.name,
            "reference": quantity.reference,
            "value": _plain(quantity.value),
            "error": _plain(quantity.error),
            "tolerance": quantity.tolerance,
            "pass": quantity.passed,
        }
        for result in results
        for quantity in result.quantities
    ]


def _plain(value: Value | None) -> Any:
    if isinstance(value, Sequence):
        return [_plain(x) for x in value]
    return value if value is not None and isfinite(value) else None


def in_json(results: Iterable[Result]) -> str:
    """Table as JSON, one quantity per line."""
    lines = ",\n".join(json.dumps(line, allow_nan=False) for line in table(results))
    return f"[\n{lines}\n]\n"


def counts(results: Sequence[Result]) -> Mapping[str, int]:
    """Number of ``cases`` and ``quantities``, of those that ``passed``, and of misses with a ``known`` cause."""
    quantities = [quantity for result in results for quantity in result.quantities]
    return {
        "cases": len(results),
        "quantities": len(quantities),
        "passed": sum(quantity.passed for quantity in quantities),
        "known": sum(bool(q.why) and q.value is not None and not q.passed for q in quantities),
    }


def verdict(results: Sequence[Result]) -> str:
    """Sentence with the number of quantities within their tolerance.

    Examples
    --------
    >>> from softway.apps.verify import chosen, examined
    >>> verdict([examined(chosen(["A01"])[0])])
    '3 of 3 quantities of 1 cases are within their tolerance'
    """
    count = counts(results)
    told = f"{count['passed']} of {count['quantities']} quantities of {count['cases']} cases are within their tolerance"
    return told + (f", {count['known']} are not, with known causes" if count["known"] else "")


def writable(option: str, file: Path) -> Path:
    """Check that a file can be written, and return it.

    Raises
    ------
    InputError
        If it is a folder, or its parent folder does not exist.
    """
    if file.is_dir():
        raise InputError(option, f"'{file}' is a folder", "the name of a file")
    if not file.absolute().parent.is_dir():
        raise InputError(option, f"there is no folder '{file.parent}'", "a folder that exists")
    return file


def write(option: str, file: Path, text: str) -> None:
    """Write a file atomically.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    partial = file.with_name(f".{file.name}.partial")
    try:
        partial.write_text(text, encoding="utf-8")
        partial.replace(file)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise InputError(option, f"cannot write '{file}': {error.strerror}", "a folder that you can write") from None
