"""The contact conditions of a model as plain arrays, linear in the displacement: a row for each pair that may touch."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.contact.shear import Shear
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Candidates:
    """Rows of the contact conditions ``gap >= 0``, ``gap = offset + G u``.

    Parameters
    ----------
    node
        (m,) slave node of the model.
    contact
        (m,) number of the contact that the row belongs to.
    normal
        (m, d) unit normal of the opponent, into free space.
    gradient
        (m, n d) rows G on the components ``j d + i`` of a nodal field.
    offset
        (m,) gap at zero displacement [m]; infinite for rows with no opponent in reach.
    drive
        (m,) normal motion of a driven opponent over the slab, positive towards the slave [m].
    labels
        Names of the contacts.
    shear
        The same rows along the surfaces, where a contact has friction.
    """

    node: IntArray
    contact: IntArray
    normal: Array
    gradient: sp.csr_array
    offset: Array
    drive: Array
    labels: tuple[str, ...]
    shear: Shear | None = None

    @property
    def near(self) -> BoolArray:
        """Rows (m,) that have an opponent."""
        return np.isfinite(self.offset)

    def gap(self, u: Array) -> Array:
        """Gap (m,) at the displacement ``u`` (n, d) [m]."""
        return self.offset + self.along(u)

    def along(self, field: Array) -> Array:
        """Normal component (m,) of a nodal field (n, d), relative to the opponent's."""
        return np.asarray(self.gradient @ field.ravel())

    def spread(self, values: Array, shape: tuple[int, int]) -> Array:
        """Nodal field (n, d) ``G^T values`` of row values (m,)."""
        return np.asarray(self.gradient.T @ values).reshape(shape)

    def matrix(self, free: BoolArray) -> sp.csr_array:
        """Rows G (m, f) on the free components of a field; where there is friction those of the shear below them."""
        return sp.csr_array(self._all()[:, np.flatnonzero(free.ravel())])

    def _all(self) -> sp.csr_array:
        return self.gradient if self.shear is None else sp.vstack([self.gradient, self.shear.gradient()], format="csr")

    def reachable(self, free: BoolArray) -> BoolArray:
        """Rows (m,) with an opponent that the free components (n, d) can move."""
        return np.asarray(self.near & (self.gradient.power(2) @ free.ravel().astype(float) > 1e-12))

    def motion(self, values: Array, which: BoolArray, free: BoolArray) -> Array:
        """Least nodal field (n, d) on the free components of the slave nodes whose normal components are ``values``
        (m,) on some rows.

        A node in several of the rows gets the least one that meets them all, and so do slave nodes that rows of
        others slide on.
        """
        out = np.zeros(free.shape)
        rows = self._own(which, free)
        own = np.unique(self.node[rows])
        parts = (own[:, None] * free.shape[1] + np.arange(free.shape[1])).ravel()
        felt = self.gradient[rows][:, parts[free.ravel()[parts]]]
        if felt.nnz > (free[self.node[rows]] & (self.normal[rows] != 0.0)).sum():
            out.ravel()[parts[free.ravel()[parts]]] = np.linalg.lstsq(felt.toarray(), values[rows], rcond=1e-12)[0]
            return out
        node, n = self.node[rows], self.normal[rows] * free[self.node[rows]]
        if len(np.unique(node)) == len(node):
            out[node] = (values[rows] / (n**2).sum(axis=1))[:, None] * n
            return out
        for i in np.unique(node):
            here = node == i
            out[i] = np.linalg.lstsq(n[here], values[rows][here], rcond=1e-12)[0]
        return out

    def shares(self, force: Array, which: BoolArray, free: BoolArray) -> Array:
        """Normal forces (m,) of some rows that make up forces (n, d) in the free components of their slave nodes.

        Where one obstacle touches a node more than once, its contacts share the force evenly.
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
        """Those of some rows (k,) that their slave node itself can move."""
        rows = np.flatnonzero(which & self.near)
        found: IntArray = rows[((self.normal[rows] * free[self.node[rows]]) ** 2).sum(axis=1) > 1e-12]
        return found

    def of(self, contact: int) -> BoolArray:
        """Mask (m,) of the rows of one contact."""
        return self.contact == contact


def on_nodes(node: IntArray, n: int) -> sp.csr_array:
    """Weights (m, n) of rows that depend on their slave node alone.

    Examples
    --------
    >>> on_nodes(np.array([2, 0]), 3).toarray().tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    m = len(node)
    return sp.csr_array((np.ones(m), np.asarray(node), np.arange(m + 1)), shape=(m, n))
