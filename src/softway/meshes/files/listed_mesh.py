"""Mesh as a file gives it, before unused nodes are dropped, with the list of what it does not hold."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from softway.arrays import Array, IntArray

SHOWN = 6
"""Greatest number of lines that are named for a card."""


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


@dataclass(frozen=True, slots=True, kw_only=True)
class FileTie:
    """Two tags of a mesh file that are glued to each other.

    Parameters
    ----------
    title
        Keyword and name, as in the list of what is not honoured.
    between
        The tags.
    line
        Line of the card.
    """

    title: str
    between: tuple[str, str]
    line: str


@dataclass(frozen=True, slots=True, eq=False)
class ListedMesh:
    """Mesh of a deck or of a Gmsh file.

    Parameters
    ----------
    points
        (n, 3) coordinates of all nodes.
    blocks
        Cell name -> (e, a) numbers of the nodes.
    tags
        Name -> numbers of the nodes: sets of a deck, physical groups of a Gmsh file.
    left_out
        Cards, sections, nodes and groups that are not honoured.
    regions
        Name -> numbers of the cells in the order of the blocks: element sets and materials of a deck, physical groups
        of a Gmsh file.
    ties
        Pairs of tags that are glued.
    """

    points: Array
    blocks: Mapping[str, IntArray]
    tags: Mapping[str, IntArray]
    left_out: tuple[LeftOut, ...]
    regions: Mapping[str, IntArray] = field(default_factory=dict)
    ties: tuple[FileTie, ...] = ()
