"""Contact rows: the linearised contact conditions of a model as arrays, one row for each pair that may touch."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.dof_map import DofMap
from softway.contact.tangential_rows import TangentialRows


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactRows:
    """Rows of the contact conditions ``gap >= 0``, ``gap = offset + G u``.

    Parameters
    ----------
    node
        (m,) slave node of the model.
    contact
        (m,) number of the contact that the row belongs to.
    normal
        (m, d) outward unit normal of the opponent.
    gradient
        (m, n d) rows G on the components ``j d + i`` of a nodal field.
    offset
        (m,) gap at zero displacement [m]; infinite for rows with no opponent in reach.
    tool_motion
        (m,) normal motion of a driven opponent over the slab, positive towards the slave [m].
    labels
        Names of the contacts.
    shear
        Tangential parts of the rows; without directions if no contact has friction.
    """

    node: IntArray
    contact: IntArray
    normal: Array
    gradient: sp.csr_array
    offset: Array
    tool_motion: Array
    labels: tuple[str, ...]
    shear: TangentialRows

    @property
    def near(self) -> BoolArray:
        """Rows (m,) with an opponent in reach."""
        return np.isfinite(self.offset)

    def without_friction(self) -> "ContactRows":
        """Contact rows without tangential directions."""
        if not self.shear.count:
            return self
        m, n = self.shear.weights.shape
        return replace(self, shear=TangentialRows.none(m, n, self.normal.shape[1]))

    def gap(self, u: Array) -> Array:
        """Gap (m,) at the displacement ``u`` (n, d) [m]."""
        return self.offset + self.normal_component(u)

    def normal_component(self, field: Array) -> Array:
        """Normal component (m,) of a nodal field (n, d), relative to the opponent's."""
        return np.asarray(self.gradient @ field.ravel())

    def travel(self, motion: Array, greatest: float) -> Array:
        """Bound (m,) of the motion of slave and opponent against each other, if each node moves by ``motion`` (n,) [m].

        Tools are taken to move by the ``greatest`` motion.
        """
        d = self.normal.shape[1]
        weights = (self.gradient.power(2) @ sp.kron(sp.eye_array(len(motion)), np.ones((d, 1)), format="csr")).sqrt()
        tool = np.maximum(2.0 - np.asarray(weights.sum(axis=1)), 0.0)
        return np.asarray(weights @ motion + tool * greatest)

    def spread(self, values: Array, shape: tuple[int, int]) -> Array:
        """Nodal field (n, d) ``G^T values`` of row values (m,)."""
        rows = self.gradient
        weights = rows.data * np.repeat(values, np.diff(rows.indptr))
        return np.asarray(np.bincount(rows.indices, weights, minlength=rows.shape[1]), float).reshape(shape)

    def matrix(self, dofs: DofMap) -> sp.csr_array:
        """Rows (m, f) on the unknowns, ``G J``; with friction, the tangential rows follow below."""
        return dofs.rows(self._all())

    def _all(self) -> sp.csr_array:
        if not self.shear.count:
            return self.gradient
        return sp.vstack([self.gradient, self.shear.gradient()], format="csr")

    def reachable(self, dofs: DofMap) -> BoolArray:
        """Rows (m,) with an opponent that the unknowns can move."""
        return np.asarray(self.near & (dofs.squares(self.gradient) > 1e-12))

    def motion(self, values: Array, which: BoolArray, free: BoolArray) -> Array:
        """Smallest nodal field (n, d) on the free components of slave nodes, with normal components ``values`` (m,) on
        the rows ``which`` (m,).

        Where a node has several rows, or a slave node belongs to facets of other rows, all nodes of the rows move:
        slave nodes alone would go far aside to satisfy rows that are nearly parallel.
        """
        out = np.zeros(free.shape)
        rows = self._own(which, free)
        own = np.unique(self.node[rows])
        parts = (own[:, None] * free.shape[1] + np.arange(free.shape[1])).ravel()
        some = self.gradient[rows]
        coupled = some[:, parts[free.ravel()[parts]]].nnz > (free[self.node[rows]] & (self.normal[rows] != 0.0)).sum()
        if coupled:
            felt = some @ sp.diags_array(free.ravel().astype(float))
            out.ravel()[:] = felt.T @ np.linalg.lstsq((felt @ felt.T).toarray(), values[rows], rcond=1e-12)[0]
            return out
        node, n = self.node[rows], self.normal[rows] * free[self.node[rows]]
        if len(np.unique(node)) == len(node):
            out[node] = (values[rows] / (n**2).sum(axis=1))[:, None] * n
            return out
        for i in np.unique(node):
            here = node == i
            out[i] = np.linalg.lstsq(n[here], values[rows][here], rcond=1e-12)[0]
        return out

    def normal_forces(self, force: Array, which: BoolArray, free: BoolArray) -> Array:
        """Normal forces (m,) of the rows ``which`` (m,) that sum up to forces (n, d) on the free components of their
        slave nodes.

        If one obstacle touches a node more than once, its rows share the force evenly.
        """
        out = np.zeros(len(self.node))
        rows = self._own(which, free)
        node, n = self.node[rows], self.normal[rows] * free[self.node[rows]]
        pull = force[node] * free[node]
        out[rows] = np.einsum("mi,mi->m", n, pull) / (n**2).sum(axis=1)
        for i in np.flatnonzero(np.bincount(node, minlength=0) > 1) if len(node) else ():
            here = node == i
            out[rows[here]] = np.linalg.lstsq(n[here].T, pull[here][0], rcond=1e-12)[0]
        return out

    def _own(self, which: BoolArray, free: BoolArray) -> IntArray:
        """Numbers (k,) of those of the rows ``which`` that the motion of their slave node changes."""
        rows = np.flatnonzero(which & self.near)
        found: IntArray = rows[((self.normal[rows] * free[self.node[rows]]) ** 2).sum(axis=1) > 1e-12]
        return found

    def of_contact(self, contact: int) -> BoolArray:
        """Mask (m,) of the rows of one contact."""
        return self.contact == contact


def on_nodes(node: IntArray, n: int) -> sp.csr_array:
    """Weights (m, n) of rows that depend on their slave node only.

    Examples
    --------
    >>> on_nodes(np.array([2, 0]), 3).toarray().tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    m = len(node)
    return sp.csr_array((np.ones(m), np.asarray(node), np.arange(m + 1)), shape=(m, n))
