"""Surface of a solid that may come into contact, with its sharp corners and edges."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.contact.surfaces.boundary import ContactSurface, Edges, outward
from softway.errors import InputError, within

SAME = 1e-9
"""Difference of mean edges, relative to them, up to which two surfaces are equally fine."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodySurface:
    """Surface of a solid in the node numbers of the model.

    Parameters
    ----------
    side
        Its boundary facets.
    corners, edges
        Sharp corners (c,) and, in space, sharp edges at the reference positions.
    edge
        Mean length of its edges [m].
    """

    side: ContactSurface
    corners: IntArray
    edges: Edges | None
    edge: float


def body_surface(
    parts: Sequence[DiscreteSolid],
    name: str,
    tag: str,
    points: Array,
    sealed: Mapping[str, IntArray] | None = None,
) -> BodySurface:
    """Boundary facets of a tag of a solid, without those that ties cover, ``sealed``: cell name -> (f, b) nodes of the
    model; ``points`` (n, d) are the reference positions of the model.

    Raises
    ------
    InputError
        If there is no such solid, or the tag contains no whole facet.
    """
    part = parts[part_named(parts, name, "between")]
    with within("between"):
        facets = part.mesh.facets_on(tag)
        if not facets:
            raise InputError("", f"tag {tag!r} of {name!r} contains no whole facet", "a tag that covers a surface")
        facets = {kind: f[~covered(f + part.nodes.start, kind, sealed)] for kind, f in facets.items()}
        if not sum(len(f) for f in facets.values()):
            raise InputError("", f"ties cover all facets of {name!r} on {tag!r}", "a tag of its free surface")
    first = part.nodes.start
    dim = points.shape[1]
    bars = np.concatenate([c[:, :2] for c in part.mesh.blocks.values()])
    ends = outward(bars, facets["point1"]) if "point1" in facets else np.zeros(0)
    side = ContactSurface(facets={name: f + first for name, f in facets.items()}, ends=ends)
    if dim == 1:
        return BodySurface(side=side, corners=np.zeros(0, int), edges=None, edge=part.mesh.edge())
    lengths = np.linalg.norm(points[side.table[:, 1]] - points[side.table[:, 0]], axis=1)
    edges = side.sharp_edges(points) if dim == 3 else None
    corners = side.sharp_corners(points) if edges is None else side.nodes_on(edges)
    return BodySurface(side=side, corners=corners, edges=edges, edge=float(lengths.mean()))


def finer_first(one: BodySurface, two: BodySurface) -> tuple[BodySurface, BodySurface]:
    """The finer surface, then the other one; of equally fine ones the first, however their edges are rounded."""
    return (two, one) if two.edge < (1.0 - SAME) * one.edge else (one, two)


def covered(facets: IntArray, kind: str, sealed: Mapping[str, IntArray] | None) -> BoolArray:
    """True for facets (f, b) of a kind that are among the ``sealed`` ones."""
    others = facets[:0] if sealed is None else sealed.get(kind, facets[:0])
    number = np.unique(np.sort(np.concatenate([facets, others]), axis=1), axis=0, return_inverse=True)[1].ravel()
    return np.isin(number[: len(facets)], number[len(facets) :])


def part_named(parts: Sequence[DiscreteSolid], name: str, where: str) -> int:
    """Number of the solid with a name."""
    for number, part in enumerate(parts):
        if part.name == name:
            return number
    raise InputError(where, f"no solid '{name}'", f"one of {[p.name for p in parts]}")
