"""Masses of the nodes for the capacity of a body, and volumes of the nodes for sources of heat."""

from collections.abc import Iterator

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.heat_functions import QUADRATIC, heat_functions
from softway.bodies.elements.quadrature import sampled_cells
from softway.bodies.elements.section import Section
from softway.bodies.inertia.mass_matrix import Body, Lumped, assembled, body_of, cell_masses
from softway.meshes.mesh import Mesh


def heat_masses(mesh: Mesh, section: Section, density: float | Array, inside: BoolArray | None = None) -> Array:
    """Masses (n,) of the nodes [kg] that hold the heat: the lumped mass, or the integrals of the functions of heat.

    Parameters
    ----------
    mesh, section
        Mesh of the body, and section of its elements.
    density
        Mass per reference volume [kg/m^3], positive; one number, or one for each element (e,).
    inside
        (e,) elements that count; all by default.

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> from softway.meshes.generators.shapes import rectangle
    >>> heat_masses(rectangle((1.0, 1.0), (1, 1), cell="quad8"), PlaneStrain(), 76.0).round(9).tolist()
    [3.0, 16.0, 3.0, 16.0, 16.0, 3.0, 16.0, 3.0]
    """
    chosen, first = [], 0
    for table, nodes, mass in body_of(mesh, section, density).blocks:
        mine = slice(None) if inside is None else inside[first : first + len(nodes)]
        if table.cell not in QUADRATIC:
            chosen.append((table, nodes[mine], mass[mine]))
        first += len(nodes)
    out = np.zeros(mesh.n_nodes)
    if chosen:
        out += assembled(Body(mesh, tuple(chosen)), Lumped(), np.ones(mesh.n_nodes)).diagonal()
    weight = np.broadcast_to(np.asarray(density, float), mesh.n_cells)
    for nodes, volume in _spread(mesh, section, weight if inside is None else weight * inside):
        np.add.at(out, nodes, volume)
    return out


def cell_heat_masses(mesh: Mesh, section: Section, density: float | Array) -> Array:
    """Masses (e, a) [kg] of :func:`heat_masses` by the cells of a mesh of one type.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.meshes.generators.shapes import interval
    >>> cell_heat_masses(interval(2.0, cells=2), Bar(), 4.0).round(12).tolist()
    [[2.0, 2.0], [2.0, 2.0]]
    """
    weight = np.array(np.broadcast_to(np.asarray(density, float), mesh.n_cells))
    for _, volume in _spread(mesh, section, weight):
        return volume
    ((_, masses),) = cell_masses(body_of(mesh, section, weight), Lumped(), np.ones(mesh.n_nodes))
    return np.asarray(masses.sum(axis=2))


def heated_volumes(mesh: Mesh, section: Section, inside: Array) -> Array:
    """Volumes (n,) of the nodes [m^3] in a part of a body: of each element the share ``inside`` (e,).

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.meshes.generators.shapes import interval
    >>> heated_volumes(interval(2.0, cells=2), Bar(), np.array([1.0, 0.0])).round(9).tolist()
    [0.5, 0.5, 0.0]
    """
    out, first = np.zeros(mesh.n_nodes), 0
    for table, nodes, volume in body_of(mesh, section, 1.0).blocks:
        if table.cell not in QUADRATIC:
            np.add.at(out, nodes, (volume * inside[first : first + len(nodes), None]) @ table.N)
        first += len(nodes)
    for nodes, volume in _spread(mesh, section, inside):
        np.add.at(out, nodes, volume)
    return out


def _spread(mesh: Mesh, section: Section, weight: Array) -> Iterator[tuple[IntArray, Array]]:
    """Nodes (e, a) and weighted integrals (e, a) [m^3] of the cells that have functions of heat of their own.

    They are those of the quadrature that the strain has, so that uniform heat of a strain warms all nodes evenly.
    """
    if not QUADRATIC.keys() & mesh.blocks.keys():
        return
    first = 0
    for cells in sampled_cells(mesh, section, "point", small=False).kinds:
        count = len(cells.nodes)
        if cells.element.cell in QUADRATIC:
            volume = cells.volume * weight[first : first + count, None]
            yield cells.nodes, np.einsum("eq,eqa->ea", volume, heat_functions(cells))
        first += count
