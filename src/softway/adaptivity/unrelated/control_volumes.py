"""Control volumes of the quadrature points of a mesh: parts of the cells that fill it."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.meshes.element import tabulate

_EIGHTH, _BOX = 6, 24
"""Tetrahedra in an eighth of a hexahedron, and in one of 27 boxes."""
SAME = 1e-8
"""Distance of corners, relative to the size of the mesh, below which they are one."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ControlVolumes:
    """Control volumes of the points of a mesh.

    Parameters
    ----------
    corners
        (t, k, d) corners: polygons, anticlockwise, in the plane; tetrahedra in space [m].
    point
        (p,) control volume of each quadrature point; those of a cell may have one in common.
    pieces
        Number of consecutive polygons or tetrahedra that make up one of the v control volumes.
    """

    corners: Array
    point: IntArray
    pieces: int = 1

    @property
    def whole(self) -> Array:
        """Corners (v, pieces k, d) of the control volumes [m]."""
        count, k, d = self.corners.shape
        return self.corners.reshape(count // self.pieces, self.pieces * k, d)

    @property
    def centre(self) -> Array:
        """Means (v, d) of the corners [m]."""
        return np.asarray(self.whole.mean(axis=1))

    def neighbours(self) -> sp.csr_array:
        """Matrix (v, v) with ones for control volumes that have a corner in common, themselves among them."""
        count, k, d = self.whole.shape
        points = self.whole.reshape(-1, d)
        pairs = cKDTree(points).query_pairs(SAME * float(np.ptp(points, axis=0).max()), output_type="ndarray")
        links = sp.coo_array((np.ones(len(pairs)), pairs.T), shape=(len(points),) * 2)
        corner = connected_components(links, directed=False)[1]
        inside = sp.csr_array((np.ones(count * k), (np.repeat(np.arange(count), k), corner)))
        both = sp.csr_array(inside @ inside.T)
        both.data[:] = 1.0
        return both


def require_cells(blocks: Mapping[str, IntArray]) -> None:
    """Refuse a mesh of bars, of ``hex27``, or of several types of cells in space.

    Raises
    ------
    InputError
        With the cells.
    """
    cell, *others = blocks
    if CELLS[cell].dim < 2 or CELLS[cell].dim == 3 and others or cell == "hex27":
        remedy = "triangles, quadrilaterals, or one type of tetrahedra, hex8 or hex20"
        raise InputError("mesh", f"cells {', '.join(blocks)}", remedy)


def control_volumes(blocks: Mapping[str, IntArray], places: Array, points: Mapping[str, int]) -> ControlVolumes:
    """Control volumes of a mesh, of several types of cells in the plane.

    A quadrilateral with k times k points has the images of k times k rectangles whose areas are the weights, a triangle
    with three points those of the three parts that the lines from its centre to the middles of its sides cut off, a
    hexahedron with eight points its eighths, one with 27 points the images of 27 boxes; other cells are one control
    volume, with the mean of their points.  An eighth is six tetrahedra between a corner, middles of edges and of faces,
    and the centre of the cell; a box is 24 between an edge, the middle of a face and the centre.  Those of cells with a
    face in common fit together, and fill the volume of the trilinear cells.

    Parameters
    ----------
    blocks
        Cell name -> (e, a) node numbers.
    places
        (n, d) places of the nodes [m].
    points
        Number of quadrature points of each type of cell.

    Raises
    ------
    InputError
        For several types of cells in space, bars, or ``hex27``.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> control_volumes({"quad4": np.array([[0, 1, 2, 3]])}, square, {"quad4": 4}).centre.tolist()
    [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75]]
    """
    require_cells(blocks)
    found = [_of_cells(cell, nodes, places, points[cell]) for cell, nodes in blocks.items()]
    most, first, corners, own = max(one.corners.shape[1] for one in found), 0, [], []
    for one in found:
        more = most - one.corners.shape[1]
        corners.append(np.concatenate([one.corners, np.repeat(one.corners[:, -1:], more, axis=1)], axis=1))
        own.append(first + one.point)
        first += len(one.corners) // one.pieces
    return ControlVolumes(corners=np.concatenate(corners), point=np.concatenate(own), pieces=found[0].pieces)


def _of_cells(cell: str, nodes: IntArray, places: Array, points: int) -> ControlVolumes:
    """Control volumes of cells (e, a) of one type with some points each."""
    parts, pieces = _parts(cell, points)
    table = tabulate(cell, parts.reshape(-1, CELLS[cell].dim))[0]
    corners = np.einsum("ka,ead->ekd", table, places[nodes]).reshape(len(nodes) * len(parts), *parts.shape[1:])
    own = np.arange(len(nodes) * points)
    return ControlVolumes(corners=corners, point=own if len(parts) > pieces else own // points, pieces=pieces)


def _parts(cell: str, points: int) -> tuple[Array, int]:
    """Corners (v, k, r) of the parts of a reference cell, and the number of parts of a volume: one for each point, or
    one for all.
    """
    it = CELLS[cell]
    whole = it.nodes[None, : it.corners]
    if it.corners == 8:
        return (_eighths(), _EIGHTH) if points == 8 else (_boxes(round(points ** (1.0 / 3.0))), _BOX)
    k = round(points**0.5)
    if it.corners == 4 and it.dim == 2 and k * k == points and k > 1:
        low = np.stack(np.meshgrid(np.arange(k), np.arange(k), indexing="ij"), axis=-1).reshape(-1, 1, 2)
        return np.asarray(_cuts(k)[low + whole.astype(np.int64)]), 1
    if it.corners == 3 and points == 3:
        a, b, c = whole[0]
        middle, centre = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)), (a + b + c) / 3.0
        ends = ((a, middle[0], centre, middle[2]), (c, middle[2], centre, middle[1]), (b, middle[1], centre, middle[0]))
        return np.array(ends), 1
    return np.asarray(whole), 1


def _cuts(k: int) -> Array:
    """Ends (k + 1,) of the parts of the unit interval whose lengths are the weights of its k points."""
    return np.concatenate([[0.0], np.cumsum(0.5 * np.polynomial.legendre.leggauss(k)[1])])


def _boxes(k: int) -> Array:
    """Corners (24 k^3, 4, 3) of the tetrahedra of the boxes of the reference cube, in the order of its points."""
    cuts, found = _cuts(k), []
    for box in product(range(k), repeat=3):
        low, size = cuts[list(box)], np.diff(cuts)[list(box)]
        for axis, side in product(range(3), (0.0, 1.0)):
            ring = np.full((4, 3), side)
            ring[:, [(axis + 1) % 3, (axis + 2) % 3]] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            for one, other in zip(ring, np.roll(ring, -1, axis=0), strict=True):
                found.append(low + size * np.array([np.full(3, 0.5), ring.mean(axis=0), one, other]))
    return np.array(found)


def _eighths() -> Array:
    """Corners (48, 4, 3) of the tetrahedra of the eighths of the reference cube, in the order of its points."""
    found = []
    for corner in product((0.0, 1.0), repeat=3):
        for axes in permutations(range(3)):
            way = [np.array(corner)]
            for axis in axes:
                way.append(np.where(np.arange(3) == axis, 0.5, way[-1]))
            found.append(way)
    return np.array(found)
