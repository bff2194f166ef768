"""What a run is asked for."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from record.figures import Figure

T = TypeVar("T")
CELLS = {"3k": 9, "30k": 20, "100k": 31, "300k": 46}
"""Cells along the edge of the cube, by the number of unknowns."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """How much is measured, and by what.

    Parameters
    ----------
    depth
        ``quick``, ``default``, ``full`` or ``smoke``, which computes all of ``full`` with the smallest meshes.
    peers
        Interpreter of each peer that is installed.
    peers_threads
        Numbers of threads that the peers try; the fastest counts.
    stored
        Figures of an earlier run.
    """

    depth: str = "default"
    peers: Mapping[str, str] = field(default_factory=dict)
    peers_threads: tuple[int, ...] = (1, 2)
    stored: Mapping[str, Figure] = field(default_factory=dict)

    @property
    def smoke(self) -> bool:
        """Whether the figures only have to be computed."""
        return self.depth == "smoke"

    def pick(self, quick: T, default: T, full: T | None = None) -> T:
        """The one for the depth."""
        most = default if full is None else full
        return {"quick": quick, "default": default, "full": most, "smoke": most}[self.depth]

    def size(self, wanted: int, least: int) -> int:
        """A number of cells, slabs or repeats, or the least that will do."""
        return least if self.smoke else wanted

    def cells(self, size: str) -> int:
        """Cells along the edge of the cube of so many unknowns."""
        return self.size(CELLS[size], 2 + list(CELLS).index(size))
