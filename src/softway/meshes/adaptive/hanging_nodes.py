"""Hanging nodes: nodes inside an edge or a face of a larger cell beside, which follow the corners of it."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HangingNodes:
    """Hanging nodes of a mesh, in the middle of edges or faces of larger cells.

    Parameters
    ----------
    node
        (k,) nodes.
    parents
        (k, p) corners of the edge or face, the first 2 or all 4 of them; -1 for no corner.  None of them hangs.

    Examples
    --------
    >>> middle = HangingNodes(node=np.array([2]), parents=np.array([[0, 1]]))
    >>> middle.following(np.array([[0.0], [4.0], [9.0]])).tolist()
    [[0.0], [4.0], [2.0]]
    """

    node: IntArray
    parents: IntArray

    def __post_init__(self) -> None:
        self.node.flags.writeable = self.parents.flags.writeable = False

    def follow(self, count: int) -> sp.csr_array:
        """Motion (n, n) of all nodes from that of those that do not hang; n is the ``count`` of nodes."""
        rest = np.setdiff1d(np.arange(count), self.node)
        used = self.parents >= 0
        shares = used / used.sum(axis=1)[:, None]
        rows = np.concatenate([rest, np.broadcast_to(self.node[:, None], used.shape)[used]])
        columns = np.concatenate([rest, self.parents[used]])
        return sp.csr_array((np.concatenate([np.ones(len(rest)), shares[used]]), (rows, columns)), shape=(count, count))

    def following(self, field: Array) -> Array:
        """Field (n, k) with the means of their parents at the hanging nodes."""
        return np.asarray(self.follow(len(field)) @ field)

    def inside(self, facets: IntArray, corners: int) -> BoolArray:
        """True (f,) for ``facets`` (f, b) of single cells that lie inside a body: a hanging node is inside them, or
        they have a corner inside a larger facet.

        Parameters
        ----------
        facets
            Nodes of the facets, the corners first.
        corners
            Number of corners of a facet; a hanging node with as many parents lies inside a facet.
        """
        own = (self.parents >= 0).sum(axis=1) == corners
        whole = np.sort(self.parents[own][:, :corners], axis=1)
        both = np.concatenate([whole, np.sort(facets[:, :corners], axis=1)])
        number = np.unique(both, axis=0, return_inverse=True)[1].ravel()
        parent = np.isin(number[len(whole) :], number[: len(whole)])
        return np.asarray(parent | np.isin(facets[:, :corners], self.node[own]).any(axis=1))
