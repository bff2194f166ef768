"""Volume of a mesh, and its correction by free nodes of the boundary."""

from collections.abc import Mapping, Sequence

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.section import Section
from softway.kernels.geometry.jacobians import determinants
from softway.meshes.cells import CELLS
from softway.meshes.element import element, exact_degree

CLOSED = 1e-14
"""Relative defect of the volume at which the correction ends."""
ROUNDS = 12
"""Greatest number of corrections."""
STEP = 1e-6
"""Length, relative to the mesh, by which a part of the boundary moves for its derivative."""
Sheet = tuple[Mapping[str, IntArray], BoolArray]
"""Facets of a part of the boundary of zones, and components (n, d) of its nodes that may move."""


def volume_of(blocks: Mapping[str, IntArray], section: Section, places: Array) -> float:
    """Volume [m^3] of the cells of a section with nodes at the places (n, d) [m]; folded parts count as negative.

    Examples
    --------
    >>> from softway.bodies.elements.section import Axisymmetric
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> round(volume_of({"quad4": np.array([[0, 1, 2, 3]])}, Axisymmetric(), square) / np.pi, 12)
    1.0
    """
    total = 0.0
    for cell, cells in blocks.items():
        table = element(cell, exact_degree(cell, curved=True) + 1)
        x = places[cells]
        measures = determinants(np.einsum("ead,qar->eqrd", x, table.dN)) * table.weights
        total += float((measures * section.measure(np.einsum("qa,ead->eqd", table.N, x))).sum())
    return total


def normals(facets: Mapping[str, IntArray], places: Array) -> Array:
    """Sums (n, d) over the boundary facets at each node of their area normals by corners [m^(d-1)].

    Examples
    --------
    >>> normals({"bar2": np.array([[0, 1]])}, np.array([[0.0, 0.0], [2.0, 0.0]])).tolist()
    [[0.0, -1.0], [0.0, -1.0]]
    """
    out = np.zeros_like(places)
    for facet, nodes in facets.items():
        corners = nodes[:, : CELLS[facet].corners]
        x = places[corners]
        if places.shape[1] == 2:
            along = x[:, 1] - x[:, 0]
            area = np.stack([along[:, 1], -along[:, 0]], axis=1)
        else:
            triangle = x.shape[1] == 3
            area = 0.5 * np.cross(x[:, 2] - x[:, 0], x[:, 1 if triangle else 3] - x[:, 0 if triangle else 1])
            area = -area if triangle else area
        np.add.at(out, nodes, area[:, None] / nodes.shape[1])
    return out


def with_volume(
    blocks: Mapping[str, IntArray],
    facets: Mapping[str, IntArray],
    section: Section,
    places: Array,
    wanted: float,
    free: BoolArray,
) -> Array:
    """Places (n, d) with a given volume: free nodes of the boundary move along their normals by one length.

    Parameters
    ----------
    blocks, facets
        Cells, and facets of the boundary that face outward.
    section
        Section of the cells.
    places
        (n, d) places of the nodes [m].
    wanted
        Volume [m^3].
    free
        (n, d) components that may move.

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((1.0, 1.0), cells=(2, 2))
    >>> free = np.repeat(np.isin(np.arange(9), mesh.nodes("right"))[:, None], 2, axis=1) & [True, False]
    >>> new = with_volume(mesh.blocks, mesh.boundary(), PlaneStrain(), mesh.points, 1.1, free)
    >>> round(float(new[:, 0].max()), 12)
    1.1
    """
    now, slope = np.array(places), None
    before = volume_of(blocks, section, now)
    for _ in range(ROUNDS):
        defect = wanted - before
        if abs(defect) <= CLOSED * abs(wanted):
            break
        unit, length = _ways(facets, free, now)
        if not length.any():
            break
        step = defect / (length.sum() if slope is None else slope)
        now = now + step * unit
        after = volume_of(blocks, section, now)
        slope, before = (after - before) / step, after
    return now


def with_volumes(
    zones: Sequence[Mapping[str, IntArray]],
    sheets: Sequence[Sheet],
    section: Section,
    places: Array,
    wanted: Array,
) -> Array:
    """Places (n, d) with given volumes of all zones: free nodes of each sheet, a part of the boundary of zones, move
    along their normals by one length; of all such lengths the least ones.

    Parameters
    ----------
    zones
        Cells of each zone.
    sheets
        Facets of each sheet, and components (n, d) of its nodes that may move.
    section
        Section of the cells.
    places
        (n, d) places of the nodes [m].
    wanted
        (z,) volumes [m^3].

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((2.0, 1.0), cells=(2, 1))
    >>> zones = [{"quad4": cell[None]} for cell in mesh.blocks["quad4"]]
    >>> sheets = [({"bar2": np.array([pair])}, np.isin(np.arange(6), pair)[:, None]) for pair in ([1, 4], [2, 5])]
    >>> with_volumes(zones, sheets, PlaneStrain(), mesh.points, np.array([1.1, 1.0]))[:3, 0].round(12).tolist()
    [0.0, 1.1, 2.1]
    """
    now, size = np.array(places), STEP * float(np.ptp(places, axis=0).max())

    def volumes(at: Array) -> Array:
        return np.array([volume_of(blocks, section, at) for blocks in zones])

    for _ in range(ROUNDS):
        before = volumes(now)
        defect = wanted - before
        if (np.abs(defect) <= CLOSED * np.abs(wanted)).all():
            break
        units = [_ways(facets, free, now)[0] for facets, free in sheets]
        slopes = np.stack([(volumes(now + size * unit) - before) / size for unit in units], axis=1)
        steps = np.linalg.lstsq(slopes, defect, rcond=1e-8)[0]
        now = now + sum(step * unit for step, unit in zip(steps.tolist(), units, strict=True))
    return now


def _ways(facets: Mapping[str, IntArray], free: BoolArray, places: Array) -> tuple[Array, Array]:
    """Unit normals (n, d) of the free components of nodes, and the lengths (n, 1) of their area normals."""
    unit = np.where(free, normals(facets, places), 0.0)
    length = np.linalg.norm(unit, axis=1, keepdims=True)
    return unit / np.where(length > 0.0, length, 1.0), length
