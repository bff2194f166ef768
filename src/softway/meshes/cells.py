"""Tables of the cells: names, reference nodes, facets and edges, in the node order of VTK.

The reference cells are the interval [0, 1], triangle and tetrahedron with unit legs, the square [0, 1]^2 and the cube
[0, 1]^3. The nodes of a quadratic cell are its corners, then the midpoints of its edges and faces, and its centre.
Serendipity cells (``quad8``, ``hex20``) have corners and midpoints of edges only.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from softway.arrays import Array, IntArray

_LINE = ((0.0,), (1.0,))
_TRIANGLE = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
_SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
_TETRAHEDRON = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_CUBE = tuple((x, y, z) for z in (0.0, 1.0) for x, y in _SQUARE)

_TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
_SQUARE_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))
_TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_CUBE_EDGES = (*_SQUARE_EDGES, (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
# Corners of the faces, anticlockwise when seen from outside; the faces of the cube are in the order -x, +x, -y, +y, -z,
# +z.
_TETRAHEDRON_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
_CUBE_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """Shape, order and nodes of a reference cell.

    Parameters
    ----------
    dim
        Topological dimension r: 0, 1, 2 or 3.
    order
        Polynomial order p: 1 or 2.
    simplex
        True for triangles and tetrahedra (false for bars, which are treated as tensor products).
    corners
        Number of corners.
    nodes
        (a, r) reference coordinates.
    edges
        Pairs of corners.
    powers
        (a, r) exponents of the monomials that span the shape functions.
    """

    dim: int
    order: int
    simplex: bool
    corners: int
    nodes: Array
    edges: tuple[tuple[int, int], ...]
    powers: IntArray


def _cell(
    corners: tuple[tuple[float, ...], ...],
    edges: tuple[tuple[int, int], ...],
    order: int,
    groups: tuple[tuple[int, ...], ...] = (),
) -> Cell:
    """Cell with nodes at the corners and, for order 2, at the centres of ``groups`` of corners."""
    x = np.array(corners)
    if order == 2:
        x = np.vstack([x, *(x[list(g)].mean(axis=0, keepdims=True) for g in groups)])
    dim = len(corners[0])
    simplex = dim > 1 and len(corners) == dim + 1
    serendipity = not simplex and len(x) < (order + 1) ** dim
    powers = _powers(dim, order, simplex, serendipity)
    for table in (x, powers):
        table.flags.writeable = False
    return Cell(dim=dim, order=order, simplex=simplex, corners=len(corners), nodes=x, edges=edges, powers=powers)


def _powers(dim: int, order: int, simplex: bool, serendipity: bool) -> IntArray:
    """Exponents (a, r) of the monomials of a cell, the last coordinate fastest.

    The total degree on simplices, and the degree in each coordinate on other cells, is up to the order. Serendipity
    cells have no monomial with the squares of two coordinates.
    """
    every = product(range(order + 1), repeat=dim)
    kept = [p for p in every if (not simplex or sum(p) <= order) and (not serendipity or p.count(2) < 2)]
    return np.array(kept, dtype=np.int64).reshape(len(kept), dim)


CELLS: dict[str, Cell] = {
    "point1": _cell(((),), (), 1),
    "bar2": _cell(_LINE, ((0, 1),), 1),
    "bar3": _cell(_LINE, ((0, 1),), 2, ((0, 1),)),
    "tri3": _cell(_TRIANGLE, _TRIANGLE_EDGES, 1),
    "tri6": _cell(_TRIANGLE, _TRIANGLE_EDGES, 2, _TRIANGLE_EDGES),
    "quad4": _cell(_SQUARE, _SQUARE_EDGES, 1),
    "quad8": _cell(_SQUARE, _SQUARE_EDGES, 2, _SQUARE_EDGES),
    "quad9": _cell(_SQUARE, _SQUARE_EDGES, 2, (*_SQUARE_EDGES, (0, 1, 2, 3))),
    "tet4": _cell(_TETRAHEDRON, _TETRAHEDRON_EDGES, 1),
    "tet10": _cell(_TETRAHEDRON, _TETRAHEDRON_EDGES, 2, _TETRAHEDRON_EDGES),
    "hex8": _cell(_CUBE, _CUBE_EDGES, 1),
    "hex20": _cell(_CUBE, _CUBE_EDGES, 2, _CUBE_EDGES),
    "hex27": _cell(_CUBE, _CUBE_EDGES, 2, (*_CUBE_EDGES, *_CUBE_FACES, tuple(range(8)))),
}
"""All cells by name; ``point1`` occurs only as a facet of bars."""


def _facet_nodes(cell: str, facet: str, corners: tuple[int, ...]) -> tuple[int, ...]:
    """Local nodes of the facet with the given corners, in the node order of the facet."""
    own, shape = CELLS[cell].nodes, CELLS[facet]
    if shape.dim == 0:
        return corners
    origin, axes = own[corners[0]], own[[corners[1], corners[-1]][: shape.dim]] - own[corners[0]]
    places = origin + shape.nodes @ axes
    return tuple(int(np.argmin(np.abs(own - place).sum(axis=1))) for place in places)


def _facets(cell: str, facet: str, faces: tuple[tuple[int, ...], ...]) -> tuple[tuple[str, tuple[int, ...]], ...]:
    return tuple((facet, _facet_nodes(cell, facet, corners)) for corners in faces)


FACETS: dict[str, tuple[tuple[str, tuple[int, ...]], ...]] = {
    "bar2": _facets("bar2", "point1", ((0,), (1,))),
    "bar3": _facets("bar3", "point1", ((0,), (1,))),
    "tri3": _facets("tri3", "bar2", _TRIANGLE_EDGES),
    "tri6": _facets("tri6", "bar3", _TRIANGLE_EDGES),
    "quad4": _facets("quad4", "bar2", _SQUARE_EDGES),
    "quad8": _facets("quad8", "bar3", _SQUARE_EDGES),
    "quad9": _facets("quad9", "bar3", _SQUARE_EDGES),
    "tet4": _facets("tet4", "tri3", _TETRAHEDRON_FACES),
    "tet10": _facets("tet10", "tri6", _TETRAHEDRON_FACES),
    "hex8": _facets("hex8", "quad4", _CUBE_FACES),
    "hex20": _facets("hex20", "quad8", _CUBE_FACES),
    "hex27": _facets("hex27", "quad9", _CUBE_FACES),
}
"""Facets of each cell as (facet cell, local nodes), facing outward: in the plane the normal is (dy, -dx)."""

SERENDIPITY = {"quad8": "quad9", "hex20": "hex27"}
"""Serendipity cells, each with the cell of the same shape that has all nodes."""

_RING = (0, 4, 1, 5, 2, 6, 3, 7, 0)
FLAT = {
    "bar2": ((0, 1),),
    "bar3": ((0, 2), (2, 1)),
    "tri3": ((0, 1, 2),),
    "tri6": ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    "quad4": ((0, 1, 2), (0, 2, 3)),
    "quad8": ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)),
    "quad9": tuple((a, b, 8) for a, b in zip(_RING[:-1], _RING[1:], strict=True)),
}
"""Division of each type of facet into flat facets between its nodes."""


def linear(cell: str) -> str:
    """Linear cell of the same shape.

    Examples
    --------
    >>> linear("tri6"), linear("hex8")
    ('tri3', 'hex8')
    """
    it = CELLS[cell]
    names = {(c.dim, c.corners): name for name, c in CELLS.items() if c.order == 1}
    return names[it.dim, it.corners]
