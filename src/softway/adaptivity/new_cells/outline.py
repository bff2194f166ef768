"""Boundary of a mesh in the plane, spaced anew."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.adaptivity.new_cells.sizes import rim_sizes
from softway.adaptivity.rezoning.rim import KINK, curve, lengths_along, rims, turns
from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.mesh import Mesh

CLOSE = 0.4
"""Distance of two corners, relative to the length of the sides there, below which the weaker one goes."""
TIE = 1e-6
"""Shift of the numbers of sides away from ties."""
FIXED = 1000
"""Strength of corners that never go; others have their turn in degrees."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Outline:
    """Boundary of a body in the plane.

    Parameters
    ----------
    points
        (k, 2) corners of its closed polygons [m].
    sides
        (s, 2) sides from corner to corner, with the body to the left.
    middles
        (s, 2) places on the boundary between them [m].
    limits
        (k,) lengths of the sides around the corners [m].
    node_tags, side_tags
        Corners (k,) and sides (s,) that are in each tag.
    touching, touching_sides
        (k,) and (s,) those in contact.
    kept, kept_sides
        (k,) and (s,) those that may not move.
    """

    points: Array
    sides: IntArray
    middles: Array
    limits: Array
    node_tags: Mapping[str, BoolArray]
    side_tags: Mapping[str, BoolArray]
    touching: BoolArray
    touching_sides: BoolArray
    kept: BoolArray
    kept_sides: BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Ring:
    """A closed polygon of nodes: numbers (k,), places (k, 2), lengths of sides (k,), and its anchors, ascending."""

    nodes: IntArray
    places: Array
    sizes: Array
    at: IntArray


def outline(mesh: Mesh, places: Array, sizes: Array, closed: BoolArray, kept: BoolArray) -> Outline:
    """Outline of the present shape of a mesh, with new corners between its anchors.

    Anchors are corners of the shape, ends of tags, ends of contacts, and nodes that may not move.  Of two that are
    close the weaker one goes, but for ends of tags.  Between them the boundary is that of
    :func:`softway.adaptivity.rezoning.rim.curve`.

    Parameters
    ----------
    mesh
        The old mesh.
    places, sizes
        (n, 2) places of its nodes, and lengths (n,) of the edges asked for there [m].
    closed, kept
        (n,) nodes in contact, and those that may not move.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((1.0, 1.0), cells=(4, 4))
    >>> none = np.zeros(mesh.n_nodes, dtype=bool)
    >>> found = outline(mesh, mesh.points, np.full(mesh.n_nodes, 0.5), none, none)
    >>> len(found.points), found.points[found.node_tags["top"]].tolist()
    (8, [[1.0, 1.0], [0.5, 1.0], [0.0, 1.0]])
    """
    numbers = rims(mesh)
    lengths = rim_sizes([places[r] for r in numbers], [sizes[r] for r in numbers], KINK)
    rings = [_ring(mesh, r, places[r], size, closed[r], kept[r]) for r, size in zip(numbers, lengths, strict=True)]
    parts, count = [], 0
    for ring in rings:
        parts.append(_spaced(mesh, ring, closed, kept, count))
        count += len(parts[-1].points)
    return _joined(parts, mesh)


def _ring(mesh: Mesh, nodes: IntArray, places: Array, sizes: Array, closed: BoolArray, kept: BoolArray) -> _Ring:
    """A rim with its anchors."""
    turn = np.abs(turns(places))
    strength = np.where(turn > KINK, np.floor(turn + 0.5), 0.0)
    last = closed & ~(np.roll(closed, 1) & np.roll(closed, -1))
    strength = np.where(last, np.maximum(strength, 1.0), strength)
    strength[kept | _ends(mesh, nodes)] = FIXED
    way = np.linalg.norm(places[:, None] - places[None], axis=2)
    found: list[int] = []
    for k in np.lexsort([np.arange(len(nodes)), -strength]).tolist():
        if strength[k] == FIXED or (strength[k] > 0.0 and (way[k, found] > CLOSE * sizes[k]).all()):
            found.append(k)
    return _Ring(nodes=nodes, places=places, sizes=sizes, at=np.array(sorted(found) or [0], dtype=np.int64))


