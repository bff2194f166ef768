"""The contact conditions of a model as plain arrays, linear in the displacement: one row for each pair that may touch."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Candidates:
    """Rows of the contact conditions ``gap >= 0``; row r of G is ``normal_r . sum_j weights[r, j] u_j``.

    Parameters
    ----------
    node
        (m,) slave node of the model.
    contact
        (m,) number of the contact that the row belongs to.
    normal
        (m, d) unit normal of the opponent, into free space.
    weights
        (m, n) one on the slave node, minus the weights of the nodes of a deformable opponent.
    offset
        (m,) gap at zero displacement [m]; infinite for rows with no opponent in reach.
    drive
        (m,) normal motion of a driven opponent over the slab, positive towards the slave [m].
    labels
        Names of the contacts.
    """

    node: IntArray
    contact: IntArray
    normal: Array
    weights: sp.csr_array
    offset: Array
    drive: Array
    labels: tuple[str, ...]

    @property
    def near(self) -> BoolArray:
        """Rows (m,) that have an opponent."""
        return np.isfinite(self.offset)

    def gap(self, u: Array) -> Array:
        """Gap (m,) at the displacement ``u`` (n, d) [m]."""
        return self.offset + self.along(u)

    def along(self, field: Array) -> Array:
        """Normal component (m,) of a nodal field (n, d), relative to the opponent's."""
        return np.einsum("mi,mi->m", self.normal, self.weights @ field)

    def spread(self, values: Array, shape: tuple[int, int]) -> Array:
        """Nodal field (n, d) ``G^T values`` of row values (m,)."""
        assert shape[0] == self.weights.shape[1]
        return np.asarray(self.weights.T @ (values[:, None] * self.normal))

    def matrix(self, free: BoolArray) -> sp.csr_array:
        """Rows G (m, f) on the free components of a field."""
        d = self.normal.shape[1]
        w = self.weights.tocoo()
        row, node = w.coords
        number = np.where(free.ravel(), np.cumsum(free.ravel()) - 1, -1)
        columns = number[node[:, None] * d + np.arange(d)]
        values = w.data[:, None] * self.normal[row]
        keep = columns >= 0
        rows = np.broadcast_to(row[:, None], columns.shape)
        shape = (len(self.node), int(free.sum()))
        return sp.csr_array((values[keep], (rows[keep], columns[keep])), shape=shape)

    def reachable(self, free: BoolArray) -> BoolArray:
        """Rows (m,) with an opponent that the free components (n, d) can move."""
        moved = self.weights.power(2) @ free.astype(float)
        return np.asarray(self.near & (np.einsum("mi,mi->m", self.normal**2, moved) > 1e-12))

    def motion(self, values: Array, which: BoolArray, free: BoolArray) -> Array:
        """Least nodal field (n, d) on the free components of the slave nodes whose normal components are ``values``
        (m,) on some rows.

        A node in several of the rows gets the least one that meets them all.
        """
        out = np.zeros(free.shape)
        rows = np.flatnonzero(which & self.near)
        rows = rows[((self.normal[rows] * free[self.node[rows]]) ** 2).sum(axis=1) > 1e-12]
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
        rows = np.flatnonzero(which & self.reachable(free))
        node, n = self.node[rows], self.normal[rows] * free[self.node[rows]]
        pull = force[node] * free[node]
        out[rows] = np.einsum("mi,mi->m", n, pull) / (n**2).sum(axis=1)
        for i in np.flatnonzero(np.bincount(node, minlength=0) > 1) if len(node) else ():
            here = node == i
            out[rows[here]] = np.linalg.lstsq(n[here].T, pull[here][0], rcond=1e-12)[0]
        return out

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
