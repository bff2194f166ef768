"""Dashpots between massless nodes and the other nodes of their cells, for slabs without equilibrium of these nodes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Dashpots:
    """Dashpots on lines between two nodes: their forces have no resultant, and oppose the change of the length.

    Parameters
    ----------
    lines
        (k, n d) change of the length of each line per displacement of the nodes: unit vectors at its two ends.
    damping
        (k,) force per rate of the length [N s/m].

    Examples
    --------
    >>> lines = sp.csr_array([[1.0, -1.0]])
    >>> Dashpots(lines=lines, damping=np.array([2.0])).force(np.array([[0.5], [0.0]]), span=0.25)
    array([[ 4.],
           [-4.]])
    """

    lines: sp.csr_array
    damping: Array

    @classmethod
    def of(cls, parts: Sequence[DiscreteSolid], massive: BoolArray, x: Array, blocks: Array, time: float) -> Self:
        """Dashpots on the lines from each massless node to the other nodes of its cells.

        A node that moves alone within ``time`` [s] is resisted as by its stiffness once more.

        Parameters
        ----------
        parts, massive
            Solids, and True for nodes with mass (n,).
        x
            (n, d) present positions [m].
        blocks
            (n, d, d) diagonal blocks of the tangent stiffness [N/m].
        time
            Ratio of damping to stiffness [s].
        """
        ends = np.concatenate([_lines(part, massive) for part in parts])
        along = x[ends[:, 0]] - x[ends[:, 1]]
        length = np.linalg.norm(along, axis=1)
        ends, along = ends[length > 0.0], along[length > 0.0] / length[length > 0.0, None]
        light, d = ~massive[ends], x.shape[1]
        count = np.maximum(np.bincount(ends[light], minlength=len(x)), 1)
        share = d * np.linalg.norm(blocks, axis=(1, 2)) / count
        damping = time * (share[ends] * light).sum(axis=1) / light.sum(axis=1)
        rows, columns = np.arange(len(ends)).repeat(2 * d), (d * ends[:, :, None] + np.arange(d)).ravel()
        values = np.stack([along, -along], axis=1).ravel()
        return cls(lines=sp.csr_array((values, (rows, columns)), shape=(len(ends), x.size)), damping=damping)

    def force(self, moved: Array, span: float) -> Array:
        """Force (n, d) with the sign of internal forces [N], of a displacement ``moved`` (n, d) within ``span`` [s]."""
        return np.asarray(self.lines.T @ (self.damping / span * (self.lines @ moved.ravel()))).reshape(moved.shape)

    def stiffness(self, jacobian: sp.csr_array, span: float) -> sp.csc_array:
        """Derivative (f, f) of the force with respect to the motion within ``span`` [s], on unknowns [N/m]."""
        lines = self.lines @ jacobian
        return sp.csc_array(lines.T @ sp.diags_array(self.damping / span) @ lines)


def _lines(part: DiscreteSolid, massive: BoolArray) -> IntArray:
    """Pairs (k, 2) of nodes of a cell of which at least one is massless, each pair once."""
    found = [np.zeros((0, 2), np.int64)]
    for cells in part.mesh.blocks.values():
        nodes = cells + part.nodes.start
        nodes = nodes[~massive[nodes].all(axis=1)]
        one, other = np.triu_indices(cells.shape[1], 1)
        found.append(np.sort(np.stack([nodes[:, one].ravel(), nodes[:, other].ravel()], axis=1), axis=1))
    pairs = np.unique(np.concatenate(found), axis=0)
    return pairs[~massive[pairs].all(axis=1)]
