"""Reader of tables of balls: comma-separated numbers with a header."""

import csv
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from softway.arrays import Array
from softway.errors import InputError

MOST = 10_000_000
"""Greatest number of lines of a table."""
KNOWN = (
    *("x", "y", "z", "radius", "density", "velocity_x", "velocity_y", "velocity_z"),
    *("spin", "spin_x", "spin_y", "spin_z"),
)
"""Columns that a table may have."""


def table_columns(path: Path, needed: Sequence[str]) -> dict[str, Array]:
    """Columns (n,) of a table of balls by name; units in brackets after the names are left out.

    Raises
    ------
    InputError
        If the file cannot be read, or is no such table.
    """
    try:
        if path.exists() and not path.is_file():
            raise InputError("path", f"'{path}' is a folder or a device", "a file of comma-separated numbers")
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = [line for line in islice(csv.reader(file), MOST + 2) if line]
    except FileNotFoundError:
        raise InputError("path", f"there is no file '{path}'", "a path from the folder of the scenario") from None
    except (OSError, ValueError, csv.Error) as error:
        raise InputError("path", f"'{path}' cannot be read: {error}", "comma-separated numbers in UTF-8") from None
    names = [cell.partition("[")[0].strip() for cell in lines[0]] if lines else []
    for name in ("x", "y", *needed):
        if name not in names:
            remedy = f"a header such as {','.join(('x', 'y', *needed))}" + (
                f"; or the key {name} for all balls" if name in needed else ""
            )
            raise InputError("path", f"'{path}' has no column {name!r}", remedy)
    for name in names:
        if name not in KNOWN or names.count(name) > 1:
            problem = f"'{path}' has a column {name!r}" + (" twice" if name in KNOWN else "")
            raise InputError("path", problem, f"columns among {', '.join(KNOWN)}")
    if not 1 < len(lines) <= MOST + 1:
        raise InputError("path", f"'{path}' has {len(lines) - 1} lines of balls", f"1 to {MOST}")
    return _numbers(path, names, lines[1:])


def _numbers(path: Path, names: list[str], lines: list[list[str]]) -> dict[str, Array]:
    """Numbers of the columns."""
    for number, line in enumerate(lines, 2):
        try:
            if len(line) != len(names):
                raise ValueError
            [float(cell) for cell in line]
        except ValueError:
            problem = f"line {number} of '{path}' is {','.join(line)!r:.60}"
            raise InputError("path", problem, f"{len(names)} numbers in SI units, without their units") from None
    return dict(zip(names, np.array(lines, float).T.copy(), strict=True))
