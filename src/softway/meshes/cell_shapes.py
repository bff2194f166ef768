"""Shapes of cells in their present places: where their maps are not one-to-one, and how flat they are."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.geometry.shape import shapes
from softway.meshes.cells import CELLS
from softway.meshes.element import tabulate

ROUNDING = 1e-9
"""Scaled Jacobian that is zero: at a corner of a quadrilateral whose sides both lie on a plane tool it is."""
FLAT = 1e-2
"""Scaled Jacobian below which a cell is flat: the error of its strains may be a hundred times that of a good cell."""
WORSE = 0.1
"""Scaled Jacobian, relative to that at rest, below which a cell may be called flat."""
MOST = {2: 3, 3: 2}
"""Greatest number of steps between the points on an edge of a quadrilateral or hexahedron."""
BEST = {2: np.sqrt(0.75), 3: np.sqrt(0.5)}
"""Greatest scaled determinant of the edges at a corner of triangles and tetrahedra."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CellShapes:
    """Tables for the shapes of cells of one type.

    Parameters
    ----------
    frames
        (f, a, d) weights of the nodes in the tangents of the cell.
    folds
        Number of the frames that tell only whether the cell is folded.
    best
        Greatest scaled determinant.
    """

    frames: Array
    folds: int
    best: float

    def of(self, cells: IntArray, points: Array, moved: Array) -> Array:
        """Shapes (e,) of cells (e, a) with nodes at ``points + moved`` (n, d).

        Zero or less, up to ``ROUNDING``, where the map of a cell is not one-to-one; else the scaled Jacobian at its
        centre, that is the determinant of the tangents over their lengths, of triangles and tetrahedra the least at
        their corners over that of equilateral ones.

        Examples
        --------
        >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        >>> inward = np.array([[0.0, 0.0], [0.0, 0.0], [-0.6, -0.6], [0.0, 0.0]])
        >>> table, cells = cell_shapes("quad4"), np.arange(4)[None]
        >>> [round(float(table.of(cells, square, share * inward)[0]), 3) for share in (0.0, 0.5, 1.0)]
        [1.0, 0.94, -0.385]
        """
        return np.asarray(shapes(points, moved, cells, self.frames, self.folds, self.best, ROUNDING))


def cell_shapes(cell: str) -> CellShapes:
    """Tables for cells of one type that fill the plane or space.

    The determinant of the map is a polynomial.  Its sign is looked at on a lattice of as many points as it has
    coefficients: one point of a linear simplex, the corners of ``quad4``, three points an edge of ``tri6`` and
    ``hex8``, four of ``tet10`` and ``quad9``, but three of ``hex20`` and ``hex27``.  In simplices of order one and in
    ``quad4`` it is positive if it is there; in the others it may be negative in a small part between them (Johnen,
    Remacle, Geuzaine, J. Comput. Phys. 233 (2013) 359-372).
    """
    it = CELLS[cell]
    d = it.dim
    corners = it.nodes[: it.corners]
    axes = np.broadcast_to(np.eye(d), (1, d, d))
    signs = _frames(cell, _lattice(cell), axes)
    if not it.simplex:
        return CellShapes(
            frames=np.concatenate([signs, _frames(cell, _centre(corners), axes)]), folds=len(signs), best=1.0
        )
    edges = np.stack([np.delete(corners, k, axis=0) - corners[k] for k in range(d + 1)])
    turned = np.linalg.det(edges) < 0.0
    edges[turned, :2] = edges[turned, 1::-1]
    frames = np.concatenate([signs, *(_frames(cell, _centre(corners), one[None]) for one in edges)])
    return CellShapes(frames=frames, folds=len(signs), best=float(BEST[d]))


def _centre(corners: Array) -> Array:
    """The centre (1, d) of a reference cell."""
    return np.asarray(corners.mean(axis=0, keepdims=True))


def _frames(cell: str, at: Array, directions: Array) -> Array:
    """Weights (f, a, d) of the nodes in the tangents at points (f, d) along directions (1, d, d), one a row."""
    _, slopes = tabulate(cell, at)
    return np.ascontiguousarray(np.einsum("fai,kji->faj", slopes, directions))


def _lattice(cell: str) -> Array:
    """Points (f, d) that determine the polynomial of the determinant, with the corners; of hexahedra three an edge."""
    it = CELLS[cell]
    degree = it.dim * (it.order - 1) if it.simplex else min(it.dim * it.order - 1, MOST[it.dim])
    if degree == 0:
        return _centre(it.nodes[: it.corners])
    steps = [p for p in product(range(degree + 1), repeat=it.dim) if not it.simplex or sum(p) <= degree]
    return np.array(steps) / degree


def flat(now: Array, rest: Array) -> Array:
    """Which cells (e,), with shapes now and at rest, are folded or have become flat.

    Examples
    --------
    >>> flat(np.array([0.5, 0.005, 0.005, -0.1]), np.array([1.0, 1.0, 0.01, 1.0])).tolist()
    [False, True, False, True]
    """
    return np.asarray((now <= ROUNDING) | (now < np.minimum(FLAT, WORSE * rest)))
