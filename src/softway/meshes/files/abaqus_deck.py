"""Conversion of Abaqus and CalculiX input decks to the form that the mesh reader understands."""

import re
from pathlib import Path

from softway.errors import InputError

_PLANE = {"3": "CPS3", "4": "CPS4", "6": "STRI65", "8": "S8R", "9": "S9R5"}
_TYPES = (
    (re.compile(r"(?:CPS|CPEG|CPE|CAX|M3D|R3D|DC2D|DCAX|S)(3|4|6|8|9)[A-Z]*"), _PLANE),
    (re.compile(r"D?C3D(4|6|8|10|15|20)[A-Z]*"), {n: f"C3D{n}" for n in ("4", "6", "8", "10", "15", "20")}),
    (re.compile(r"T[23]D(2|3)[A-Z]*"), {"2": "T3D2", "3": "T3D3"}),
)

DEEPEST = 8
"""Greatest number of levels of included files."""


def plain_type(name: str) -> str:
    """Element type with the same cell that the reader knows.

    Types for plane strain, axial symmetry and membranes become types for plane stress.

    Examples
    --------
    >>> plain_type("cpe4r"), plain_type("CPS6"), plain_type("C3D10T"), plain_type("B31")
    ('CPS4', 'STRI65', 'C3D10', 'B31')
    """
    for pattern, known in _TYPES:
        if found := pattern.fullmatch(name.upper()):
            return known[found[1]]
    return name.upper()


def plain_deck(path: Path, within: tuple[Path, ...] = ()) -> tuple[str, list[str | None]]:
    """Text of a deck with its included files, known element types, and every block of elements in a set of its own.

    Returns
    -------
    text, names
        The sets of the blocks of elements are called ``block 0``, ``block 1``, ...; ``names`` holds their names in the
        deck.
    """
    if not path.is_file() or len(within) > DEEPEST:
        raise InputError("path", f"no such file: {path}", "correct the path of the included file")
    within = (*within, path.resolve())
    if within[-1] in within[:-1]:
        raise InputError("path", f"{path} includes itself", "remove the *INCLUDE line")
    lines: list[str] = []
    names: list[str | None] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        keyword, *options = (part.strip() for part in line.split(","))
        values = {key.strip().upper(): value.strip() for key, _, value in (option.partition("=") for option in options)}
        match keyword.upper().replace(" ", ""):
            case "*INCLUDE":
                text, more = plain_deck(path.parent / values.get("INPUT", "").strip('"'), within)
                for k in reversed(range(len(more))):
                    text = text.replace(f"ELSET=block {k}\n", f"ELSET=block {k + len(names)}\n")
                lines.append(text.rstrip("\n"))
                names += more
            case "*ELEMENT" if "TYPE" in values:
                lines.append(f"*ELEMENT, TYPE={plain_type(values['TYPE'])}, ELSET=block {len(names)}")
                names.append(values.get("ELSET"))
            case _:
                lines.append(line)
    return "\n".join(lines) + "\n", names
