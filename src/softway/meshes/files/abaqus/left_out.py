"""List of the cards of a deck that are not honoured."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from softway.meshes.files.abaqus.lexer import Card
from softway.meshes.files.listed_mesh import LeftOut

_QUIET = {
    "HEADING", "PREPRINT", "RESTART", "OUTPUT", "MONITOR", "FILEFORMAT", "PRINT", "TIMEPOINTS", "FACEPRINT",
    "SECTIONPRINT", "SECTIONFILE", "DIAGNOSTICS", "NOANALYSIS", "PARAMETER", "FILTER",
}  # fmt: skip
_REQUESTS = ("NODE", "EL", "ELEMENT", "ENERGY", "CONTACT", "MODAL", "RADIATION", "INCREMENTATION", "INTEGRATED", "NSET")
_VERBS = ("PRINT", "FILE", "OUTPUT")


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
