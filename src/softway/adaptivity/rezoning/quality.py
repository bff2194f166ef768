"""Quality of the cells of a mesh: scaled Jacobian, least angle, ratio of edges."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.cells import CELLS

_CORNERS: dict[int, dict[int, tuple[tuple[int, ...], ...]]] = {
    2: {
        3: ((0, 1, 2), (1, 2, 0), (2, 0, 1)),
        4: ((0, 1, 3), (1, 2, 0), (2, 3, 1), (3, 0, 2)),
    },
    3: {
        4: ((0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (3, 1, 0, 2)),
        8: (
            (0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7),
            (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3),
        ),
    },
}  # fmt: skip
_BEST = {(2, 3): np.sqrt(0.75), (3, 4): np.sqrt(0.5)}
"""Greatest scaled determinant of a corner of triangles and tetrahedra; one for the others."""


def corner_simplices(cell: str) -> IntArray:
    """Local nodes (k, d + 1) of the simplices at the corners of a cell: the corner and its neighbours.

    Their determinants are positive in a valid cell.

    Examples
    --------
    >>> corner_simplices("quad4")[1].tolist()
    [1, 2, 0]
    """
    return np.array(_CORNERS[CELLS[cell].dim][CELLS[cell].corners], dtype=np.int64)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CellQuality:
    """Quality of the cells of a mesh.

    Parameters
    ----------
    jacobian
        (e,) least scaled Jacobian of the corners: the determinant of the edges over the product of their lengths, one
        in rectangles, boxes and equilateral simplices, zero or less in degenerate or folded cells.
    angle
        (e,) least angle between two edges at a corner [degrees].
    ratio
        (e,) longest edge over the shortest one.
    """

    jacobian: Array
    angle: Array
    ratio: Array

    @property
    def worst(self) -> tuple[float, float, float]:
        """Least scaled Jacobian, least angle [degrees] and greatest ratio of edges."""
        return float(self.jacobian.min()), float(self.angle.min()), float(self.ratio.max())


def cell_quality(blocks: Mapping[str, IntArray], places: Array) -> CellQuality:
    """Quality of the cells of a mesh in two or three dimensions.

    Parameters
    ----------
    blocks
        Cell name -> (e, a) node numbers.
    places
        (n, d) places of the nodes [m].

    Examples
    --------
    >>> found = cell_quality({"quad4": np.array([[0, 1, 2, 3]])}, np.array([[0, 0], [2, 0], [3, 1], [1, 1]]))
    >>> round(float(found.jacobian[0]), 6), round(float(found.angle[0]), 6), round(float(found.ratio[0]), 6)
    (0.707107, 45.0, 1.414214)
    """
    parts = [_quality(cell, places[nodes]) for cell, nodes in blocks.items()]
    jacobian, angle, ratio = (np.concatenate(values) for values in zip(*parts, strict=True))
    return CellQuality(jacobian=jacobian, angle=angle, ratio=ratio)


def _quality(cell: str, x: Array) -> tuple[Array, Array, Array]:
    """Least scaled Jacobian, least angle and ratio of edges (e,) of cells with nodes x (e, a, d)."""
    corners, d = corner_simplices(cell), x.shape[2]
    rays = x[:, corners[:, 1:]] - x[:, corners[:, :1]]
    lengths = np.linalg.norm(rays, axis=3)
    unit = rays / np.maximum(lengths, np.finfo(float).tiny)[..., None]
    scaled = np.linalg.det(unit) / _BEST.get((d, CELLS[cell].corners), 1.0)
    cosines = np.clip(np.einsum("ekai,ekbi->ekab", unit, unit), -1.0, 1.0)
    pairs = np.triu_indices(d, 1)
    angles = np.degrees(np.arccos(cosines[:, :, pairs[0], pairs[1]]))
    return scaled.min(axis=1), angles.min(axis=(1, 2)), lengths.max(axis=(1, 2)) / lengths.min(axis=(1, 2))
