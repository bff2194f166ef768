"""Element types of Abaqus and CalculiX: the cells that they stand for, and what they mean in a body."""

import re
from dataclasses import dataclass
from typing import Literal

Place = Literal["body", "marker", "other"]

_CELLS = {
    "solid": {"4": "tet4", "8": "hex8", "10": "tet10", "20": "hex20", "6": "wedge6", "15": "wedge15", "5": "pyramid5"},
    "flat": {"3": "tri3", "4": "quad4", "6": "tri6", "8": "quad8", "9": "quad9"},
    "bar": {"2": "bar2", "3": "bar3"},
    "beam": {"1": "bar2", "2": "bar3", "3": "bar2"},
}
"""Cells by the number in the name of the element type; both have the same order of nodes."""
_KINDS: tuple[tuple[re.Pattern[str], str, Place], ...] = (
    (re.compile(r"D?C3D(\d+)[A-Z]*"), "solid", "body"),
    (re.compile(r"(?:CPS|CPEG|CPE|CAX|DC2D|DCAX)(\d)[A-Z]*"), "flat", "body"),
    (re.compile(r"T[23]D(\d)[A-Z]*"), "bar", "body"),
    (re.compile(r"(?:SFM3D|M3D|R3D|STRI|DS|S)(\d)[A-Z]*5?"), "flat", "marker"),
    (re.compile(r"(?:B|PIPE)[23](\d)[A-Z]*"), "beam", "marker"),
    (re.compile(r"R(?:2D|AX)(\d)"), "bar", "marker"),
)
_FACES = {"hex": (4, 5, 2, 1, 3, 0)}


@dataclass(frozen=True, slots=True)
class CellType:
    """Meaning of an element type.

    Parameters
    ----------
    cell
        Name of the cell with the same nodes in the same order; empty if there is none.
    nodes
        Number of nodes; None if it is not known.
    place
        ``body``: a cell of a body; ``marker``: nodes that serve for tags only; ``other``: neither.
    """

    cell: str
    nodes: int | None
    place: Place


_NO_CELL = CellType("", None, "other")


def cell_type(name: str) -> CellType:
    """Meaning of an element type by its name.

    Examples
    --------
    >>> cell_type("cpe4r").cell, cell_type("C3D20R").cell, cell_type("CAX8").cell
    ('quad4', 'hex20', 'quad8')
    >>> cell_type("S4R"), cell_type("SPRINGA")
    (CellType(cell='quad4', nodes=4, place='marker'), CellType(cell='', nodes=None, place='other'))
    """
    for pattern, kind, place in _KINDS:
        if found := pattern.fullmatch(name.upper()):
            cell = _CELLS[kind].get(found[1], "")
            return CellType(cell, int(cell.lstrip("abcdefghijklmnopqrstuvwxyz")), place) if cell else _NO_CELL
    return _NO_CELL


def face_number(cell: str, label: str) -> int | None:
    """Position, among the facets of a cell, of the face with a label such as ``S1``; None for other labels.

    Examples
    --------
    >>> face_number("hex8", "S1"), face_number("tet4", "s4"), face_number("hex8", "SPOS")
    (4, 3, None)
    """
    if not re.fullmatch(r"[SsFf][1-6]", label):
        return None
    order = _FACES.get(cell.rstrip("0123456789"), (0, 1, 2, 3))
    number = int(label[1]) - 1
    return order[number] if number < len(order) else None
