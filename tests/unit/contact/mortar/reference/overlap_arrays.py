"""NumPy reference: integrals over the overlap of two surfaces of simplices."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Overlap:
    """Integrals of products of barycentric coordinates over the overlaps of s pairs of simplices [m^r].

    Parameters
    ----------
    pair
        (s,) number of the pair, ascending.
    own
        (k, k, s) with both coordinates on the slave simplex.
    cross
        (k, k, s) with one coordinate on the slave simplex, the other on the master simplex.

    Examples
    --------
    Two pairs of segments: the overlap of the first has a length of one, that of the second is empty:

    >>> third = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    >>> own = np.stack([third, 0.0 * third], axis=2)
    >>> common = Overlap(pair=np.array([4, 7]), own=own, cross=own)
    >>> common.measure.round(12).tolist(), common.subset(common.measure > 0.0).pair.tolist()
    ([1.0, 0.0], [4])
    """

    pair: IntArray
    own: Array
    cross: Array

    @property
    def measure(self) -> Array:
        """Length or area (s,) of the overlap."""
        return np.asarray(self.own.sum(axis=(0, 1)))

    def subset(self, which: BoolArray) -> "Overlap":
        """Subset of the pairs."""
        return Overlap(
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
