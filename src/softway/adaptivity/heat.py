"""Heat on an adapted mesh: its content passes over exactly, without new extremes, and its entropy never falls
(docs/theory/bodies/adaptive.md#heat).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.following_heat import following_heat, kept_nodes
from softway.meshes.adaptive.overlay import overlay
from softway.meshes.adaptive.refinement import AdaptedMesh

HALVINGS = 60
"""Bisections of the share of the differences that the entropy allows."""
ROUNDING = 1e-14
"""Fall of the entropy of a place, relative to its terms, that is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Heated:
    """Mesh of e cells with heat at its n nodes: the capacities, or masses, (e, a) of the nodes of each cell.

    What hanging nodes hold belongs to the nodes that they follow.
    """

    adapted: AdaptedMesh
    shares: Array

    @property
    def cells(self) -> IntArray:
        """Nodes (e, a) of the cells."""
        return next(iter(self.adapted.mesh.blocks.values()))

    def held(self) -> "HeldByNodes":
        """What the cells have at the nodes that do not hang."""
        mesh, (count, width) = self.adapted.mesh, self.shares.shape
        cell, follows = np.repeat(np.arange(count), width), following_heat(mesh)
        if follows is None:
            return HeldByNodes(cell=cell, node=self.cells.ravel(), share=self.shares.ravel(), count=count)
        own = sp.csr_array((self.shares.ravel(), (cell, self.cells.ravel())), shape=(count, mesh.n_nodes))
        found = sp.coo_array(own @ follows.spread)
        row, column = (axis.astype(np.int64) for axis in found.coords)
        return HeldByNodes(cell=row, node=kept_nodes(mesh)[column], share=found.data, count=count)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldByNodes:
    """Shares (k,) of nodes (k,) in the heat of cells (k,), of which there are ``count``."""

    cell: IntArray
    node: IntArray
    share: Array
    count: int


def carried_heat(
    one: Heated, other: Heated, at_nodes: sp.csr_array, values: Array, entropy: Callable[[Array], Array]
) -> Array:
    """Values (m,) on mesh B of a quantity per capacity from those (n,) on mesh A: temperatures, specific contents.

    Each place, the coarser of two leaves that overlap, keeps its content ``sum c_i T_i``.  Its nodes in B have the
    values of A there, shifted evenly; their differences from the mean are smaller where their entropy
    ``sum c_i s(T_i)`` would fall or a value would leave the range of A around the place.  A node takes the mean over
    the places around it, by their capacities.

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
    near, mine, theirs = np.asarray(at_nodes @ values), one.held(), other.held()
    found = carried_contents(
        (one, other), (mine, theirs), (values[mine.node], near[theirs.node]), bounds_at(at_nodes, values), entropy
    )
    follows = following_heat(other.adapted.mesh)
    return found if follows is None else np.asarray(follows.follow @ found[kept_nodes(other.adapted.mesh)])


def bounds_at(at_nodes: sp.csr_array, values: Array) -> tuple[Array, Array]:
    """Least and greatest (m,) of the ``values`` (n,) that determine that at each node of B."""
    if not at_nodes.shape[0]:
        return np.zeros(0), np.zeros(0)
    at = values[at_nodes.indices]
    return np.minimum.reduceat(at, at_nodes.indptr[:-1]), np.maximum.reduceat(at, at_nodes.indptr[:-1])


def carried_contents(
    meshes: tuple[Heated, Heated],
    held: tuple[HeldByNodes, HeldByNodes],
    values: tuple[Array, Array],
    bounds: tuple[Array, Array],
    entropy: Callable[[Array], Array],
) -> Array:
    """Values (m,) at the nodes of B, zero at hanging ones, see :func:`carried_heat`.

    Parameters
    ----------
    meshes, held
        Meshes A and B, and what their cells have at the nodes.
    values
        Values on A at the nodes of its cells, and at those of the cells of B, in the order of ``held``.
    bounds
        Least and greatest values (m,) of A around the nodes of B.
    entropy
        Concave entropy of the values.
    """
    (mine, theirs), (before, near) = held, values
    places = _places(*meshes)
    old, place, share, node = places[0][mine.cell], places[1][theirs.cell], theirs.share, theirs.node
    count = int(max(places[0].max(), places[1].max())) + 1
    content: Array = np.bincount(old, mine.share * before, count).astype(float)
    total = np.bincount(old, mine.share * entropy(before), count).astype(float)
    least: Array = np.full(count, np.inf)
    most: Array = np.full(count, -np.inf)
    for at, low, high in ((old, before, before), (place, bounds[0][node], bounds[1][node])):
        np.minimum.at(least, at, low)
        np.maximum.at(most, at, high)
    capacity = np.bincount(place, share, count)
    mean = content / capacity
    differ = near - (np.bincount(place, share * near, count) / capacity)[place]
    part = _within(differ, mean, place, (least, most))
    part = _rising(differ, mean, place, share, part, total, entropy)
    own = mean[place] + part[place] * differ
    size = meshes[1].adapted.mesh.n_nodes
    weight = np.bincount(node, share, size)
    return np.bincount(node, share * own, size) / np.where(weight > 0.0, weight, 1.0)


def _places(one: Heated, other: Heated) -> tuple[IntArray, IntArray]:
    """Place of each cell of A (e,) and of B (f,), numbered without gaps."""
    found = overlay(one.adapted, other.adapted)
    count = len(one.shares) + len(other.shares)
    mine, theirs = np.arange(len(one.shares)), np.arange(len(one.shares), count)
    mine[found.inside_other.fine] = len(one.shares) + found.inside_other.coarse
    theirs[found.inside_one.fine] = found.inside_one.coarse
    number = np.unique(np.concatenate([mine, theirs]), return_inverse=True)[1]
    return np.asarray(number[: len(mine)]), np.asarray(number[len(mine) :])


def _within(found: Array, mean: Array, place: IntArray, ends: tuple[Array, Array]) -> Array:
    """Greatest share up to one, for each place, of the differences (k,) from its mean that keeps its range."""
    out = np.ones(len(mean))
    for end, sign in zip(ends, (-1.0, 1.0), strict=True):
        room, most = np.maximum(sign * (end - mean), 0.0), np.zeros(len(mean))
        np.maximum.at(most, place, sign * found)
        over = most > room * (1.0 + ROUNDING)
        out[over] = np.minimum(out[over], room[over] / most[over])
    return out


def _rising(
    found: Array, mean: Array, place: IntArray, shares: Array, part: Array, total: Array,
    entropy: Callable[[Array], Array],
) -> Array:  # fmt: skip
    """Greatest share up to ``part``, for each place, with which its entropy does not fall below ``total``."""

    def falls(some: Array) -> BoolArray:
        terms = shares * entropy(mean[place] + some[place] * found)
        now = np.bincount(place, terms, len(mean))
        return np.asarray(now < total - ROUNDING * np.bincount(place, abs(terms), len(mean)))

    low, high = part.copy(), part.copy()
    wrong = falls(part)
    low[wrong] = 0.0
    for _ in range(HALVINGS if wrong.any() else 0):
        middle = 0.5 * (low + high)
        down = falls(middle) & wrong
        high, low = np.where(down, middle, high), np.where(wrong & ~down, middle, low)
    return low
