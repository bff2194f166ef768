"""Overlap of deformable bodies with rigid tools, at nodes and between them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.meshes.cells import CELLS
from softway.meshes.element import tabulate
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.triangulated import Facets, Surface
from softway.record.audit.geometry.lattice import lattice
from softway.record.audit.geometry.solids import Solids, boxes

DIVISIONS = (4, 16)
"""Numbers of intervals along the side of a facet between which its overlap with a tool is looked at: in all facets near
the tool, then in the deepest one."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sunk:
    """Deepest place of a body in a tool.

    Parameters
    ----------
    body
        Number of the body.
    node
        The node itself, or the node of the facet that is nearest to the place.
    at_node
        True if the place is a node.
    place
        (d,) place [m].
    depth
        Depth [m].
    """

    body: int
    node: int
    at_node: bool
    place: Array
    depth: float


def behind(solids: Solids, shape: PlacedShape) -> BoolArray:
    """Nodes (n,) that lie behind an open surface at rest; they are not in it. None lie behind other shapes."""
    return _gaps(shape, solids.reference) < 0.0 if _open(shape) else np.zeros(len(solids.reference), dtype=bool)


def sunk(solids: Solids, x: Array, shape: PlacedShape, ignored: BoolArray) -> Iterator[Sunk]:
    """Deepest node of each body in a tool, and its deepest place between nodes.

    Parameters
    ----------
    solids
        Bodies.
    x
        (n, d) positions of their nodes [m].
    shape
        Tool in its present pose.
    ignored
        (n,) nodes that are not looked at, from :func:`behind`.
    """
    low, high = boxes(x, solids.owner, len(solids.names))
    reach = _gaps(shape, 0.5 * (low + high)) <= 0.5 * np.linalg.norm(high - low, axis=1)
    nodes = solids.surface[reach[solids.owner[solids.surface]] & ~ignored[solids.surface]]
    if not len(nodes):
        return
    gap = np.full(len(x), np.inf)
    gap[nodes] = _gaps(shape, x[nodes])
    yield from _deepest(solids, nodes, x[nodes], gap[nodes], at_node=True)
    for name, facets in solids.facets.items():
        if CELLS[name].dim > 0 and not (isinstance(shape.shape, HalfSpace) and CELLS[name].order == 1):
            yield from _between(solids, x, shape, name, facets[np.isfinite(gap[facets]).all(axis=1)], gap)


def _between(solids: Solids, x: Array, shape: PlacedShape, name: str, facets: IntArray, gap: Array) -> Iterator[Sunk]:
    """Deepest places in the facets that are near the tool: a distance changes by no more than the way."""
    size = np.linalg.norm(np.ptp(x[facets], axis=1), axis=1)
    facets = facets[gap[facets].min(axis=1) < size]
    if not len(facets):
        return
    _, _, gaps = _sampled(x, shape, name, facets, DIVISIONS[0])
    owner = solids.owner[facets[:, 0]]
    least = gaps.min(axis=1)
    for body in np.unique(owner[least < 0.0]):
        mine = np.flatnonzero(owner == body)
        deepest = facets[mine[np.argmin(least[mine])]]
        nearest, places, gaps = _sampled(x, shape, name, deepest[None], DIVISIONS[1])
        yield from _deepest(solids, nearest[0], places[0], gaps[0], at_node=False)


def _sampled(
    x: Array, shape: PlacedShape, name: str, facets: IntArray, divisions: int
) -> tuple[IntArray, Array, Array]:
    """Nearest nodes (f, p), places (f, p, d) and gaps (f, p) [m] of the points of a lattice in facets (f, b)."""
    shares, _ = tabulate(name, lattice(name, divisions))
    places = np.einsum("pb,fbd->fpd", shares, x[facets])
    return facets[:, shares.argmax(axis=1)], places, _gaps(shape, places)


def _deepest(solids: Solids, nodes: IntArray, places: Array, gap: Array, *, at_node: bool) -> Iterator[Sunk]:
    owner = solids.owner[nodes]
    for body in np.unique(owner[gap < 0.0]):
        mine = np.flatnonzero(owner == body)
        k = mine[np.argmin(gap[mine])]
        yield Sunk(body=int(body), node=int(nodes[k]), at_node=at_node, place=places[k], depth=-float(gap[k]))


def _gaps(shape: PlacedShape, x: Array) -> Array:
    """Gaps (...,) of points (..., d) [m]."""
    return np.asarray(shape.gap(x.reshape(-1, x.shape[-1])).reshape(x.shape[:-1]))


def _open(shape: PlacedShape) -> bool:
    """True for a surface of facets with a rim."""
    found = shape.shape.facets if isinstance(shape.shape, Surface) else shape.shape
    return isinstance(found, Facets) and not found.closed
