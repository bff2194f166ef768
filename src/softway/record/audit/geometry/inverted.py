"""Inverted cells: cells whose volume is negative at a corner or at the centre."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.cells import CELLS
from softway.meshes.element import tabulate
from softway.record.audit.geometry.solids import Block, Solids

ROUNDING = 1e-9
"""Ratio of volumes that is zero: at a corner of a quadrilateral whose sides both lie on a plane tool it is."""


def volume_ratios(block: Block, reference: Array, x: Array) -> Array:
    """Ratios (e, k + 1) of the deformed to the initial volume of the cells, at their k corners and their centre.

    Parameters
    ----------
    block
        Cells.
    reference, x
        (n, d) positions of the nodes at rest and now [m].
    """
    corners = CELLS[block.cell].nodes[: CELLS[block.cell].corners]
    _, dN = tabulate(block.cell, np.vstack([corners, corners.mean(axis=0)]))
    return np.asarray(_determinants(x[block.nodes], dN) / _determinants(reference[block.nodes], dN))


def inverted(solids: Solids, x: Array) -> list[tuple[int, IntArray, float]]:
    """Body, nodes and volume ratio of the worst cell of each body that has an inverted cell.

    Bars in one dimension are left out: a linear bar has no sense of its deformed length.
    """
    worst: dict[int, tuple[int, IntArray, float]] = {}
    for block in solids.blocks if solids.dim > 1 else ():
        ratios = volume_ratios(block, solids.reference, x)
        ratio = ratios.min(axis=1)
        for body in np.unique(block.body[(ratio < -ROUNDING) | (ratios[:, -1] <= ROUNDING)]):
            mine = np.flatnonzero(block.body == body)
            k = mine[np.argmin(ratio[mine])]
            if int(body) not in worst or ratio[k] < worst[int(body)][2]:
                worst[int(body)] = (int(body), block.nodes[k], float(ratio[k]))
    return list(worst.values())


def _determinants(nodes: Array, dN: Array) -> Array:
    """Determinants (e, q) of the maps of cells with nodes at (e, a, d)."""
    slope = np.tensordot(nodes, dN, axes=(1, 1)).transpose(3, 1, 0, 2)
    if len(slope) == 1:
        return np.asarray(slope[0, 0])
    if len(slope) == 2:
        return np.asarray(slope[0, 0] * slope[1, 1] - slope[0, 1] * slope[1, 0])
    (a, b, c), (d, e, f), (g, h, i) = slope
    return np.asarray(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))
