"""The nodes that may touch, as plain arrays: one row for each node and obstacle."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Candidates:
    """Rows of the contact conditions ``gap >= 0`` against half-spaces.

    Parameters
    ----------
    node
        (m,) node of the model.
    contact
        (m,) number of the contact that the row belongs to.
    normal
        (m, d) unit normal of the obstacle, into free space.
    offset
        (m,) gap of the undeformed reference position [m].
    labels
        Names of the contacts.
    """

    node: IntArray
    contact: IntArray
    normal: Array
    offset: Array
    labels: tuple[str, ...]

    def gap(self, u: Array) -> Array:
        """Gap (m,) at the displacement ``u`` (n, d) [m]."""
        return self.offset + self.along(u)

    def along(self, field: Array) -> Array:
        """Normal component (m,) of a nodal field (n, d)."""
        return np.einsum("mi,mi->m", self.normal, field[self.node])

    def spread(self, values: Array, shape: tuple[int, int]) -> Array:
        """Nodal field (n, d) of row values (m,) along the normals."""
        out = np.zeros(shape)
        np.add.at(out, self.node, values[:, None] * self.normal)
        return out

    def matrix(self, free: BoolArray) -> sp.csr_array:
        """Rows G (m, f) that give the normal component from the free components of a field."""
        d = self.normal.shape[1]
        m = len(self.node)
        number = np.cumsum(free.ravel()) - 1
        columns = self.node[:, None] * d + np.arange(d)
        keep = free.ravel()[columns]
        rows = np.broadcast_to(np.arange(m)[:, None], columns.shape)
        shape = (m, int(free.sum()))
        return sp.csr_array((self.normal[keep], (rows[keep], number[columns[keep]])), shape=shape)

    def reachable(self, free: BoolArray) -> BoolArray:
        """Rows (m,) that the free components (n, d) can move."""
        return np.asarray(((self.normal * free[self.node]) ** 2).sum(axis=1) > 1e-12)

    def motion(self, values: Array, which: BoolArray, free: BoolArray) -> Array:
        """Least nodal field (n, d) on the free components whose normal components are ``values`` (m,) on some rows.

        A node in several of the rows gets the least one that meets them all.
        """
        out = np.zeros(free.shape)
        rows = np.flatnonzero(which & self.reachable(free))
        node, n = self.node[rows], self.normal[rows] * free[self.node[rows]]
        if len(np.unique(node)) == len(node):
            out[node] = (values[rows] / (n**2).sum(axis=1))[:, None] * n
            return out
        for i in np.unique(node):
            here = node == i
            out[i] = np.linalg.lstsq(n[here], values[rows][here], rcond=1e-12)[0]
        return out

    def shares(self, force: Array, which: BoolArray, free: BoolArray) -> Array:
        """Normal forces (m,) of some rows that make up nodal forces (n, d) in the free components.

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
