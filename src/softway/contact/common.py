"""Integrals over what two surfaces of simplices have in common."""

from dataclasses import dataclass

import numpy as np

from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Common:
    """Integrals of products of barycentric coordinates over what s pairs of simplices have in common [m^r].

    Parameters
    ----------
    pair
        (s,) number of the pair, ascending.
    own
        (k, k, s) both coordinates on the slave simplex.
    cross
        (k, k, s) one on the slave simplex, the other on the master simplex.

    Examples
    --------
    Two pairs of segments, of which the first have a length of one in common, the second nothing:

    >>> third = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    >>> own = np.stack([third, 0.0 * third], axis=2)
    >>> common = Common(pair=np.array([4, 7]), own=own, cross=own)
    >>> common.measure.round(12).tolist(), common.take(common.measure > 0.0).pair.tolist()
    ([1.0, 0.0], [4])
    """

    pair: IntArray
    own: Array
    cross: Array

    @property
    def measure(self) -> Array:
        """Length or area (s,) of what is common."""
        return np.asarray(self.own.sum(axis=(0, 1)))

    def take(self, which: BoolArray) -> "Common":
        """Some of the pairs."""
        return Common(
            pair=self.pair[which],
            own=np.compress(which, self.own, axis=2),
            cross=np.compress(which, self.cross, axis=2),
        )

    def mass(self, simplex: IntArray, count: int) -> Array:
        """Sums (k, k, count) of ``own`` over the pairs of each slave simplex; ``simplex`` (s,) ascends."""
        out = np.zeros((*self.own.shape[:2], count))
        first = np.flatnonzero(np.diff(simplex, prepend=-1))
        if len(first):
            out[..., simplex[first]] = np.add.reduceat(self.own, first, axis=2)
        return out
