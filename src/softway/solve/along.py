"""Contact rows in terms of the directions in which contact pushes: each its own direction, or a mixture of some."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Own:
    """Rows that are directions themselves: row i is the direction ``index[i]`` of ``count``, none where that is -1."""

    index: IntArray
    count: int

    @property
    def used(self) -> IntArray:
        """The directions that rows are made of (k,)."""
        return self.index[self.index >= 0]

    def along(self, values: Array) -> Array:
        """Values (m,) of the rows from those of the directions (b,)."""
        return np.where(self.index >= 0, values[self.index], 0.0) if len(values) else np.zeros(len(self.index))

    def spread(self, amounts: Array) -> Array:
        """Pushes (b,) along the directions from those of the rows (m,)."""
        out = np.zeros(self.count)
        own = self.index >= 0
        out[self.index[own]] = amounts[own]
        return out

    def part(self, which: IntArray) -> "Own":
        """Some of the rows."""
        return Own(self.index[which], self.count)

    def folded(self, compliance: Array) -> Array:
        """Compliance (m, m) of the rows from that of the used directions (k, k)."""
        own = self.index >= 0
        if own.all():
            return compliance
        out = np.zeros((len(own), len(own)))
        out[np.ix_(own, own)] = compliance
        return out


@dataclass(frozen=True, slots=True, eq=False)
class Mixed:
    """Rows with coefficients C (m, b) along the directions."""

    matrix: sp.csr_array

    @property
    def used(self) -> IntArray:
        """The directions that rows are made of (k,)."""
        return np.unique(self.matrix.indices)

    def along(self, values: Array) -> Array:
        """Values (m,) of the rows from those of the directions (b,)."""
        return np.asarray(self.matrix @ values)

    def spread(self, amounts: Array) -> Array:
        """Pushes (b,) along the directions from those of the rows (m,)."""
        return np.asarray(self.matrix.T @ amounts)

    def part(self, which: IntArray) -> "Mixed":
        """Some of the rows."""
        return Mixed(sp.csr_array(self.matrix[which]))

    def folded(self, compliance: Array) -> Array:
        """Compliance (m, m) of the rows from that of the used directions (k, k)."""
        inner = self.matrix[:, self.used]
        return np.asarray((inner @ compliance) @ inner.T)


Along = Own | Mixed
