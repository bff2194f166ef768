"""Nodal rotations of bodies since an operator was factored.

A stiffness rotates with its body: ``K(Q x) = Q K(x) Q^T``.  One factor serves a body that bends and rotates as
``R A^-1 R^T``; R contains for each node the rotation of the material around it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.assembled.vector_space import VectorSpace
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import DofMap
from softway.bodies.elements.section import Axisymmetric
from softway.kernels.linalg.tensors import rotation

SMALL = 0.03
"""Root mean square of ``R - I`` over the nodes below which the rotation is ignored."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodalRotation:
    """Sampling of the deformation around the nodes: ``slopes`` (d matrices (n, n)), the mean of du/dX_j over the cells
    of a node; nodes without rotation, such as those of bars in space, have empty rows.
    """

    slopes: tuple[sp.csr_array, ...]

    def gradient(self, u: Array) -> Array:
        """Mean deformation gradient (n, d, d) at the nodes at the displacement u (n, d)."""
        H = np.stack([slope @ u for slope in self.slopes], axis=-1)
        return np.asarray(H + np.eye(u.shape[1]))

    def since(
        self, space: VectorSpace, reference: Array, u: Array, dofs: DofMap, small: float = SMALL
    ) -> sp.csr_array | None:
        """Block-diagonal R (f, f) of the nodes from ``reference`` (n, d) to ``u`` (n, d).

        None if the root mean square of ``R - I`` is below ``small``, or if unknowns move several components.  Nodes
        with supports keep their directions.
        """
        n, d = u.shape
        if dofs.components is None:
            return None
        before, now = space.filled(self.gradient(reference)), space.filled(self.gradient(u))
        if np.sqrt(space.mean((now - before) ** 2) * d) < small:
            return None
        R = rotation(now @ np.linalg.inv(before))
        R[~dofs.free.all(axis=1) | ~np.isfinite(R).all(axis=(1, 2))] = np.eye(d)
        if np.sqrt(space.mean((R - np.eye(d)) ** 2) * d) < small:
            return None
        full = sp.bsr_array((R, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d)).tocsr()
        return sp.csr_array(full[dofs.components][:, dofs.components])


def nodal_rotation(parts: Sequence[DiscreteSolid]) -> NodalRotation:
    """:class:`NodalRotation` of bodies."""
    found = [_slopes(p) for p in parts]
    return NodalRotation(slopes=tuple(sp.csr_array(sp.block_diag(s, format="csr")) for s in zip(*found, strict=True)))


def _slopes(part: DiscreteSolid) -> list[sp.csr_array]:
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
    mean = sp.diags_array(1.0 / np.maximum(np.asarray(around.sum(axis=1)).ravel(), 1e-300)) @ around
    return [sp.csr_array(mean @ internal.sampling.table[j::d]) for j in range(d)]
