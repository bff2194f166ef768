"""Nodes of the solids that have a temperature, with rigid bodies behind them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.following_heat import FollowingHeat, joined_heat, kept_nodes


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatedNodes:
    """The k nodes with a temperature of their own among the n nodes of all solids, and r rigid bodies.

    Parameters
    ----------
    number
        (k,) their numbers.
    count, rigid
        Numbers of the nodes n and of the rigid bodies r.
    hanging
        Heat of all n nodes from that of these k; None if no node hangs.
    """

    number: IntArray
    count: int
    rigid: int = 0
    hanging: FollowingHeat | None = None

    def temperatures(self, own: Array) -> Array:
        """Temperatures (..., n) of all nodes from those (..., k + r); zero on nodes without."""
        return self._on_all(own, None if self.hanging is None else self.hanging.follow)

    def shared(self, own: Array, rest: float = 0.0) -> Array:
        """Values (..., n) that belong to the heat of all nodes, from those (..., k + r); ``rest`` on nodes without."""
        return self._on_all(own, None if self.hanging is None else self.hanging.spread, rest)

    def sums(self, everywhere: Array) -> Array:
        """Heat (..., k + r) of the nodes and of rigid bodies, from that (..., n) of all nodes; zero of rigid bodies."""
        if self.hanging is not None:
            own = np.asarray((self.hanging.spread.T @ everywhere.T).T)
        else:
            own = everywhere if len(self.number) == self.count else everywhere[..., self.number]
        if not self.rigid:
            return own
        return np.concatenate([own, np.zeros((*everywhere.shape[:-1], self.rigid))], axis=-1)

    def rows(self, weights: sp.csr_array) -> sp.csr_array:
        """Weights (m, k + r) of the nodes with a temperature and of rigid bodies, from those (m, n) of all nodes."""
        own = sp.csr_array(weights[:, self.number] if self.hanging is None else weights @ self.hanging.follow)
        return sp.csr_array((own.data, own.indices, own.indptr), shape=(own.shape[0], own.shape[1] + self.rigid))

    def _on_all(self, own: Array, matrix: sp.csr_array | None, rest: float = 0.0) -> Array:
        """Values (..., n) on all nodes."""
        own = own[..., : len(self.number)]
        if matrix is not None:
            return rest + np.asarray((matrix @ (own - rest).T).T)
        if len(self.number) == self.count:
            return own
        out = np.full((*own.shape[:-1], self.count), rest)
        out[..., self.number] = own
        return out


def heated_nodes(parts: Mapping[str, DiscreteSolid], count: int, rigid: int = 0) -> HeatedNodes:
    """Nodes with a temperature of some solids among ``count`` nodes of all, with rigid bodies behind them.

    Parameters
    ----------
    parts
        The solids with heat, in the order of their nodes.
    """
    solids = list(parts.values())
    number = np.concatenate([kept_nodes(part.mesh) + part.nodes.start for part in solids])
    found = joined_heat([part.mesh for part in solids])
    if found is not None:
        every = np.concatenate([np.arange(part.nodes.start, part.nodes.stop) for part in solids])
        place = sp.csr_array((np.ones(len(every)), (every, np.arange(len(every)))), shape=(count, len(every)))
        found = FollowingHeat(follow=sp.csr_array(place @ found.follow), spread=sp.csr_array(place @ found.spread))
    return HeatedNodes(number=number, count=count, rigid=rigid, hanging=found)
