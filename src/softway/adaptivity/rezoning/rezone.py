"""New places of the nodes of a degraded mesh, with the same cells."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from softway.adaptivity.rezoning.flat_surface import sliding
from softway.adaptivity.rezoning.rim import anchors, rims, slid
from softway.adaptivity.rezoning.smoothing import distortion, ideal_places, moved, slid_along
from softway.adaptivity.rezoning.volume import volume_of, with_volume
from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.meshes.cells import CELLS, linear
from softway.meshes.element import tabulate
from softway.meshes.mesh import Mesh

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
    others stay, so that the shape does.  Nodes inside have the places of least distortion from the base mesh in the
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
    mesh, section = part.mesh, part.internal.section
    wanted = volume_of(mesh.blocks, section, places)
    boundary = mesh.nodes("surface")
    new, closed = np.array(places), np.array(closed)
    if mesh.dim == 2:
        for rim in rims(mesh):
            held = anchors(base, rim, places, closed, tags)
            new[rim], closed[rim] = slid(base.points, rim, places, held, closed)
        new[kept] = places[kept]
        new, pushed = on_tools(new, closed)
        stays = closed | kept | pushed
        free = part.dofs.free & (np.isin(np.arange(len(places)), boundary) & ~stays)[:, None]
        new = with_volume(mesh.blocks, mesh.boundary(), section, new, wanted, free)
    bent = distortion(mesh.blocks, ideal_places(base.points, places))
    found = moved(bent, places, boundary, new[boundary])
    if found is not None and mesh.dim == 3:
        inside = np.setdiff1d(np.unique(bent.simplices), boundary)
        found = slid_along(bent, found, inside, *sliding(mesh, found, kept))
    return None if found is None else between(mesh.blocks, found, boundary)


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
