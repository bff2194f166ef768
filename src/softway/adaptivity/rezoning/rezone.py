"""New places of the nodes of a degraded mesh, with the same cells."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from softway.adaptivity.rezoning.flat_surface import sliding
from softway.adaptivity.rezoning.rim import anchors, rims, slid
from softway.adaptivity.rezoning.smoothing import distortion, ideal_places, moved, slid_along
from softway.adaptivity.rezoning.volume import Sheet, volume_of, with_volume, with_volumes
from softway.adaptivity.rezoning.zones import Zones, along, lines, zones_of
from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.meshes.cells import CELLS, linear
from softway.meshes.element import tabulate
from softway.meshes.mesh import Mesh, outer_facets

OnTools = Callable[[Array, BoolArray], tuple[Array, BoolArray]]
"""Places (n, d) of the nodes of a solid with those in tools, and those (n,) in contact, on the tools, and out of other
solids, which have pushed some nodes (n,).
"""


def rezoned(
    part: DiscreteSolid,
    base: Mesh,
    places: Array,
    closed: BoolArray,
    kept: BoolArray,
    on_tools: OnTools,
    tags: Sequence[str] = (),
) -> Array | None:
    """New places (n, d) of the nodes of a solid; None if no cells fit into its shape.

    In the plane nodes of the boundary slide on it, between its corners and the ends of supports and contacts, with the
    spacing of the base mesh.  In space those on flat parts slide in their planes and along straight edges, and the
    others stay, so that the shape does.  Common boundaries of two materials are treated alike, and each material keeps
    its volume.  Nodes inside have the places of least distortion from the base mesh in the
    affine motion nearest to the present one.  Free nodes of the boundary move along their normals, so that the volume
    stays.

    Parameters
    ----------
    part
        The solid.
    base
        Its base mesh, with the same cells.
    places
        (n, d) present places of its nodes [m].
    closed, kept
        (n,) nodes in contact, and nodes of the boundary that may not move.
    on_tools
        Contact with tools.
    tags
        Tags whose ends stay: those of supports.
    """
    mesh, zones = part.mesh, zones_of(part.mesh, part.materials.owner)
    boundary = np.union1d(mesh.nodes("surface"), zones.nodes)
    new = np.array(places)
    if mesh.dim == 2:
        new = _on_curves(part, base, zones, places, (closed, kept), on_tools, tags)
    bent = distortion(mesh.blocks, ideal_places(base.points, places))
    found = moved(bent, places, boundary, new[boundary])
    if found is None or mesh.dim == 2:
        return None if found is None else between(mesh.blocks, found, boundary)
    nodes, ways = sliding(mesh, found, kept, zones.common)
    inside = np.setdiff1d(np.unique(bent.simplices), boundary)
    found = slid_along(bent, found, inside, nodes, ways)
    return between(mesh.blocks, found, np.setdiff1d(boundary, middles(mesh.blocks, nodes)))


def _on_curves(
    part: DiscreteSolid,
    base: Mesh,
    zones: Zones,
    places: Array,
    touching: tuple[BoolArray, BoolArray],
    on_tools: OnTools,
    tags: Sequence[str],
) -> Array:
    """Places (n, 2) of the nodes of a solid in the plane, those of its boundary and of the common boundaries of its
    materials along these, with the volume of each material; the others stay.
    """
    mesh, section, (closed, kept) = part.mesh, part.internal.section, touching
    new, closed = np.array(places), np.array(closed)
    for rim in rims(mesh):
        held = anchors(base, rim, places, closed, tags, zones.joints)
        new[rim], closed[rim] = slid(base.points, rim, places, held, closed)
    new[kept] = places[kept]
    new, pushed = on_tools(new, closed)
    there = np.where(zones.joints[:, None], new, places)
    for line in lines(zones):
        new[line] = along(base.points, line, there)
    outer = np.isin(np.arange(len(places)), mesh.nodes("surface")) & ~closed & ~kept & ~pushed
    free = part.dofs.free & (outer & ~zones.joints)[:, None]
    if len(zones.blocks) == 1:
        wanted = volume_of(mesh.blocks, section, places)
        return with_volume(mesh.blocks, mesh.boundary(), section, new, wanted, free)
    inner = np.isin(np.arange(len(places)), zones.nodes) & ~zones.joints
    sheets: list[Sheet] = [(outer_facets(blocks), free) for blocks in zones.blocks]
    sheets += [(common, part.dofs.free & inner[:, None]) for common in zones.common]
    volumes = np.array([volume_of(blocks, section, places) for blocks in zones.blocks])
    return with_volumes(zones.blocks, sheets, section, new, volumes)


def middles(blocks: Mapping[str, IntArray], nodes: IntArray) -> IntArray:
    """Nodes (m,) in the middles of edges that end in one of the ``nodes`` (k,).

    Examples
    --------
    >>> middles({"tri6": np.array([[0, 1, 2, 3, 4, 5]])}, np.array([1])).tolist()
    [3, 4]
    """
    found = [np.zeros(0, dtype=np.int64)]
    for cell, cells in blocks.items():
        it = CELLS[cell]
        if it.order > 1:
            ends = np.isin(cells[:, np.array(it.edges)], nodes).any(axis=2)
            found.append(cells[:, it.corners : it.corners + len(it.edges)][ends])
    return np.unique(np.concatenate(found))


def between(blocks: Mapping[str, IntArray], places: Array, fixed: IntArray) -> Array:
    """Places (n, d) with nodes inside edges, facets and cells in their middles; the ``fixed`` (k,) nodes stay.

    Examples
    --------
    >>> between({"bar3": np.array([[0, 1, 2]])}, np.array([[0.0], [2.0], [0.0]]), np.array([0, 1])).ravel().tolist()
    [0.0, 2.0, 1.0]
    """
    out = np.array(places)
    for cell, cells in blocks.items():
        it = CELLS[cell]
        table = tabulate(linear(cell), it.nodes[it.corners :])[0]
        if len(table):
            out[cells[:, it.corners :]] = np.einsum("ka,ead->ekd", table, places[cells[:, : it.corners]])
    out[fixed] = places[fixed]
    return out
