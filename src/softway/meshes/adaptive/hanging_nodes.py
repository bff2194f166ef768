"""Hanging nodes: nodes on an edge or a face of a larger cell beside, which follow the nodes of it."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HangingNodes:
    """Hanging nodes of a mesh, on edges or faces of larger cells.

    Parameters
    ----------
    node
        (k,) nodes.
    parents
        (k, p) nodes of the edge or face; -1 for none.  None of them hangs.
    weights
        (k, p) shape functions of the edge or face at the hanging node; zero for no parent.
    inner
        (f, c) corners of the facets of larger cells beside smaller ones, and of those of the smaller ones: they belong
        to one cell, and are no boundary.

    Examples
    --------
    >>> edges = np.array([[0, 1], [0, 2], [2, 1]])
    >>> half = HangingNodes(node=np.array([2]), parents=edges[:1], weights=np.array([[0.5, 0.5]]), inner=edges)
    >>> half.following(np.array([[0.0], [4.0], [9.0]])).tolist()
    [[0.0], [4.0], [2.0]]
    """

    node: IntArray
    parents: IntArray
    weights: Array
    inner: IntArray

    def __post_init__(self) -> None:
        for table in (self.node, self.parents, self.weights, self.inner):
            table.flags.writeable = False

    def follow(self, count: int) -> sp.csr_array:
        """Motion (n, n) of all nodes from that of those that do not hang; n is the ``count`` of nodes."""
        rest, used = np.setdiff1d(np.arange(count), self.node), self.weights != 0.0
        rows = np.concatenate([rest, np.broadcast_to(self.node[:, None], used.shape)[used]])
        columns = np.concatenate([rest, self.parents[used]])
        values = np.concatenate([np.ones(len(rest)), self.weights[used]])
        return sp.csr_array((values, (rows, columns)), shape=(count, count))

    def following(self, field: Array) -> Array:
        """Field (n, k) whose values at the hanging nodes follow their parents."""
        return np.asarray(self.follow(len(field)) @ field)

    def inside(self, facets: IntArray) -> BoolArray:
        """True (f,) for facets of one cell, by their corners (f, c), that are no boundary."""
        both = np.sort(np.concatenate([self.inner, facets]), axis=1)
        number = np.unique(both, axis=0, return_inverse=True)[1].ravel()
        return np.asarray(np.isin(number[len(self.inner) :], number[: len(self.inner)]))


def require_none(hanging: HangingNodes | None, what: str) -> None:
    """Refuse a mesh with hanging nodes, which do not fit ``what``.

    Raises
    ------
    InputError
        At the place of the mesh.

    Examples
    --------
    >>> require_none(None, "ties")
    """
    if hanging is not None:
        problem = f"{len(hanging.node)} hanging nodes, and {what}"
        raise InputError("mesh", problem, f"a mesh whose cells share whole facets, or no {what}")
