"""Auditor of a run: it looks at the deformed bodies as a user sees them, and knows nothing of contact rows."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.marching.results.finding import BETWEEN, FLAT_CELL, INVERTED, OVERLAP, finding
from softway.marching.results.step import Event
from softway.meshes.cell_shapes import ROUNDING
from softway.record.audit.geometry.bad_cells import bad_cells
from softway.record.audit.geometry.chords import outside
from softway.record.audit.geometry.overlap import overlaps
from softway.record.audit.geometry.solids import Solids, solids
from softway.record.audit.geometry.tools import behind, sunk
from softway.record.write.grid.grid_layout import Grid, blocks, owners

VISIBLE = 1e-3
"""Depth of an overlap, relative to the largest side of the smaller body, from which it is a finding: one pixel in a
picture a thousand pixels wide."""
THIN = 1e-2
"""Depth relative to the shortest line of the boundary, from which it is a finding in thin and finely meshed bodies."""
TOLD = 0.1
"""Share of an overlap from which the finding tells what facets stand out of the curves through their nodes."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Depths:
    """Deepest overlap of all bodies and tools at one instant.

    Parameters
    ----------
    nodes, between
        Deepest overlap at the nodes and between them [m]; zero where nothing overlaps.
    findings
        Findings, one for each pair, kind and body.
    """

    nodes: float
    between: float
    findings: tuple[Event, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Overlap:
    """Deepest place of a body in another one: a ``node`` or near it, at ``place`` (d,), with its ``depth`` [m]."""

    own: str
    other: str
    node: int
    at_node: bool
    place: Array
    depth: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Auditor:
    """Geometric audit of the bodies of a run.

    Parameters
    ----------
    solids
        Deformable bodies.
    tools
        Rigid tools and bodies by name, at the start.
    """

    solids: Solids
    tools: Mapping[str, PlacedShape]

    @cached_property
    def _behind(self) -> dict[str, BoolArray]:
        """Nodes (n,) behind each tool that is an open surface."""
        return {name: behind(self.solids, tool) for name, tool in self.tools.items()}

    @cached_property
    def _outside(self) -> Array:
        """Distance (n,) by which the facets around each node stand out of the curve at rest [m]."""
        return outside(self.solids)

    def look(self, time: float, x: Array, tools: Mapping[str, PlacedShape]) -> Depths:
        """Overlaps and bad cells at a time [s] with the nodes at x (n, d) [m], and the tools at their places."""
        found = [*self._bodies(x), *self._tools(tools, x)]
        nodes = max((f.depth for f in found if f.at_node), default=0.0)
        between = max((f.depth for f in found), default=0.0)
        seen = (self._told(time, f, x) for f in found if f.depth > self._limit(f))
        return Depths(nodes=nodes, between=between, findings=(*seen, *self._bad_cells(time, x)))

    def _limit(self, found: Overlap) -> float:
        """Depth from which an overlap is a finding [m]."""
        names = self.solids.names
        bodies = [names.index(name) for name in (found.own, found.other) if name in names]
        return float(min(VISIBLE * self.solids.extents[bodies].min(), THIN * self.solids.shortest[bodies].min()))

    def _bodies(self, x: Array) -> Iterator[Overlap]:
        """Deepest overlap of each pair of bodies, at nodes and between them."""
        inside = overlaps(self.solids, x)
        if not len(inside.ends):
            return
        node = inside.ends[:, 0]
        first, at_node = self.solids.owner[node], inside.ends[:, 0] == inside.ends[:, 1]
        pairs = np.sort(np.stack([first, inside.body], axis=1), axis=1)
        for a, b in np.unique(pairs, axis=0):
            for kind in (True, False):
                which = np.flatnonzero((pairs == (a, b)).all(axis=1) & (at_node == kind))
                if len(which):
                    k = which[np.argmax(inside.depth[which])]
                    own, other = self.solids.names[first[k]], self.solids.names[inside.body[k]]
                    yield Overlap(own, other, int(node[k]), kind, inside.place[k], float(inside.depth[k]))

    def _tools(self, tools: Mapping[str, PlacedShape], x: Array) -> Iterator[Overlap]:
        """Deepest overlap of each body with each tool, at nodes and between them."""
        for name, tool in tools.items():
            for s in sunk(self.solids, x, tool, self._behind[name]):
                yield Overlap(self.solids.names[s.body], name, s.node, s.at_node, s.place, s.depth)

    def _told(self, time: float, found: Overlap, x: Array) -> Event:
        """Finding of an overlap."""
        node = self._number(found.own, found.node)
        where = (
            f"node {node} of '{found.own}'" if found.at_node else f"the boundary of '{found.own}' near its node {node}"
        )
        what = "the same body" if found.other == found.own else f"'{found.other}'"
        return finding(
            time,
            OVERLAP if found.at_node else BETWEEN,
            sorted((found.own, found.other), key=self._order),
            f"{where} is {found.depth:.3g} m inside {what}{self._chords(found, x)}",
            node=node,
            place=found.place,
            depth=found.depth,
        )

    def _chords(self, found: Overlap, x: Array) -> str:
        """How much of an overlap of two solids may be that of chords alone; empty for a small share.

        Nodes are on the curve of their own surface, places between them are not.
        """
        if found.own == found.other or found.other not in self.solids.names:
            return ""
        solids, body = self.solids, self.solids.names.index(found.other)
        nodes = solids.surface[solids.owner[solids.surface] == body]
        nearest = nodes[np.argmin(np.linalg.norm(x[nodes] - found.place, axis=1))]
        chord = float(self._outside[nearest] + (0.0 if found.at_node else self._outside[found.node]))
        if chord < TOLD * found.depth:
            return ""
        part = f"up to {min(chord, found.depth):.3g} m"
        return f"; of this, {part} is the sagitta of facets, and no overlap of the curves through their nodes"

    def _bad_cells(self, time: float, x: Array) -> Iterator[Event]:
        """Worst cell of each body that has a folded or a flat one."""
        for body, nodes, shape in bad_cells(self.solids, x):
            name, place, folded = self.solids.names[body], x[nodes].mean(axis=0), shape <= ROUNDING
            node = self._number(name, int(nodes[0]))
            what = "is folded" if folded else "is flat"
            text = f"a cell of '{name}' at its node {node} {what}: its scaled Jacobian is {shape:.3g}"
            yield finding(time, INVERTED if folded else FLAT_CELL, (name,), text, node=node, place=place)

    def _order(self, name: str) -> int:
        """Place of a name: bodies in their order, then tools."""
        return [*self.solids.names, *self.tools].index(name)

    def _number(self, body: str, node: int) -> int:
        """Number in its body of a node."""
        return node - int(self.solids.first[self.solids.names.index(body)])


def auditor(cells: Grid, tools: Mapping[str, PlacedShape]) -> Auditor:
    """Auditor of the solids of a grid, and of rigid tools and bodies by name, at their places at the start."""
    reference = cells.reference[:, : cells.dimension]
    return Auditor(solids=solids(cells.bodies, reference, blocks(cells), owners(cells)), tools=tools)
