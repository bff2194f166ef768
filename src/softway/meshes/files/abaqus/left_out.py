"""List of the cards of a deck that are not honoured."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from softway.meshes.files.abaqus.lexer import Card

SHOWN = 6
"""Greatest number of lines that are named for a card."""
_QUIET = {
    "HEADING", "PREPRINT", "RESTART", "OUTPUT", "MONITOR", "FILEFORMAT", "PRINT", "TIMEPOINTS", "FACEPRINT",
    "SECTIONPRINT", "SECTIONFILE", "DIAGNOSTICS", "NOANALYSIS", "PARAMETER", "FILTER",
}  # fmt: skip
_REQUESTS = ("NODE", "EL", "ELEMENT", "ENERGY", "CONTACT", "MODAL", "RADIATION", "INCREMENTATION", "INTEGRATED", "NSET")
_VERBS = ("PRINT", "FILE", "OUTPUT")


@dataclass(frozen=True, slots=True, kw_only=True)
class LeftOut:
    """Card of a mesh file that the mesh does not hold.

    Parameters
    ----------
    card
        Keyword and, where it matters, its parameter, such as ``*BOUNDARY`` or ``*ELEMENT, TYPE=SPRINGA``.
    count
        Number of such cards.
    lines
        Lines of the cards, if known; in an included file the name of the file is before the number.
    meaning
        Description of the loss and of what to do; empty if the keyword says enough.
    matters
        False for headings, output requests and markers, which say nothing about the body.

    Examples
    --------
    >>> print(LeftOut(card="*BOUNDARY", count=2, lines=("12", "40")))
    *BOUNDARY (2; lines 12, 40)
    """

    card: str
    count: int
    lines: tuple[str, ...]
    meaning: str = ""
    matters: bool = True

    def __str__(self) -> str:
        """Card, count, lines and meaning in one line."""
        more = ", ..." if len(self.lines) > SHOWN else ""
        where = (
            f"; line{'s' if len(self.lines) > 1 else ''} {', '.join(self.lines[:SHOWN])}{more}" if self.lines else ""
        )
        return f"{self.card} ({self.count}{where})" + (f": {self.meaning}" if self.meaning else "")


@dataclass(frozen=True, slots=True)
class Register:
    """Cards that are not honoured, collected while a deck is read."""

    found: dict[tuple[str, str], tuple[int, list[str], bool]] = field(default_factory=dict)

    def add(
        self, title: str, places: Iterable[str], meaning: str = "", *, matters: bool = True, count: int | None = None
    ) -> None:
        """Add a card; the same one again raises its count."""
        here = list(places)
        before, lines, known = self.found.get((title, meaning), (0, [], False))
        more = len(here) if count is None else count
        self.found[title, meaning] = before + more, lines + here, known or matters

    def card(self, card: Card) -> None:
        """Add a card that no part of the reader honours."""
        self.add(card.title, [card.place], matters=not _is_request(card.name))

    def listed(self) -> tuple[LeftOut, ...]:
        """All entries, those that matter first."""
        made = [
            LeftOut(card=title, count=count, lines=tuple(dict.fromkeys(lines)), meaning=meaning, matters=matters)
            for (title, meaning), (count, lines, matters) in self.found.items()
        ]
        return tuple(sorted(made, key=lambda entry: not entry.matters))


def _is_request(name: str) -> bool:
    """True for headings and output requests."""
    return name in _QUIET or any(name == head + verb for head in _REQUESTS for verb in _VERBS)
