"""Heat on an adapted mesh: its content passes over exactly, without new extremes, and its entropy never falls
(docs/theory/bodies/adaptive.md#heat).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.overlay import overlay
from softway.meshes.adaptive.refinement import AdaptedMesh

HALVINGS = 60
"""Bisections of the share of the differences that the entropy allows."""
ROUNDING = 1e-14
"""Fall of the entropy of a place, relative to its terms, that is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Heated:
    """Mesh of e cells with heat at its n nodes: the capacities, or masses, (e, a) of the nodes of each cell."""

    adapted: AdaptedMesh
    shares: Array

    @property
    def cells(self) -> IntArray:
        """Nodes (e, a) of the cells."""
        return next(iter(self.adapted.mesh.blocks.values()))


def carried_heat(
    one: Heated, other: Heated, at_nodes: sp.csr_array, values: Array, entropy: Callable[[Array], Array]
) -> Array:
    """Values (m,) on mesh B of a quantity per capacity from those (n,) on mesh A: temperatures, specific contents.

    Each place, the coarser of two leaves that overlap, keeps its content ``sum c_i T_i``.  Its nodes in B have the
    values of A there, shifted evenly; their differences from the mean are smaller where their entropy
    ``sum c_i s(T_i)`` would fall or a value would leave the range of the place.  A node takes the mean over the places
    around it, by their capacities.

    Parameters
    ----------
    one, other
        Meshes A and B.
    at_nodes
        (m, n) values at the nodes of B of fields of A.
    values
        (n,) values on A.
    entropy
        Concave entropy s of the values.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.adaptive.overlay import embedding
    >>> from softway.meshes.generators.shapes import interval
    >>> base = interval(2.0, cells=2)
    >>> coarse, fine = refined(base, np.array([0, 0])), refined(base, np.array([1, 0]))
    >>> halves = (0.5 * mesh.mesh.cell_edges()[0][:, None] * np.ones(2) for mesh in (coarse, fine))
    >>> one, two = (Heated(adapted=m, shares=half) for m, half in zip((coarse, fine), halves))
    >>> carried_heat(one, two, embedding(coarse, fine), np.array([1.0, 3.0, 2.0]), np.log).round(12).tolist()
    [1.0, 3.0, 2.0, 2.0]
    """
    place, content, total, ends = _places(one, other, values, entropy)
    near, cells = np.asarray(at_nodes @ values), other.cells
    count, shares = len(content), other.shares
    capacity = np.bincount(place, shares.sum(axis=1), count)
    mean = content / capacity
    found = near[cells] - (np.bincount(place, (shares * near[cells]).sum(axis=1), count) / capacity)[place][:, None]
    part = _within(found, mean, place, ends)
    part = _rising(found, mean, place, shares, part, total, entropy)
    own = mean[place][:, None] + part[place][:, None] * found
    size = other.adapted.mesh.n_nodes
    weight = np.bincount(cells.ravel(), shares.ravel(), size)
    return np.bincount(cells.ravel(), (shares * own).ravel(), size) / weight


def _places(
    one: Heated, other: Heated, values: Array, entropy: Callable[[Array], Array]
) -> tuple[IntArray, Array, Array, tuple[Array, Array]]:
    """Place (f,) of each cell of B, and the content, entropy, least and greatest value of each place in A."""
    found = overlay(one.adapted, other.adapted)
    count = len(one.shares) + len(other.shares)
    mine, theirs = np.arange(len(one.shares)), np.arange(len(one.shares), count)
    mine[found.inside_other.fine] = len(one.shares) + found.inside_other.coarse
    theirs[found.inside_one.fine] = found.inside_one.coarse
    used, number = np.unique(np.concatenate([mine, theirs]), return_inverse=True)
    mine, theirs = number[: len(mine)], number[len(mine) :]
    at = values[one.cells]
    content = np.bincount(mine, (one.shares * at).sum(axis=1), len(used)).astype(float)
    total = np.bincount(mine, (one.shares * entropy(at)).sum(axis=1), len(used)).astype(float)
    least: Array = np.full(len(used), np.inf)
    most: Array = np.full(len(used), -np.inf)
    np.minimum.at(least, mine, at.min(axis=1))
    np.maximum.at(most, mine, at.max(axis=1))
    return np.asarray(theirs), content, total, (least, most)


def _within(found: Array, mean: Array, place: IntArray, ends: tuple[Array, Array]) -> Array:
    """Greatest share up to one, for each place, of the differences (f, a) from its mean that keeps its range."""
    out = np.ones(len(mean))
    for end, sign in zip(ends, (-1.0, 1.0), strict=True):
        room, most = np.maximum(sign * (end - mean), 0.0), np.zeros(len(mean))
        np.maximum.at(most, place, (sign * found).max(axis=1))
        over = most > room * (1.0 + ROUNDING)
        out[over] = np.minimum(out[over], room[over] / most[over])
    return out


def _rising(
    found: Array, mean: Array, place: IntArray, shares: Array, part: Array, total: Array,
    entropy: Callable[[Array], Array],
) -> Array:  # fmt: skip
    """Greatest share up to ``part``, for each place, with which its entropy does not fall below ``total``."""

    def falls(some: Array) -> BoolArray:
        terms = shares * entropy(mean[place][:, None] + some[place][:, None] * found)
        now = np.bincount(place, terms.sum(axis=1), len(mean))
        scale = np.bincount(place, abs(terms).sum(axis=1), len(mean))
        return np.asarray(now < total - ROUNDING * scale)

    low, high = part.copy(), part.copy()
    wrong = falls(part)
    low[wrong] = 0.0
    for _ in range(HALVINGS if wrong.any() else 0):
        middle = 0.5 * (low + high)
        down = falls(middle) & wrong
        high, low = np.where(down, middle, high), np.where(wrong & ~down, middle, low)
    return low
