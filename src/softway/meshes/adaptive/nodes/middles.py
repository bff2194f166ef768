"""Nodes in the middle of edges that bisection has cut; each edge has one, whenever it is met."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import IntArray

SHIFT = 32
"""Bits of the greater number in the code of a pair of nodes."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Middles:
    """Middles of edges.

    Parameters
    ----------
    codes
        (m,) codes of the edges, in rising order.
    nodes
        (m,) node in the middle of each.
    count
        Number of nodes so far.

    Examples
    --------
    >>> Middles.none(3).with_middles(np.array([[0, 1], [2, 0], [1, 0]]))[1].tolist()
    [3, 4, 3]
    """

    codes: IntArray
    nodes: IntArray
    count: int

    @classmethod
    def none(cls, count: int) -> "Middles":
        """No middles, in a mesh of ``count`` nodes."""
        return cls(codes=np.zeros(0, dtype=np.int64), nodes=np.zeros(0, dtype=np.int64), count=count)

    def with_middles(self, edges: IntArray) -> tuple["Middles", IntArray]:
        """Middles with those of ``edges`` (k, 2) too, and the node (k,) of each."""
        code = edge_codes(edges)
        new = np.setdiff1d(code, self.codes)
        codes = np.concatenate([self.codes, new])
        nodes = np.concatenate([self.nodes, self.count + np.arange(len(new))])
        order = np.argsort(codes, kind="stable")
        found = Middles(codes=codes[order], nodes=nodes[order], count=self.count + len(new))
        return found, found.nodes[np.searchsorted(found.codes, code)]


def edge_codes(edges: IntArray) -> IntArray:
    """Codes (k,) of edges (k, 2), the same in both directions."""
    return np.asarray((edges.min(axis=-1) << SHIFT) + edges.max(axis=-1))
