"""Bad cells: folded ones, whose map is not one-to-one, and cells that have become flat."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.cell_shapes import cell_shapes, flat
from softway.record.audit.geometry.solids import Solids


def bad_cells(solids: Solids, x: Array) -> list[tuple[int, IntArray, float]]:
    """Body, nodes and shape of the worst cell of each body that has a folded cell, or one that has become flat.

    Bars in one dimension are left out: a linear bar has no sense of its deformed length.
    """
    worst: dict[int, tuple[int, IntArray, float]] = {}
    none = np.zeros_like(x)
    for block in solids.blocks if solids.dim > 1 else ():
        table = cell_shapes(block.cell)
        now, rest = (table.of(block.nodes, places, none) for places in (x, solids.reference))
        now = np.where(flat(now, rest), now, np.inf)
        for body in np.unique(block.body[np.isfinite(now)]):
            mine = np.flatnonzero(block.body == body)
            k = mine[np.argmin(now[mine])]
            if int(body) not in worst or now[k] < worst[int(body)][2]:
                worst[int(body)] = (int(body), block.nodes[k], float(now[k]))
    return list(worst.values())
