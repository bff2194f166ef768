"""Nodes on the boundary of a mesh in the plane, slid along it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.mesh import Mesh

KINK = 30.0
"""Turn of the boundary at a node above which the node is a corner [degrees]."""

ENDS = 1e-6
"""Part of a side at its ends where it does not count as crossing others: neighbours meet there."""


def rims(mesh: Mesh) -> list[IntArray]:
    """Closed polygons (k,) of the boundary nodes of a mesh in the plane, with the cells to the left, middles of edges
    between their ends.

    Raises
    ------
    InputError
        If cells meet in a node of the boundary alone.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> [rim.tolist() for rim in rims(rectangle((1.0, 1.0), cells=(1, 1)))]
    [[0, 1, 3, 2]]
    """
    following: dict[int, tuple[int, ...]] = {}
    for facets in mesh.boundary().values():
        for first, last, *between in facets.tolist():
            if first in following:
                place = mesh.points[first].tolist()
                raise InputError("mesh", f"cells that meet at the boundary node {place} m alone", "a mesh without")
            following[first] = (last, *between)
    found = []
    while following:
        node = start = min(following)
        ring = []
        while True:
            last, *between = following.pop(node)
            ring += [node, *between]
            node = last
            if node == start:
                break
        found.append(np.array(ring))
    return found


def crossing(polygons: Sequence[Array]) -> Array | None:
    """Place (2,) where sides of closed polygons (k, 2) cross, the first one in their order; None if none do.

    Examples
    --------
    >>> crossing([np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0]])]).tolist()
    [1.0, 1.0]
    >>> crossing([np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])])
    """
    start = np.concatenate(polygons)
    along = np.concatenate([np.roll(one, -1, axis=0) for one in polygons]) - start
    cross = along[:, None, 0] * along[None, :, 1] - along[:, None, 1] * along[None, :, 0]
    way = start[None] - start[:, None]
    level = np.where(cross == 0.0, np.inf, cross)
    share = (way[..., 0] * along[None, :, 1] - way[..., 1] * along[None, :, 0]) / level
    other = (way[..., 0] * along[:, None, 1] - way[..., 1] * along[:, None, 0]) / level
    inner = (np.minimum(share, other) > ENDS) & (np.maximum(share, other) < 1.0 - ENDS)
    found = np.argwhere((cross != 0.0) & inner)
    return None if not len(found) else np.asarray(start[found[0, 0]] + share[tuple(found[0])] * along[found[0, 0]])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Anchors:
    """Nodes of a rim at fixed places, and the nodes where these places are.

    Parameters
    ----------
    at
        (k,) positions in the rim, ascending.
    target
        (k,) positions in the rim whose places the nodes get; not less than ``at[0]``, ascending, beyond the end of the
        rim after a whole turn.
    """

    at: IntArray
    target: IntArray


def turns(points: Array) -> Array:
    """Turn (k,) of a closed polygon (k, 2) at its corners [degrees]."""
    ahead = np.roll(points, -1, axis=0) - points
    angle = np.arctan2(ahead[:, 1], ahead[:, 0])
    return np.degrees((angle - np.roll(angle, 1) + np.pi) % (2.0 * np.pi) - np.pi)


def ends(mesh: Mesh, rim: IntArray, tags: Sequence[str]) -> BoolArray:
    """Nodes (k,) of a rim at which a side in a tag follows one that is not, or is followed by one."""
    found = np.zeros(len(rim), dtype=bool)
    for tag in tags:
        inside = np.isin(rim, mesh.nodes(tag))
        side = inside & np.roll(inside, -1)
        found |= side != np.roll(side, 1)
    return found


def anchors(
    base: Mesh,
    rim: IntArray,
    places: Array,
    closed: BoolArray,
    tags: Sequence[str] = (),
    joints: BoolArray | None = None,
) -> Anchors:
    """Anchors of a rim: corners now and in the base mesh, ends of tags, ends of the parts in contact, and joints.

    Where a corner of the base mesh has become smooth, and sides beyond it are in contact, the boundary has folded onto
    the body that it touches: the node moves to the end of the contact.

    Parameters
    ----------
    base
        Base mesh, with its tags.
    rim
        (k,) nodes of the rim.
    places
        (n, 2) places of all nodes [m].
    closed
        (n,) nodes in contact.
    tags
        Tags whose ends stay.
    joints
        (n,) nodes at which materials meet; none by default.
    """
    count = len(rim)
    first, kinks = (np.abs(turns(points[rim])) > KINK for points in (base.points, places))
    stay, touching = ends(base, rim, tags), closed[rim]
    stay = stay if joints is None else stay | joints[rim]
    last = touching & ~(np.roll(touching, 1) & np.roll(touching, -1))
    fixed, target = kinks | first | stay | last, np.arange(count)
    for k in np.flatnonzero(first & ~kinks & touching).tolist():
        for way in (1, -1):
            passed = _folded(k, way, touching, first | stay)
            if passed:
                target[k] = k + way * passed
                fixed[(k + way * np.arange(1, passed + 1)) % count] = False
                break
    at = np.flatnonzero(fixed)
    return Anchors(at=at, target=target[at]) if len(at) else Anchors(at=np.array([0]), target=np.array([0]))


def _folded(start: int, way: int, touching: BoolArray, others: BoolArray) -> int:
    """Number of sides in contact from a node to the end of the contact; zero if another corner is before it."""
    count = len(touching)
    for k in range(1, count):
        node = (start + way * k) % count
        if not touching[node]:
            return k - 1
        if others[node]:
            return 0
    return 0


def slid(base: Array, rim: IntArray, places: Array, held: Anchors, closed: BoolArray) -> tuple[Array, BoolArray]:
    """Places (k, 2) of the nodes of a rim, between its anchors with the spacing of the base mesh, and those (k,) of
    them that are in contact there.

    Between anchors the boundary is the cubic spline through its nodes, by the length of its chords, or their polygon
    where all of them are in contact.

    Parameters
    ----------
    base, places
        (n, 2) places of all nodes in the base mesh, and the present ones [m].
    rim
        (k,) nodes of the rim.
    held
        Its anchors.
    closed
        (n,) nodes in contact.
    """
    count = len(rim)
    out, touching = np.array(places[rim]), np.zeros(len(rim), dtype=bool)
    for k, start in enumerate(held.at.tolist()):
        following = (k + 1) % len(held.at)
        end = int(held.at[following]) + (count if following <= k else 0)
        first, last = int(held.target[k]), int(held.target[following]) + (count if following <= k else 0)
        new, old = rim[np.arange(start, end + 1) % count], rim[np.arange(first, last + 1) % count]
        share = lengths_along(base[new])
        flat = bool(closed[old].all())
        out[np.arange(start, end + 1) % count] = curve(places[old], share / share[-1], flat)
        touching[np.arange(start, end + 1) % count] |= flat
        touching[[start % count, end % count]] |= closed[old[[0, -1]]]
    return out, touching


def lengths_along(points: Array) -> Array:
    """Length (k,) of a polygon (k, 2) up to each corner."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def curve(points: Array, shares: Sequence[float] | Array, straight: bool) -> Array:
    """Places (m, 2) at shares (m,) of the length of a curve through points (k, 2)."""
    lengths = lengths_along(points)
    at = np.asarray(shares) * lengths[-1]
    if straight or len(points) < 4:
        found = np.stack([np.interp(at, lengths, values) for values in points.T], axis=1)
    else:
        from scipy.interpolate import CubicSpline  # slow to load

        found = CubicSpline(lengths, points)(at)
    same = (points == points[0]).all(axis=0)
    found[:, same] = points[0, same]
    found[0], found[-1] = points[0], points[-1]
    return np.asarray(found)
