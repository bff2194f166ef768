"""Numbers of the data lines of a deck."""

from softway.meshes.files.abaqus.lexer import Card

LABEL = "a whole number"


def fields(row: str) -> list[str]:
    """Entries of a data line; the empty one after a comma at the end is left away.

    Examples
    --------
    >>> fields("1, 2,,"), fields("")
    (['1', '2', ''], [''])
    """
    found = [part.strip() for part in row.split(",")]
    return found[:-1] if len(found) > 1 and not found[-1] else found


def whole(card: Card, text: str, default: int | None = None) -> int:
    """Whole number of an entry; the default, if there is one, for an empty entry."""
    if not text and default is not None:
        return default
    try:
        return int(text)
    except ValueError:
        raise card.wrong(f"{text:.40} is not {LABEL}" if text else "a number is missing", LABEL) from None


def real(card: Card, text: str) -> float:
    """Number of an entry, zero for an empty one; the exponent may be marked by D as in Fortran."""
    if not text:
        return 0.0
    try:
        return float(text)
    except ValueError:
        pass
    try:
        return float(text.upper().replace("D", "E"))
    except ValueError:
        raise card.wrong(f"{text:.40} is not a number", "a number such as 1.5, 1e-3 or 1.D-3") from None


def point(card: Card, entries: list[str]) -> tuple[float, float, float]:
    """The first three entries as coordinates; missing ones are zero."""
    x, y, z = (real(card, entries[k]) if k < len(entries) else 0.0 for k in range(3))
    return x, y, z


def padded(row: str, length: int) -> list[str]:
    """Entries of a data line, with empty ones up to a length.

    Examples
    --------
    >>> padded("1, 2", 4)
    ['1', '2', '', '']
    """
    found = fields(row)
    return found + [""] * (length - len(found))


def label_or_name(entry: str) -> int | str:
    """Label, or name of a set without quotes.

    Examples
    --------
    >>> label_or_name("12"), label_or_name('"My set"')
    (12, 'My set')
    """
    return int(entry) if entry.isdecimal() and len(entry) < 20 else entry.strip("\"'")
