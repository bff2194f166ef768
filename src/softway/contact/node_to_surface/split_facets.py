"""Facets as triangles: surfaces of flat facets that meet at straight edges.

A bilinear facet is warped: two of them may cross each other between nodes and edges.  Flat facets cannot, as long as no
node is behind a facet and no edge behind another one.  The triangles have the nodes of a facet for corners and, where a
quadrilateral has no node there, its centre, a point of the facet; rows on a centre act on the nodes of the facet.

Nodes touch the triangles of linear facets.  Quadratic facets are smoother than their triangles, so nodes touch them as
they are; their triangles only have edges that touch other edges.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol, TypeVar

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.stencils import Stencils
from softway.contact.surfaces.boundary import ContactSurface
from softway.meshes.cells import CELLS, FLAT

Value = TypeVar("Value", bound=np.generic)

CENTRES: Mapping[str, tuple[float, ...]] = {"quad4": (0.25,) * 4, "quad8": (-0.25,) * 4 + (0.5,) * 4}
"""Shape functions at the centre of facets without a node there."""
PIECES: Mapping[str, tuple[tuple[int, ...], ...]] = {
    "tri3": FLAT["tri3"],
    "quad4": ((0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "tri6": FLAT["tri6"],
    "quad8": FLAT["quad9"],
    "quad9": FLAT["quad9"],
}
"""Triangles of each kind of facet; the number after that of its nodes is its centre.  Linear kinds come first."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SplitSurface:
    """Surface of triangles on the ``count`` nodes of a model and the centres of its facets.

    Parameters
    ----------
    given
        The surface, of facets in space.
    count
        Number n of the nodes of the model; centre k has the number n + k.
    side
        Facets for nodes: the triangles of linear facets, and the quadratic facets as they are.
    flat
        The triangles, kind by kind in the order of ``PIECES``.
    whole
        (w, b) nodes and centres of each facet of ``side``; shorter rows repeat their last node.
    means
        (n + q, n) weights of the nodes in nodes and centres.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]])
    >>> split = SplitSurface(given=ContactSurface(facets={"quad4": np.array([[0, 1, 2, 3]])}), count=4)
    >>> split.positions(x)[4:].tolist(), split.side.facets["tri3"].tolist()
    ([[1.0, 1.0, 0.0]], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    """

    given: ContactSurface
    count: int
    side: ContactSurface = field(init=False)
    flat: ContactSurface = field(init=False)
    whole: IntArray = field(init=False)
    means: sp.csr_array = field(init=False)

    def __post_init__(self) -> None:
        full = self._full()
        pieces = {kind: f[:, np.array(PIECES[kind])].reshape(-1, 3) for kind, f in full.items()}
        linear = [pieces[kind] for kind in full if not _curved(kind)]
        curved = {kind: f for kind, f in full.items() if _curved(kind)}
        side = {"tri3": np.concatenate(linear)} if linear else {}
        groups = [*linear, *curved.values()]
        width = max(g.shape[1] for g in groups)
        found = {
            "side": ContactSurface(facets={**side, **{kind: self.given.facets[kind] for kind in curved}}),
            "flat": ContactSurface(facets={"tri3": np.concatenate(list(pieces.values()))}),
            "whole": np.concatenate([g[:, np.minimum(np.arange(width), g.shape[1] - 1)] for g in groups]),
            "means": self._means(),
        }
        for name, value in found.items():
            object.__setattr__(self, name, value)

    @property
    def centred(self) -> dict[str, IntArray]:
        """Kind -> nodes (k, b) of the facets with a centre, in the order of the centres."""
        return {kind: self.given.facets[kind] for kind in CENTRES if kind in self.given.facets}

    def positions(self, x: Array) -> Array:
        """Positions (n + q, 3) of the nodes, at x (n, 3), and of the centres."""
        found = [x]
        for kind, f in self.centred.items():
            found.append(np.sum([w * x[nodes] for w, nodes in zip(CENTRES[kind], f.T, strict=True)], axis=0))
        return np.concatenate(found)

    def with_centres(self, values: NDArray[Value], of: Callable[[NDArray[Value]], NDArray[Value]]) -> NDArray[Value]:
        """Values (n + q, ...) of nodes and centres: those of the nodes (n, ...), and ``of`` those (k, b, ...) of the
        nodes of each facet.
        """
        return np.concatenate([values, *(of(values[f]) for f in self.centred.values())])

    def with_alone(self, pattern: sp.csr_array) -> sp.csr_array:
        """Pattern (n + q, n + q) of nodes and centres from that of the nodes (n, n): a centre goes with itself."""
        alone = sp.eye_array(self.means.shape[0] - self.count, dtype=pattern.dtype)
        return sp.csr_array(sp.block_diag((pattern, alone), format="csr"))

    def of_facets(self, values: BoolArray) -> BoolArray:
        """Values (s, k) of the facets for nodes from those of the given facets (f, k)."""
        return self._repeated(values, {kind: 1 if _curved(kind) else len(p) for kind, p in PIECES.items()})

    def of_triangles(self, values: BoolArray) -> BoolArray:
        """Values (t, k) of the triangles from those of the given facets (f, k)."""
        return self._repeated(values, {kind: len(p) for kind, p in PIECES.items()})

    def joined(self, stencils: Stencils) -> Stencils:
        """Stencils on the nodes (n,) from those on nodes and centres (n + q,)."""
        weights = sp.csr_array(stencils.weights @ self.means)
        return Stencils(gap=stencils.gap, normal=stencils.normal, weights=weights)

    def _repeated(self, values: BoolArray, times: Mapping[str, int]) -> BoolArray:
        """Values (f, k) of the given facets, kind by kind in the order of ``PIECES``, each ``times`` repeated."""
        kinds = {kind: values[first : first + len(f)] for kind, first, f in self.given.numbers}
        return np.concatenate([np.repeat(kinds[kind], times[kind], axis=0) for kind in PIECES if kind in kinds])

    def _full(self) -> dict[str, IntArray]:
        """Kind -> nodes (f, b) of the facets and their centres."""
        start, centre, given = self.count, {}, self.given.facets
        for kind, f in self.centred.items():
            centre[kind] = start + np.arange(len(f))[:, None]
            start += len(f)
        return {k: np.concatenate([given[k], centre.get(k, given[k][:, :0])], axis=1) for k in PIECES if k in given}

    def _means(self) -> sp.csr_array:
        """Weights (n + q, n) of the nodes in nodes and centres."""
        parts = [sp.eye_array(self.count, format="csr")]
        for kind, f in self.centred.items():
            entries = np.tile(CENTRES[kind], len(f)), f.ravel(), f.shape[1] * np.arange(len(f) + 1)
            parts.append(sp.csr_array(entries, shape=(len(f), self.count)))
        means = sp.csr_array(sp.vstack(parts, format="csr"))
        means.sort_indices()
        return means


