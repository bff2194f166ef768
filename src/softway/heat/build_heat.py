"""Discretisation of conductors: capacities, cells, simplices of latent heat, boundary conditions."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.conductor import Conductor, sample_temperature
from softway.bodies.elements.cut_cells import simplices_of
from softway.bodies.elements.section import Axisymmetric, Section, check_section, default_section
from softway.bodies.inertia.mass_matrix import body_of
from softway.bodies.inertia.nodal_heat import heated_volumes
from softway.bodies.setup.heat_loads import HeatLoad, HeatSource, Radiation, Temperature, place_of, surface_points
from softway.bodies.setup.held_temperatures import held_temperatures
from softway.errors import InputError, within
from softway.heat.fronts.build_fronts import with_fronts
from softway.heat.heat_contact import HeatContact, HeatExchange, heat_exchange
from softway.heat.heat_model import HeatCells, HeatModel, HeatPart, HeatScene, HeatSurface, Lump, Simplices
from softway.heat.operators import heat_flow, heat_values, unknowns_of
from softway.heat.regional_laws import RegionalLaws, regional_laws
from softway.kernels.assembly.assembler import assembler
from softway.kernels.geometry.jacobians import cell_geometry
from softway.laws.heat.conduction import Conduction
from softway.laws.heat.temperature_table import value_at
from softway.meshes.element import element, exact_degree, stiffness_degree
from softway.meshes.mesh import Mesh

FRONT = 1e-5
"""Range of temperatures of a front, relative to the latent heat over the capacity of the solid.

