"""Points of a lattice in a facet, at which its places between nodes are looked at."""

import numpy as np

from softway.arrays import Array
from softway.meshes.cells import CELLS


def lattice(name: str, divisions: int) -> Array:
    """Reference points (p, r) of a lattice in a facet without its corners.

    Examples
    --------
    >>> lattice("bar3", 4).ravel().tolist()
    [0.25, 0.5, 0.75]
    """
    cell = CELLS[name]
    ticks = np.linspace(0.0, 1.0, divisions + 1)
    points = np.stack(np.meshgrid(*[ticks] * cell.dim, indexing="ij"), axis=-1).reshape(-1, cell.dim)
    if cell.simplex:
        points = points[points.sum(axis=1) <= 1.0 + 1e-12]
    corner = (np.abs(points[:, None] - cell.nodes[: cell.corners][None]).max(axis=2) < 1e-12).any(axis=1)
    return np.asarray(points[~corner])
