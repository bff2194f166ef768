"""Meshes of discs and balls about the origin from lattices, and of extruded discs.

Meshes of squares or cubes have a core block with bulged sides inside a ring of blocks, so that no cell has a straight
angle on the boundary. Meshes of simplices map concentric square shells of a lattice to circles or spheres, with the
diagonals towards the centre.
"""

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.generators.lattice import (
    boundary_edges,
    kuhn_cells,
    merged,
    quadratic_simplices,
    tensor_cells,
    upright,
)

# Half the side of the core block over the radius, relative to its share of the cells, and relative bulge of its sides;
# the tests check the quality of the cells.
_CORE = {2: 0.95, 3: 0.85}
_BULGE = {2: 0.20, 3: 0.20}


def ball_lattice(dim: int, cells: int, cell: str) -> tuple[Array, IntArray]:
    """Unit disc or ball with an even number of ``cells`` across; linear simplices, or squares and cubes of any order.

    Returns
    -------
    points, nodes
        (n, d), and node numbers (e, a).

    Examples
    --------
    >>> points, nodes = ball_lattice(2, 2, "tri3")
    >>> len(points), len(nodes)
    (9, 8)
    """
    if CELLS[cell].simplex:
        half = cells // 2
        lattice, nodes = merged(kuhn_cells((cells,) * dim, lambda low: (low < half).astype(np.int64)) - half)
        level = np.abs(lattice).max(axis=1, keepdims=True)
        return level / half * _direction(lattice / np.maximum(level, 1)), nodes
    return _core_and_ring(dim, cells, cell)


def _direction(q: Array) -> Array:
    """Unit vectors (n, d) through points (n, d) on the faces of the cube [-1, 1]^d, at equal angles along its axes.

    The origin gives the zero vector.
    """
    spread = np.tan(0.25 * np.pi * q)
    return np.asarray(spread / np.maximum(np.linalg.norm(spread, axis=1, keepdims=True), 1e-300))


def _core_and_ring(dim: int, cells: int, cell: str) -> tuple[Array, IntArray]:
    """Core and ring: lattice points of the core or its surface, with the layer of the ring as the last integer."""
    order = CELLS[cell].order
    rings = max(1, round(cells / 4))
    core = cells - 2 * rings
    layers = order * rings
    inner = tensor_cells((core,) * dim, cell) * 2 - order * core
    parts = [np.concatenate([inner, np.zeros_like(inner[..., :1])], axis=-1)]
    for axis in range(dim):
        grid = tensor_cells(tuple(rings if k == axis else core for k in range(dim)), cell)
        for side in (-1, 1):
            face = 2 * grid - order * core
            face[..., axis] = side * order * core
            layer = grid[..., axis] if side == 1 else layers - grid[..., axis]
            parts.append(np.concatenate([face, layer[..., None]], axis=-1))
    lattice, nodes = merged(np.concatenate(parts))
    q, t = lattice[:, :dim] / (order * core), lattice[:, dim:] / layers
    bulge = 1.0 + _BULGE[dim] / (dim - 1) * (np.sum(1.0 - q**2, axis=1, keepdims=True) - (1.0 - q**2))
    inside = _CORE[dim] * core / cells * q * bulge
    return (1.0 - t) * inside + t * _direction(q), nodes


def rounded_simplices(
    points: Array, cells: IntArray, rim: IntArray, radius: float, *, axes: int
) -> tuple[Array, IntArray]:
    """Quadratic simplices with round boundaries.

    Midpoints of edges on facets within ``rim`` are moved to the distance ``radius`` from the origin, in the first
    ``axes`` coordinates.
    """
    corners = len(points)
    more, nodes, parents = quadratic_simplices(points, cells)
    curved = corners + boundary_edges(cells, parents, rim)
    flat = more[curved, :axes]
    more[curved, :axes] = flat * (radius / np.linalg.norm(flat, axis=1, keepdims=True))
    return more, nodes


def extruded(points: Array, cells: IntArray, flat: str, height: float, layers: int) -> tuple[Array, IntArray]:
    """Extrude plane cells along z: tri3 to tet4 (three for each prism), quad4 to hex8, quad8 to hex20,
    quad9 to hex27.

    Prisms are split along the order of the node numbers, so that neighbours agree on the diagonals.

    Examples
    --------
    >>> points, nodes = extruded(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]]), "tri3", 1.0, 2)
    >>> len(points), len(nodes)
    (9, 6)
    """
    count, order = len(points), CELLS[flat].order
    levels = height * (np.arange(order * layers + 1) / (order * layers))
    solid = np.column_stack([np.tile(points, (len(levels), 1)), np.repeat(levels, count)])
    lift = count * order * np.arange(layers)
    if flat == "tri3":
        a, b, c = np.sort(cells, axis=1).T
        prism = np.stack([[a, b, c, c + count], [a, b, b + count, c + count], [a, a + count, b + count, c + count]])
        base = prism.transpose(2, 0, 1).reshape(-1, 4)
        base = upright(solid[base], base)
    else:
        local = CELLS[next(cell for cell, facets in FACETS.items() if facets[0][0] == flat)].nodes
        places = np.abs(local[:, None, :2] - CELLS[flat].nodes[None]).sum(axis=2).argmin(axis=1)
        base = cells[:, places] + count * np.rint(order * local[:, 2]).astype(np.int64)
    kept, nodes = np.unique((lift[:, None, None] + base[None]).reshape(-1, base.shape[1]), return_inverse=True)
    return solid[kept], nodes.reshape(-1, base.shape[1])
