"""Vector space over several ranks: sums that have the same bits for any number of them.

Every rank holds the values of its own nodes and copies of others, with the same bits.  Sums are taken over own nodes,
as exact integers (:mod:`softway.kernels.linalg.exact_sum`), and rounded once.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.linalg.exact_sum import PLACES, digits, rounded_sum
from softway.ranks.interface import Exchange, Ranks


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shares:
    """Sums over values of which every one belongs to one rank.

    Parameters
    ----------
    ranks
        The ranks.
    own
        (k,) numbers of the values that belong to this rank.
    length
        Number of the values that it holds; in longer arrays the rest is the same on all ranks and belongs to the first.
    """

    ranks: Ranks
    own: IntArray
    length: int

    def mine(self, field: Array) -> Array:
        """Own values (k, ...) of a field (n, ...), or of a longer one.

        Raises
        ------
        ValueError
            If the field is shorter: it is not one of the nodes or unknowns of the rank.
        """
        if len(field) < self.length:
            raise ValueError(f"{len(field)} values, where this rank has {self.length}")
        found = field[: self.length][self.own]
        if len(field) == self.length:
            return found
        return np.concatenate([found, field[self.length :]]) if self.ranks.rank == 0 else found

    def summed(self, values: Array) -> Array:
        """Sums (k,) over all ranks of own values (n, k)."""
        return totalled(self.ranks, values)


def totalled(ranks: Ranks, values: Array) -> Array:
    """Sums (k,) over all ranks of their values (n, k): exact, rounded once.

    Examples
    --------
    >>> from softway.ranks.alone import Alone
    >>> totalled(Alone(), np.array([[1e300], [1.0], [-1e300]])).tolist()
    [1.0]
    """
    found = digits(values) if values.shape[1] else np.zeros((0, PLACES), np.int64)
    return np.array([rounded_sum(places) for places in ranks.added(found)], float)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankSpace:
    """Nodes of a rank, or their unknowns; see :class:`~softway.bodies.assembled.vector_space.VectorSpace`.

    Parameters
    ----------
    ranks
        The ranks.
    shares
        Own nodes, or own unknowns.
    solids
        Nodes of each solid on this rank.
    exchange
        Exchange of the nodes; None for unknowns.
    unknowns
        Space of the unknowns; None for the space of these themselves.
    """

    ranks: Ranks
    shares: Shares
    solids: tuple[slice, ...] = ()
    exchange: Exchange | None = None
    unknowns: "RankSpace | None" = None

    @property
    def of_unknowns(self) -> "RankSpace":
        """Space of the unknowns."""
        return self if self.unknowns is None else self.unknowns

    def greatest(self, *fields: Array) -> float:
        """Greatest magnitude of all values; nan if one is."""
        found = max(float(np.abs(f).max(initial=0.0)) for f in fields)
        lost = any(bool(np.isnan(f).any()) for f in fields)
        most = self.ranks.greatest(np.array([0.0 if lost else found, float(lost)]))
        return float("nan") if most[1] else float(most[0])

    def least(self, field: Array) -> float:
        """Least value."""
        return -float(self.ranks.greatest(np.array([-field.min(initial=np.inf)]))[0])

    def total(self, density: Array | BoolArray) -> float:
        """Sum of all values."""
        mine = self.shares.mine(np.asarray(density))
        return float(self.shares.summed(np.asarray(mine, float).reshape(-1, 1))[0])

    def mean(self, density: Array) -> float:
        """Mean of all values."""
        mine = self.shares.mine(density).reshape(-1, 1)
        both = self.shares.summed(np.concatenate([mine, np.ones_like(mine)], axis=1))
        return float(both[0] / both[1])

    def sums(self, density: Array) -> Array:
        """Sums over the first axis."""
        mine = self.shares.mine(density)
        return self.shares.summed(_columns(mine)).reshape(density.shape[1:])

    def totals(self, density: Array) -> Array:
        """Sums (parts,) over each solid; of one that is not there, zero."""
        return np.asarray(self.totals_of([density])[0])

    def totals_of(self, densities: Sequence[Array]) -> Array:
        """Sums (k, parts) over each solid, in one message."""
        k, parts = len(densities), len(self.solids)
        mask = np.zeros((self.shares.length, parts))
        for number, rows in enumerate(self.solids):
            mask[rows, number] = 1.0
        where = self.shares.mine(mask)[:, :, None].astype(bool)
        columns = []
        for density in densities:
            mine = self.shares.mine(_columns(density))
            columns.append(np.where(where, mine[:, None, :], 0.0).transpose(0, 2, 1).reshape(-1, parts))
        return self.shares.summed(np.concatenate(columns, axis=1)).reshape(k, parts)

    def dot(self, a: Array, b: Array) -> float:
        """Inner product."""
        return self.total(a * b)

    def norm(self, field: Array) -> float:
        """Euclidean norm."""
        return float(np.sqrt(self.dot(field, field)))

    def products(self, a: Array, b: Array) -> Array:
        """``a^T b`` over the first axis."""
        left, right = (self.shares.mine(np.asarray(x, float)) for x in (a, b))
        shape = a.shape[1:] + b.shape[1:]
        pairs = _columns(left)[:, :, None] * _columns(right)[:, None, :]
        return self.shares.summed(_columns(pairs)).reshape(shape)

    def products_of(self, a: Array, vectors: Sequence[Array]) -> tuple[Array, ...]:
        """``a^T b`` of several vectors, in one message."""
        return tuple(self.products(a, np.stack(vectors, axis=1)).T)

    def works(self, forces: Array, motion: Array) -> Array:
        """Works (k,) of force fields along a motion."""
        mine = [self.shares.mine(f * motion).ravel() for f in forces]
        return self.shares.summed(np.stack(mine, axis=1)) if mine else np.zeros(0)

    def every(self, mask: BoolArray) -> bool:
        """True if all values are true."""
        return not self.ranks.greatest(np.array([float(not mask.all())]))[0]

    def gather(self, field: Array) -> Array:
        """The field: every rank has copies of all nodes that may touch."""
        return field

    def among(self, rows: slice | BoolArray) -> "RankSpace":
        """Space of some of the nodes."""
        numbers = np.arange(self.shares.length)[rows]
        own = np.flatnonzero(np.isin(numbers, self.shares.own, assume_unique=True))
        return RankSpace(ranks=self.ranks, shares=replace(self.shares, own=own, length=len(numbers)))

    def filled(self, field: Array) -> Array:
        """Field (n, ...) of the nodes with the values of others from the ranks that own them."""
        assert self.exchange is not None
        return self.ranks.exchanged(self.exchange, field)

    def combined(self, weights: Array, fields: Array) -> Array:
        """Sum (f,) of fields (k, f) with weights (k,), one after the other."""
        out = weights[0] * fields[0]
        for weight, field in zip(weights[1:], fields[1:], strict=True):
            out = out + weight * field
        return out


def _columns(values: Array) -> Array:
    """Values (n, k) of an array (n, ...), also where n is zero."""
    return values.reshape(len(values), int(np.prod(values.shape[1:])))