def _ends(mesh: Mesh, nodes: IntArray) -> BoolArray:
    """Nodes (k,) of a rim at which a side in a tag meets one that is not, and single nodes in a tag."""
    found = np.zeros(len(nodes), dtype=bool)
    for tagged in mesh.tags.values():
        inside = np.isin(nodes, tagged)
        side = inside & np.roll(inside, -1)
        before = np.roll(side, 1)
        found |= (side != before) | (inside & ~side & ~before)
    return found


def _spaced(mesh: Mesh, ring: _Ring, closed: BoolArray, kept: BoolArray, first: int) -> Outline:
    """The outline of one rim, whose corners have numbers from ``first`` on."""
    count, few = len(ring.nodes), {1: 3, 2: 2}.get(len(ring.at), 1)
    points: list[Array] = []
    middles: list[Array] = []
    flags: list[tuple[bool, bool]] = []
    sides_of: list[IntArray] = []
    starts: list[int] = []
    for k, start in enumerate(ring.at.tolist()):
        end = int(ring.at[(k + 1) % len(ring.at)]) + (count if k + 1 == len(ring.at) else 0)
        local = np.arange(start, end + 1) % count
        nodes, x, size = ring.nodes[local], ring.places[local], ring.sizes[local]
        bound = bool(kept[nodes].all()) and len(local) == 2
        shares = _shares(x, size, 1 if bound else few)
        found = curve(x, shares, bool(closed[nodes].all()))
        starts.append(len(sides_of))
        points.append(found[0:-1:2])
        middles.append(found[1::2])
        flags += [(bool(closed[nodes].all()), bound)] * len(middles[-1])
        sides_of += [nodes] * len(middles[-1])
    corner, total = np.concatenate(points), len(sides_of)
    at, (flat, bound_sides) = ring.nodes[ring.at], np.array(flags, dtype=bool).T
    touching = flat & np.roll(flat, 1) | flat | np.roll(flat, 1)
    touching[starts], stays = closed[at], np.zeros(total, dtype=bool)
    stays[starts] = kept[at]
    node_tags, side_tags = _tagged(mesh, sides_of, at, starts)
    length = np.linalg.norm(np.roll(corner, -1, axis=0) - corner, axis=1)
    number = first + np.arange(total)
    return Outline(
        points=corner,
        sides=np.stack([number, np.roll(number, -1)], axis=1),
        middles=np.concatenate(middles),
        limits=0.5 * (length + np.roll(length, 1)),
        node_tags=node_tags,
        side_tags=side_tags,
        touching=touching,
        touching_sides=flat,
        kept=stays,
        kept_sides=bound_sides,
    )


def _tagged(
    mesh: Mesh, sides_of: list[IntArray], at: IntArray, starts: list[int]
) -> tuple[dict[str, BoolArray], dict[str, BoolArray]]:
    """Corners and sides in each tag: sides whose part of the old boundary is, their ends, and anchors that are."""
    sides = {t: np.array([bool(np.isin(n, nodes).all()) for n in sides_of]) for t, nodes in mesh.tags.items()}
    corners = {t: side | np.roll(side, 1) for t, side in sides.items()}
    for t, nodes in mesh.tags.items():
        corners[t][starts] |= np.isin(at, nodes)
    return corners, sides


def _shares(points: Array, sizes: Array, few: int) -> Array:
    """Shares (2m + 1,) of the length of a polygon at which its m new sides, and their middles, are."""
    along = lengths_along(points)
    number = np.concatenate([[0.0], np.cumsum(0.5 * (1.0 / sizes[1:] + 1.0 / sizes[:-1]) * np.diff(along))])
    count = max(few, int(np.floor(number[-1] + 0.5 - TIE)))
    found = np.interp(np.linspace(0.0, number[-1], 2 * count + 1), number, along)
    return np.asarray(found / along[-1])


def _joined(parts: list[Outline], mesh: Mesh) -> Outline:
    """Outlines of several rims as one."""

    def all_of(name: str) -> Array:
        return np.concatenate([getattr(part, name) for part in parts])

    return Outline(
        points=all_of("points"),
        sides=all_of("sides").astype(np.int64),
        middles=all_of("middles"),
        limits=all_of("limits"),
        node_tags={t: np.concatenate([p.node_tags[t] for p in parts]) for t in mesh.tags},
        side_tags={t: np.concatenate([p.side_tags[t] for p in parts]) for t in mesh.tags},
        touching=all_of("touching").astype(bool),
        touching_sides=all_of("touching_sides").astype(bool),
        kept=all_of("kept").astype(bool),
        kept_sides=all_of("kept_sides").astype(bool),
    )
