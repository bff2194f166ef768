"""Materials of a body as zones of its mesh, and their common boundaries, which have nodes of their own as the surface
has (docs/theory/bodies/remeshing.md#several-materials).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.adaptivity.rezoning.rim import KINK, curve, lengths_along, turns
from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh, outer_facets

Blocks = Mapping[str, IntArray]
"""Cell name -> (e, a) node numbers."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Zones:
    """Zones of a mesh of n nodes, each with the cells of one material, and their common boundaries.

    Parameters
    ----------
    blocks
        Cells of each zone, with the node numbers of the mesh.
    common
        Facets of each common boundary of two zones, facing out of the first of them.
    nodes
        (k,) nodes of all common boundaries.
    joints
        (n,) nodes in which common boundaries end: on the surface, and where more than two zones meet.
    """

    blocks: tuple[Blocks, ...]
    common: tuple[Blocks, ...]
    nodes: IntArray
    joints: BoolArray


def zones_of(mesh: Mesh, owner: IntArray | None) -> Zones:
    """Zones of a mesh whose cells have the materials ``owner`` (e,); one zone for None.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> found = zones_of(rectangle((1.0, 1.0), cells=(2, 2)), np.array([0, 0, 1, 1]))
    >>> found.nodes.tolist(), np.flatnonzero(found.joints).tolist()
    ([3, 4, 5], [3, 5])
    """
    numbers = np.zeros(mesh.n_cells, dtype=np.int64) if owner is None else owner
    blocks = tuple(chosen(mesh.blocks, numbers == k) for k in np.unique(numbers).tolist())
    common = _common(blocks)
    count = np.zeros(mesh.n_nodes, dtype=np.int64)
    nodes = np.zeros(mesh.n_nodes, dtype=bool)
    for sheet in common:
        for facet, rows in sheet.items():
            np.add.at(count, rows[:, : CELLS[facet].corners], 1)
            nodes[rows] = True
    joints = (count > 0) & (np.isin(np.arange(mesh.n_nodes), mesh.nodes("surface")) | (count != 2))
    return Zones(blocks=blocks, common=common, nodes=np.flatnonzero(nodes), joints=joints)


def chosen(blocks: Blocks, cells: BoolArray) -> dict[str, IntArray]:
    """Blocks with the chosen ones of all cells (e,) in their order.

    Examples
    --------
    >>> chosen({"bar2": np.array([[0, 1], [1, 2]])}, np.array([False, True]))["bar2"].tolist()
    [[1, 2]]
    """
    found, start = {}, 0
    for name, rows in blocks.items():
        mine = rows[cells[start : start + len(rows)]]
        start += len(rows)
        if len(mine):
            found[name] = mine
    return found


def _common(zones: Sequence[Blocks]) -> tuple[Blocks, ...]:
    """Facets that the boundaries of two zones have in common, for each pair of zones."""
    open_facets: dict[tuple[int, ...], tuple[int, IntArray]] = {}
    found: dict[tuple[int, int], dict[str, list[IntArray]]] = {}
    for number, blocks in enumerate(zones if len(zones) > 1 else ()):
        for name, facets in outer_facets(blocks).items():
            keys = np.sort(facets[:, : CELLS[name].corners], axis=1).tolist()
            for key, facet in zip(map(tuple, keys), facets, strict=True):
                if key in open_facets:
                    first, facing = open_facets.pop(key)
                    found.setdefault((first, number), {}).setdefault(name, []).append(facing)
                else:
                    open_facets[key] = number, facet
    return tuple({name: np.array(rows) for name, rows in found[pair].items()} for pair in sorted(found))


def lines(zones: Zones) -> list[IntArray]:
    """Common boundaries in the plane as lines of nodes (k,) from joint to joint, middles of edges between their ends;
    the first node of a closed line is the last one, too.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((1.0, 1.0), cells=(3, 3))
    >>> [line.tolist() for line in lines(zones_of(mesh, (np.arange(9) == 4).astype(int)))]
    [[5, 9, 10, 6, 5]]
    """
    found = []
    for sheet in zones.common:
        following: dict[int, list[tuple[int, ...]]] = {}
        for facets in sheet.values():
            for first, last, *between in facets.tolist():
                following.setdefault(first, []).append((last, *between))
        starts = [node for node in sorted(following) if zones.joints[node] for _ in following[node]]
        while following:
            start = node = starts.pop(0) if starts else min(following)
            line = [start]
            while True:
                last, *between = following[node].pop()
                if not following[node]:
                    del following[node]
                line += [*between, last]
                node = last
                if zones.joints[node] or node == start:
                    break
            found.append(np.array(line))
    return found


def along(base: Array, line: IntArray, places: Array) -> Array:
    """Places (k, 2) of the nodes of a line, between its ends and kinks with the spacing of the base mesh.

    Between them the line is the cubic spline through its nodes, by the length of its chords.

    Parameters
    ----------
    base, places
        (n, 2) places of all nodes in the base mesh, and the present ones [m].
    line
        (k,) nodes of the line.

    Examples
    --------
    >>> base, places = (np.stack([x, 0.0 * x], axis=1) for x in (np.array([0.0, 1.0, 2.0]), np.array([0.0, 0.5, 2.0])))
    >>> along(base, np.array([0, 1, 2]), places).tolist()
    [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]
    """
    kinks = np.maximum(*(np.abs(turns(points[line])) for points in (base, places))) > KINK
    kinks[[0, -1]] = True
    at, out = np.flatnonzero(kinks).tolist(), np.array(places[line])
    for start, end in zip(at[:-1], at[1:], strict=True):
        nodes = line[start : end + 1]
        share = lengths_along(base[nodes])
        out[start : end + 1] = curve(places[nodes], share / share[-1], False)
    return out
