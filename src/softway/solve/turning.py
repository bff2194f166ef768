"""How far the nodes of bodies have turned since an operator was factored.

A stiffness turns with its body: ``K(Q x) = Q K(x) Q^T``.  A factor made once serves a body that bends and spins as
``R A^-1 R^T``, where R holds for each node the rotation of the material around it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.bodies.part import Part
from softway.bodies.section import Axisymmetric
from softway.kernels.tensors import rotation
from softway.typing import Array, BoolArray

SMALL = 0.03
"""Root mean square of ``R - I`` over the nodes below which bodies count as not turned."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Turning:
    """Sampling of the deformation around the nodes: ``slopes`` (d matrices (n, n)), the mean of du/dX_j over the cells
    of a node; nodes that do not turn, as those of bars in space, have empty rows.
    """

    slopes: tuple[sp.csr_array, ...]

    def gradient(self, u: Array) -> Array:
        """Deformation gradient (n, d, d) around the nodes at the displacement u (n, d)."""
        H = np.stack([slope @ u for slope in self.slopes], axis=-1)
        return np.asarray(H + np.eye(u.shape[1]))

    def since(self, reference: Array, u: Array, free: BoolArray, small: float = SMALL) -> sp.csr_array | None:
        """Block-diagonal R (f, f) of the nodes from ``reference`` (n, d) to ``u`` (n, d).

        None where the root mean square of ``R - I`` is ``small``.  Nodes with supports keep their directions.
        """
        n, d = u.shape
        before, now = self.gradient(reference), self.gradient(u)
        if np.sqrt(np.mean((now - before) ** 2) * d) < small:
            return None
        R = rotation(now @ np.linalg.inv(before))
        R[~free.all(axis=1) | ~np.isfinite(R).all(axis=(1, 2))] = np.eye(d)
        if np.sqrt(np.mean((R - np.eye(d)) ** 2) * d) < small:
            return None
        whole = sp.bsr_array((R, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d)).tocsr()
        keep = np.flatnonzero(free.ravel())
        return sp.csr_array(whole[keep][:, keep])


def turning(parts: Sequence[Part]) -> Turning:
    """The :class:`Turning` of some bodies."""
    found = [_slopes(p) for p in parts]
    return Turning(slopes=tuple(sp.csr_array(sp.block_diag(s, format="csr")) for s in zip(*found, strict=True)))


def _slopes(part: Part) -> list[sp.csr_array]:
    internal, n, d = part.internal, part.mesh.n_nodes, part.mesh.dim
    if part.mesh.cell_dim != d or d == 1 or isinstance(internal.section, Axisymmetric):
        return [sp.csr_array((n, n)) for _ in range(d)]
    row, column, start = [], [], 0
    for cells, table in zip(part.mesh.blocks.values(), internal.sampling.rows, strict=True):
        points = start + np.arange(table.shape[0] * table.shape[1]).reshape(table.shape[:2])
        shape = (*points.shape, cells.shape[1])
        row.append(np.broadcast_to(cells[:, None, :], shape).ravel())
        column.append(np.broadcast_to(points[:, :, None], shape).ravel())
        start += points.size
    rows, columns = np.concatenate(row), np.concatenate(column)
    around = sp.csr_array((internal.sampling.volume[columns], (rows, columns)), shape=(n, start))
    mean = sp.diags_array(1.0 / np.asarray(around.sum(axis=1)).ravel()) @ around
    return [sp.csr_array(mean @ internal.sampling.table[j::d]) for j in range(d)]
