"""Search of the contacts of one slab (time step), with margins that are checked at its end."""

from collections.abc import Sequence
from dataclasses import dataclass

from softway.arrays import Array
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.contact.stencils import NoPairs, PairedSurfaces, SurfacePair
from softway.contact.surfaces.search_margin import SearchMargin


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabSearch:
    """Search from displacement ``u0`` to about ``u1`` (n, d), from ``start`` to ``end`` [s].

    ``margins`` (c,) [m] are those of the contacts, and ``reach`` [m] that of the rows which have an opponent within the
    margin; without margins all rows have their pairs within reach.
    """

    u0: Array
    u1: Array
    start: float
    end: float
    reach: float
    margins: tuple[float, ...] | None

    def apart(self, bounds: Sequence[SearchMargin | None], x0: Array, x1: Array) -> frozenset[int]:
        """Numbers of the contacts whose surfaces stay away from each other on the way from x0 to x1 (n, d)."""
        if self.margins is None:
            return frozenset()
        each = enumerate(zip(bounds, self.margins, strict=True))
        return frozenset(k for k, (m, margin) in each if m is not None and m.apart(x0, x1, margin))

    def all_met(
        self,
        methods: Sequence[NodeToTool | SurfacePair],
        contacts: Sequence[int],
        bounds: Sequence[SearchMargin | None],
        way: tuple[Array, Array],
    ) -> tuple[PairedSurfaces, ...]:
        """Pairs of the methods of ``contacts``, one for each, on the ``way`` between two positions (n, d)."""
        apart = self.apart(bounds, *way) if methods else frozenset()
        return tuple(self.met(m, k, apart, *way) for m, k in zip(methods, contacts, strict=True))

    def met(
        self, method: NodeToTool | SurfacePair, contact: int, apart: frozenset[int], x0: Array, x1: Array
    ) -> PairedSurfaces:
        """Pairs of a method of a contact from positions x0 to about x1 (n, d); none of contacts ``apart``."""
        if isinstance(method, NodeToTool):
            return method.during(self.start, self.end)
        if contact in apart:
            return NoPairs(rows=len(method.node))
        margin = self.reach if self.margins is None else self.margins[contact]
        if margin >= self.reach:
            return method.meet(x0, x1, margin)
        return method.meet(x0, x1, self.reach, margin)

    def wanted(self, bounds: Sequence[SearchMargin | None], deviation: Array) -> tuple[float, ...] | None:
        """Margins (c,) of another search [m], if a ``deviation`` (n,) of the nodes from the expected motion exceeds the
        present ones: twice what was needed.
        """
        if self.margins is None:
            return None
        needed = [0.0 if m is None else m.needed(deviation) for m in bounds]
        if all(n <= m for n, m in zip(needed, self.margins, strict=True)):
            return None
        return tuple(m if n <= m else 2.0 * n for n, m in zip(needed, self.margins, strict=True))
