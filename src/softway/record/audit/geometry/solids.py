"""Deformable bodies as the audit sees them: cells, boundary facets, and the flat pieces of the boundary."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.squares.inner_facets import beside_smaller
from softway.meshes.cells import CELLS, FACETS, FLAT
from softway.meshes.element import tabulate


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Block:
    """Cells of one type.

    Parameters
    ----------
    cell
        Name of the cell.
    nodes
        (e, a) nodes of each cell.
    body
        (e,) number of its body.
    outer
        (e, faces) true for the faces on the boundary of the body, in the order of ``FACETS``.
    """

    cell: str
    nodes: IntArray
    body: IntArray
    outer: BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Lines:
    """Lines between nodes of the boundary, each in one of the facets that have it.

    Parameters
    ----------
    ends
        (k, 2) nodes at their ends, the lower number first.
    facet, kind
        (k,) number of the facet among those of its type, and number of that type.
    local
        (k, 2) numbers of the two nodes in the facet.
    """

    ends: IntArray
    facet: IntArray
    kind: IntArray
    local: IntArray


@dataclass(frozen=True, eq=False, kw_only=True)
class Solids:
    """All deformable bodies in one numbering of the nodes, with cells that fill the space.

    Parameters
    ----------
    names
        Names of the bodies.
    reference
        (n, d) reference coordinates [m].
    owner
        (n,) number of the body of each node.
    first
        (bodies,) first node of each body.
    blocks
        Cells by type.
    facets
        Facet name -> (f, b) nodes of the boundary facets.
    """

    names: tuple[str, ...]
    reference: Array
    owner: IntArray
    first: IntArray
    blocks: tuple[Block, ...]
    facets: Mapping[str, IntArray]

    @cached_property
    def surface(self) -> IntArray:
        """Nodes (s,) of the boundary, and of bars in the plane or in space."""
        inside = np.zeros(len(self.reference), dtype=bool)
        for block in self.blocks:
            inside[block.nodes] = True
        for facets in self.facets.values():
            inside[facets] = False
        return np.flatnonzero(~inside)

    @cached_property
    def curved(self) -> dict[str, IntArray]:
        """Facets (k, b) that may be curved, by name."""
        return {n: found for n, found in self.facets.items() if CELLS[n].dim > 0 and CELLS[n].order > 1}

    @cached_property
    def flat(self) -> IntArray:
        """Corners (k, d) of the flat pieces between the nodes of the boundary: segments or triangles."""
        pieces = [facets[:, piece] for name, facets in self.facets.items() for piece in FLAT.get(name, ((0,),))]
        return np.concatenate(pieces) if pieces else np.zeros((0, self.dim), np.int64)

    @cached_property
    def lines(self) -> Lines:
        """Lines of the boundary: the edges of its flat pieces, each once."""
        found = [np.zeros((0, 6), np.int64)]
        for kind, (name, facets) in enumerate(self.facets.items() if self.dim > 1 else ()):
            number = np.arange(len(facets))
            for piece in FLAT[name]:
                for a, b in ((0, 1), (1, 2), (2, 0))[: 1 if self.dim == 2 else 3]:
                    first, last = piece[a], piece[b]
                    fixed = [np.full(len(facets), value) for value in (kind, first, last)]
                    found.append(np.stack([facets[:, first], facets[:, last], number, *fixed], axis=1))
        rows = np.concatenate(found)
        turned = rows[:, 0] > rows[:, 1]
        rows[turned] = rows[turned][:, [1, 0, 2, 3, 5, 4]]
        _, once = np.unique(rows[:, :2], axis=0, return_index=True)
        ends, facet, local = np.split(rows[once], [2, 4], axis=1)
        return Lines(ends=ends, facet=facet[:, 0], kind=facet[:, 1], local=local)

    def on_lines(self, line: IntArray, fraction: Array, x: Array) -> Array:
        """Points (k, d) of the facets at fractions (k,) of their lines (k,), for positions x (n, d) of the nodes [m].

        They are in the facet, curved as it is, where its reference coordinates go straight from one end to the other.
        """
        out, lines = np.zeros((len(line), self.dim)), self.lines
        for kind, (name, facets) in enumerate(self.facets.items()):
            here = np.flatnonzero(lines.kind[line] == kind)
            if here.size:
                first, last = CELLS[name].nodes[lines.local[line[here]].T]
                shares, _ = tabulate(name, first + fraction[here, None] * (last - first))
                out[here] = np.einsum("kb,kbd->kd", shares, x[facets[lines.facet[line[here]]]])
        return out

    @cached_property
    def extents(self) -> Array:
        """Largest side (bodies,) of the box around each body at rest [m]."""
        low, high = boxes(self.reference, self.owner, len(self.names))
        return np.asarray((high - low).max(axis=1))

    @cached_property
    def shortest(self) -> Array:
        """Length (bodies,) of the shortest line of the boundary of each body at rest [m]."""
        ends = self.reference[self.lines.ends]
        out = np.full(len(self.names), np.inf)
        np.minimum.at(out, self.owner[self.lines.ends[:, 0]], np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
        return out

    @property
    def dim(self) -> int:
        """Dimension d of space."""
        return int(self.reference.shape[1])


def solids(
    names: Sequence[str], reference: Array, blocks: Mapping[str, IntArray], bodies: Mapping[str, IntArray]
) -> Solids:
    """Bodies from their cells.

    Parameters
    ----------
    names
        Names of the bodies.
    reference
        (n, d) reference coordinates [m]; the nodes of a body are consecutive.
    blocks, bodies
        Cell name -> (e, a) nodes of the cells, and (e,) the numbers of their bodies. Cells that do not fill the space
        (bars in the plane) have no inside and are left out.
    """
    dim = reference.shape[1]
    owner = np.zeros(len(reference), np.int64)
    for name, nodes in blocks.items():
        owner[nodes] = bodies[name][:, None]
    filling = {name: nodes for name, nodes in blocks.items() if CELLS[name].dim == dim}
    outer = _outer(filling)
    _leave_out_inner(reference, owner, filling, outer)
    facets: dict[str, list[IntArray]] = {}
    for name, nodes in filling.items():
        for k, (facet, local) in enumerate(FACETS[name]):
            facets.setdefault(facet, []).append(nodes[outer[name][:, k]][:, local])
    return Solids(
        names=tuple(names),
        reference=reference,
        owner=owner,
        first=np.searchsorted(owner, np.arange(len(names))),
        blocks=tuple(Block(cell=c, nodes=nodes, body=bodies[c], outer=outer[c]) for c, nodes in filling.items()),
        facets={name: np.concatenate(found) for name, found in facets.items()},
    )


def boxes(points: Array, owner: IntArray, count: int) -> tuple[Array, Array]:
    """Least and greatest coordinates (count, d), (count, d) of the points (n, d) of each owner (n,).

    Examples
    --------
    >>> low, high = boxes(np.array([[0.0], [2.0], [5.0]]), np.array([0, 0, 1]), 2)
    >>> low[:, 0].tolist(), high[:, 0].tolist()
    ([0.0, 5.0], [2.0, 5.0])
    """
    low = np.full((count, points.shape[1]), np.inf)
    high = -low
    np.minimum.at(low, owner, points)
    np.maximum.at(high, owner, points)
    return low, high


def _leave_out_inner(
    reference: Array, owner: IntArray, blocks: Mapping[str, IntArray], outer: Mapping[str, BoolArray]
) -> None:
    """Change the faces on the boundary, ``outer``, to those that do not lie beside smaller or larger cells."""
    places: dict[str, list[tuple[str, int, IntArray]]] = {}
    for name in blocks:
        for k, (facet, _) in enumerate(FACETS[name]):
            places.setdefault(facet, []).append((name, k, np.flatnonzero(outer[name][:, k])))
    for facet, found in places.items():
        facets = np.concatenate([blocks[name][rows][:, FACETS[name][k][1]] for name, k, rows in found])
        inner = beside_smaller(reference, owner, facet, facets)
        ends = np.cumsum([len(rows) for *_, rows in found])[:-1]
        for (name, k, rows), own in zip(found, np.split(inner, ends), strict=True):
            outer[name][rows[own], k] = False


def _outer(blocks: Mapping[str, IntArray]) -> dict[str, BoolArray]:
    """Faces (e, faces) of the cells of each block that no second cell shares."""
    width = max((CELLS[facet].corners for name in blocks for facet, _ in FACETS[name]), default=1)
    keys, spans, start = [], {}, 0
    for name, nodes in blocks.items():
        for facet, local in FACETS[name]:
            corners = np.sort(nodes[:, list(local)[: CELLS[facet].corners]], axis=1)
            keys.append(np.pad(corners, ((0, 0), (width - corners.shape[1], 0)), constant_values=-1))
        spans[name] = slice(start, start + len(nodes) * len(FACETS[name]))
        start = spans[name].stop
    if not keys:
        return {}
    _, number, count = np.unique(np.concatenate(keys), axis=0, return_inverse=True, return_counts=True)
    single = count[number.ravel()] == 1
    return {name: single[spans[name]].reshape(len(FACETS[name]), -1).T for name in blocks}