def first_corner(nodes: IntArray) -> IntArray:
    """Values (k,) at the first corners, from those (k, c) at all of them."""
    return nodes[:, 0]


def _curved(kind: str) -> bool:
    return CELLS[kind].order > 1


class Rows(Protocol):
    """Rows on nodes and centres in a slab."""

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        ...

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions of nodes and centres."""
        ...


class Method(Protocol):
    """Contact method on nodes and centres."""

    @property
    def node(self) -> IntArray:
        """Node (m,) of each row."""
        ...

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> Rows:
        """Pairs that may touch in a slab."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OnSplitSurface:
    """A contact ``method`` on the triangles of a surface."""

    method: Method
    surface: SplitSurface

    @property
    def node(self) -> IntArray:
        """Node (m,) of each row; the first corner for a centre."""
        node, surface = self.method.node, self.surface
        return np.asarray(surface.with_centres(np.arange(surface.count), first_corner)[node])

    def meet(self, x0: Array, x1: Array, reach: float, margin: float | None = None) -> "SplitContact":
        """Pairs that may touch in a slab from positions x0 to about x1 (n, 3), within ``reach`` [m].

        With a ``margin`` [m], only rows with an opponent within the margin have pairs.
        """
        surface = self.surface
        found = self.method.meet(surface.positions(x0), surface.positions(x1), reach, margin)
        return SplitContact(contact=found, surface=surface)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SplitContact:
    """``contact`` on the triangles of a surface in a slab."""

    contact: Rows
    surface: SplitSurface

    @property
    def found(self) -> int:
        """Number of pairs found by the search."""
        return self.contact.found

    def at(self, x: Array) -> Stencils:
        """Gaps and their derivatives at positions x (n, 3)."""
        return self.surface.joined(self.contact.at(self.surface.positions(x)))