A cell that is at melting throughout has no front in it.  Without a range its content would be any, and the balance of
the heats would have no solution that a temperature describes.
"""


def build_heat(scene: HeatScene) -> HeatModel:
    """Discretise the conductors of a scene.

    Raises
    ------
    InputError
        With the place in the scene: no bodies, loads on bodies or tags that are not there, temperatures that are not
        positive, a section or a conductivity that does not fit the mesh, latent heat in cells that have no simplices.

    Examples
    --------
    >>> import softway as sw
    >>> law = sw.heat.Conduction(conductivity=1.0, capacity=1.0)
    >>> mesh = sw.meshes.Interval(length=1.0, cells=2)
    >>> bar = sw.heat.Conductor(mesh=mesh, law=law, density=1.0, temperature=300.0)
    >>> build_heat(HeatScene(bodies={"bar": bar})).mass.tolist()
    [0.25, 0.5, 0.25]
    """
    if not scene.bodies:
        raise InputError("bodies", "no bodies", "at least one Conductor")
    return heat_model(scene.bodies, dict(enumerate(scene.loads)), scene.contacts)


def heat_model(
    bodies: Mapping[str, Conductor],
    loads: Mapping[int, HeatLoad],
    contacts: tuple[HeatContact, ...] = (),
    lumps: tuple[Lump, ...] = (),
    key: str = "",
) -> HeatModel:
    """Model of conductors, or of the ``key`` of solids, with loads by their numbers; errors as :func:`build_heat`."""
    parts: list[HeatPart] = []
    cells: list[HeatCells] = []
    simplices: list[Simplices] = []
    masses, initial, n, e = [], [], 0, 0
    for name, body in bodies.items():
        with within(f"bodies.{name}.{key}".rstrip(".")):
            part, section, laws, mass = _part(name, body, n, e)
            cells.extend(_cells(part, section, laws))
            simplices.extend(() if body.latent == "front" else _simplices(part, section, laws))
            with within("temperature"):
                initial.append(sample_temperature(body.temperature, part.mesh))
        parts.append(part)
        masses.append(mass)
        n, e = part.nodes.stop, part.cells.stop
    masses.append(np.array([lump.capacity for lump in lumps]))
    initial.append(np.array([lump.initial for lump in lumps]))
    n += len(lumps)
    surfaces, sources, held = _loads(bodies, loads, {part.name: part for part in parts}, lumps, n)
    exchanges = _exchanges(bodies, contacts, parts, n)
    constant = all(c.law.constant for c in cells)
    linear = constant and not any(isinstance(s.load, Radiation) for s in surfaces)
    model = HeatModel(
        parts=tuple(parts), cells=tuple(cells), simplices=tuple(simplices), mass=np.concatenate(masses),
        pattern=assembler([c.nodes for c in cells], n, 1), surfaces=surfaces, sources=sources, held=held,
        exchanges=exchanges, ordered=_ordered(loads), lumps=lumps,
        initial=np.concatenate(initial), linear=linear, latent=_latent(simplices, n), n_cells=e,
    )  # fmt: skip
    if not constant:
        return with_fronts(model, bodies)
    capacity = heat_values(model, unknowns_of(model, model.initial)).capacity
    conduction = heat_flow(model, model.initial, np.zeros(e), slopes=True)[1]
    return replace(model, conduction=conduction, capacity=capacity)


def section_of(body: Conductor, mesh: Mesh) -> Section:
    """Section of a conductor, checked against its mesh."""
    section = default_section(mesh) if body.section is None else body.section
    check_section(mesh, section)
    return section


def _part(name: str, body: Conductor, n: int, e: int) -> tuple[HeatPart, Section, RegionalLaws, Array]:
    """Body with its first node ``n`` and its first cell ``e``, and the masses of its nodes [kg]."""
    with within("mesh"):
        mesh = body.mesh if isinstance(body.mesh, Mesh) else body.mesh.build()
    section, laws = section_of(body, mesh), regional_laws(body, mesh)
    melts = laws.first.latent
    at_nodes = melts is not None and (body.latent == "node" or melts.half_range > 0.0)
    if melts is not None and not at_nodes and "hex20" in mesh.blocks:
        raise InputError("latent", "'cell' in hex20, which have no simplices between their nodes", "'node', or hex27")
    quadrature, masses = body_of(mesh, section, laws.density), laws.masses(mesh, section)
    part = HeatPart(
        name=name, mesh=mesh, nodes=slice(n, n + mesh.n_nodes), cells=slice(e, e + mesh.n_cells), law=laws.first,
        curve=laws.curve(masses, at_nodes), at_nodes=at_nodes,
        zero=0.0 if melts is None else melts.melting, mixed=melts is not None and "hex20" in mesh.blocks,
        volume=np.concatenate([mass.sum(axis=1) for _, _, mass in quadrature.blocks]) / laws.density,
    )  # fmt: skip
    return part, section, laws, np.asarray(sum(masses[1:], masses[0]))


def _cells(part: HeatPart, section: Section, laws: RegionalLaws) -> list[HeatCells]:
    """Cells of a body by type and law."""
    found, first = [], 0
    for name, block in part.mesh.blocks.items():
        for law, own in laws.cells(first, len(block)):
            found.append(_of_law(part, section, law, name, own, first))
        first += len(block)
    return found


def _of_law(
    part: HeatPart, section: Section, law: Conduction, name: str, own: IntArray | slice, first: int
) -> HeatCells:
    """Cells ``own`` of a type, whose first one is the cell ``first`` of the body, with their law."""
    degree = stiffness_degree(name) if law.constant else exact_degree(name)
    block = part.mesh.blocks[name]
    nodes, numbers = block[own], part.cells.start + first + np.arange(len(block))[own]
    table, x = element(name, degree + (2 if isinstance(section, Axisymmetric) else 0)), part.mesh.points[nodes]
    gradients, measures, _ = cell_geometry(x, table.dN, table.weights)
    volume = measures * section.measure(np.einsum("qa,ead->eqd", table.N, x))
    with within("law"):
        for phase in (law, law.liquid):
            phase.along_axes(np.ones(1), gradients.shape[-1])
    nodes = nodes + part.nodes.start
    return HeatCells(law=law, nodes=nodes, N=table.N, gradients=gradients, volume=volume, numbers=numbers)


def _simplices(part: HeatPart, section: Section, laws: RegionalLaws) -> list[Simplices]:
    """Simplices of a body that melts by their number of corners; their masses add up to those of the cells."""
    if part.law.latent is None or part.mixed:
        return []
    found, first = [], 0
    for table, nodes, mass in body_of(part.mesh, section, laws.density).blocks:
        for law, own in laws.cells(first, len(nodes)):
            if law.latent is not None:
                numbers = part.cells.start + first + np.arange(len(nodes))[own]
                found.append(_cut_cells(part, section, law, (table.cell, nodes[own], mass[own].sum(axis=1)), numbers))
        first += len(nodes)
    return found


def _latent(simplices: list[Simplices], n: int) -> Array:
    """Latent heats (n,) of the nodes when all cells are liquid [J]."""
    out = np.zeros(n)
    for block in simplices:
        k = block.nodes.shape[1]
        np.add.at(out, block.nodes, np.repeat(block.heat * block.mass / k, k).reshape(-1, k))
    return out


def _cut_cells(
    part: HeatPart, section: Section, law: Conduction, cells: tuple[str, IntArray, Array], numbers: IntArray
) -> Simplices:
    """Simplices of cells of one type and law, with their nodes (e, a), masses (e,) [kg] and numbers (e,)."""
    assert law.latent is not None
    kind, nodes, mass = cells
    local = np.array(simplices_of(kind))
    corners = part.mesh.points[nodes][:, local]
    edges = corners[:, :, 1:] - corners[:, :, :1]
    size = np.sqrt(np.linalg.det(edges @ np.swapaxes(edges, -1, -2)))
    size = size * section.measure(corners.mean(axis=2))
    share = size / size.sum(axis=1, keepdims=True)
    nodes = nodes[:, local].reshape(len(nodes) * len(local), -1) + part.nodes.start
    return Simplices(
        nodes=nodes, mass=(share * mass[:, None]).ravel(), share=share.ravel(), numbers=np.repeat(numbers, len(local)),
        width=front_width(law), heat=0.0 if part.at_nodes else law.latent.heat,
    )  # fmt: skip


def front_width(law: Conduction) -> float:
    """Range of temperatures above melting [K] in which cut cells melt."""
    assert law.latent is not None
    return FRONT * law.latent.heat / float(value_at(law.capacity, np.array(law.latent.melting)))


Loads = tuple[tuple[HeatSurface, ...], tuple[tuple[HeatSource, Array], ...], tuple[tuple[Temperature, IntArray], ...]]


def _loads(
    bodies: Mapping[str, Conductor],
    loads: Mapping[int, HeatLoad],
    parts: Mapping[str, HeatPart],
    lumps: tuple[Lump, ...],
    n: int,
) -> Loads:
    """Surfaces, sources, and nodes with prescribed temperatures, of which each belongs to one load."""
    rigid = {lump.name: (lump, n - len(lumps) + number) for number, lump in enumerate(lumps)}
    surfaces: list[HeatSurface] = []
    sources: list[tuple[HeatSource, Array]] = []
    held: dict[int, IntArray] = {}
    for k, load in loads.items():
        name, _ = place_of(load)
        with within(f"loads[{k}].{'of' if isinstance(load, HeatSource) else 'on'}"):
            if name not in parts and name not in rigid:
                raise InputError("", f"there is no body {name!r}", ", ".join(repr(known) for known in parts))
            found = _on_rigid(load, *rigid[name], n) if name in rigid else _on_part(load, bodies[name], parts[name], n)
            match found:
                case HeatSurface():
                    surfaces.append(found)
                case tuple():
                    sources.append(found)
                case _:
                    held[k] = found
    return tuple(surfaces), tuple(sources), held_temperatures(loads, held)


OnBody = HeatSurface | tuple[HeatSource, Array] | IntArray
"""Load on a body: its surface, its source with nodal volumes, or the nodes with its temperature."""


def _on_part(load: HeatLoad, body: Conductor, part: HeatPart, n: int) -> OnBody:
    """Load on a conductor."""
    tag, section = place_of(load)[1], section_of(body, part.mesh)
    match load:
        case Temperature():
            return part.nodes.start + part.mesh.nodes(tag)
        case HeatSource():
            return load, _source(part, section, tag, n)
        case _:
            table, areas = surface_points(part.mesh, section, tag)
            data = (table.data, table.indices + part.nodes.start, table.indptr)
            return HeatSurface(load=load, points=sp.csr_array(data, shape=(len(areas), n)), areas=areas)


def _on_rigid(load: HeatLoad, lump: Lump, node: int, n: int) -> OnBody:
    """Load on a rigid body, the node of this number."""
    if load.on != lump.name:
        raise InputError("", f"{load.on!r}: a rigid body has one temperature, and no tags", repr(lump.name))
    one = np.zeros(n)
    one[node] = 1.0
    match load:
        case Temperature():
            return np.array([node])
        case HeatSource():
            if lump.volume is None:
                problem = f"power per volume of {lump.name!r}, whose density is not given"
                raise InputError("", problem, f"bodies.{lump.name}.density, or a HeatFlux on its area")
            return load, lump.volume * one
        case _:
            if lump.area is None:
                problem = f"{type(load).__name__} on {lump.name!r}, whose surface has no area"
                raise InputError("", problem, f"bodies.{lump.name}.thermal.area, the surface that takes the heat")
            return HeatSurface(load=load, points=sp.csr_array(one[None]), areas=np.array([lump.area]))


def _exchanges(
    bodies: Mapping[str, Conductor], contacts: tuple[HeatContact, ...], parts: list[HeatPart], n: int
) -> tuple[HeatExchange, ...]:
    """Exchange of heat of each contact."""
    known = {p.name: (p.mesh, section_of(bodies[p.name], p.mesh), p.nodes.start) for p in parts}
    found = []
    for k, contact in enumerate(contacts):
        with within(f"contacts[{k}]"):
            found.append(heat_exchange(contact, known, n))
    return tuple(found)


def _ordered(loads: Mapping[int, HeatLoad]) -> tuple[tuple[int, HeatLoad], ...]:
    """Loads with their numbers, in the order of the ledger."""

    def rank(item: tuple[int, HeatLoad]) -> tuple[bool, bool, int]:
        return isinstance(item[1], Temperature), isinstance(item[1], HeatSource), item[0]

    return tuple(sorted(loads.items(), key=rank))


def _source(part: HeatPart, section: Section, region: str, n: int) -> Array:
    """Volumes (n,) of the nodes in a region [m^3]."""
    inside, out = np.zeros(part.mesh.n_cells), np.zeros(n)
    inside[part.mesh.cells(region)] = 1.0
    out[part.nodes] = heated_volumes(part.mesh, section, inside)
    return out
