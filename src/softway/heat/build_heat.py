"""Discretisation of conductors: capacities, cells, simplices of latent heat, boundary conditions."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.conductor import Conductor, sample_temperature
from softway.bodies.elements.cut_cells import simplices_of
from softway.bodies.elements.following_heat import FollowingHeat, following_heat, joined_heat, kept_nodes
from softway.bodies.elements.section import Axisymmetric, Section, check_section, default_section
from softway.bodies.inertia.mass_matrix import body_of
from softway.bodies.setup.heat_loads import HeatLoad, HeatSource, Radiation, Temperature
from softway.errors import InputError, within
from softway.heat.fronts.build_fronts import with_fronts
from softway.heat.heat_contact import HeatContact, HeatExchange, heat_exchange
from softway.heat.heat_model import HeatCells, HeatModel, HeatPart, HeatScene, Lump, Simplices
from softway.heat.loads.placed_loads import placed_loads
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
    masses, initial, n, e, count = [], [], 0, 0, 0
    for name, body in bodies.items():
        with within(f"bodies.{name}.{key}".rstrip(".")):
            part, section, laws, mass = _part(name, body, n, e, count)
            cells += _cells(part, section, laws)
            simplices.extend(() if body.latent == "front" else _simplices(part, section, laws))
            with within("temperature"):
                initial.append(sample_temperature(body.temperature, part.mesh)[part.kept])
        parts.append(part)
        masses.append(mass)
        n, e, count = part.nodes.stop, part.cells.stop, part.places.stop
    rigid = np.array([(lump.capacity, lump.initial) for lump in lumps]).reshape(-1, 2).T
    count += len(lumps)
    hanging = joined_heat([part.mesh for part in parts], len(lumps))
    sections = {part.name: section_of(bodies[part.name], part.mesh) for part in parts}
    surfaces, sources, held = placed_loads(loads, parts, sections, lumps, hanging)
    exchanges = _exchanges(sections, contacts, parts, hanging, count)
    constant = all(c.law.constant for c in cells)
    linear = constant and not any(isinstance(s.load, Radiation) for s in surfaces)
    model = HeatModel(
        parts=tuple(parts), cells=tuple(cells), simplices=tuple(simplices), mass=np.concatenate([*masses, rigid[0]]),
        pattern=assembler([c.nodes for c in cells], count, 1), surfaces=surfaces, sources=sources, held=held,
        exchanges=exchanges, ordered=_ordered(loads), lumps=lumps, hanging=hanging, n_cells=e,
        initial=np.concatenate([*initial, rigid[1]]), linear=linear, latent=_latent(simplices, hanging, count),
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


def _part(name: str, body: Conductor, n: int, e: int, first: int) -> tuple[HeatPart, Section, RegionalLaws, Array]:
    """Body with its first node ``n``, its first cell ``e``, its ``first`` node with hanging ones, and the masses of its
    nodes [kg].
    """
    with within("mesh"):
        mesh = body.mesh if isinstance(body.mesh, Mesh) else body.mesh.build()
    section, laws = section_of(body, mesh), regional_laws(body, mesh)
    melts = laws.first.latent
    at_nodes = melts is not None and (body.latent == "node" or melts.half_range > 0.0)
    if melts is not None and not at_nodes and "hex20" in mesh.blocks:
        raise InputError("latent", "'cell' in hex20, which have no simplices between their nodes", "'node', or hex27")
    quadrature, masses = body_of(mesh, section, laws.density), laws.masses(mesh, section)
    kept, follows = kept_nodes(mesh), following_heat(mesh)
    masses = masses if follows is None else tuple(follows.spread.T @ mass for mass in masses)
    part = HeatPart(
        name=name, mesh=mesh, nodes=slice(n, n + len(kept)), cells=slice(e, e + mesh.n_cells), law=laws.first,
        kept=kept, places=slice(first, first + mesh.n_nodes),
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
    nodes = nodes + part.places.start
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


def _latent(simplices: list[Simplices], hanging: FollowingHeat | None, count: int) -> Array:
    """Latent heats (n,) of the nodes when all cells are liquid [J]; with hanging nodes they are ``count``."""
    out = np.zeros(count)
    for block in simplices:
        k = block.nodes.shape[1]
        np.add.at(out, block.nodes, np.repeat(block.heat * block.mass / k, k).reshape(-1, k))
    return out if hanging is None else np.asarray(hanging.spread.T @ out)


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
    nodes = nodes[:, local].reshape(len(nodes) * len(local), -1) + part.places.start
    return Simplices(
        nodes=nodes, mass=(share * mass[:, None]).ravel(), share=share.ravel(), numbers=np.repeat(numbers, len(local)),
        width=front_width(law), heat=0.0 if part.at_nodes else law.latent.heat,
    )  # fmt: skip


def front_width(law: Conduction) -> float:
    """Range of temperatures above melting [K] in which cut cells melt."""
    assert law.latent is not None
    return FRONT * law.latent.heat / float(value_at(law.capacity, np.array(law.latent.melting)))


def _exchanges(
    sections: Mapping[str, Section],
    contacts: tuple[HeatContact, ...],
    parts: list[HeatPart],
    hanging: FollowingHeat | None,
    n: int,
) -> tuple[HeatExchange, ...]:
    """Exchange of heat of each contact."""
    known = {p.name: (p.mesh, sections[p.name], p.places.start) for p in parts}
    found = []
    for k, contact in enumerate(contacts):
        with within(f"contacts[{k}]"):
            one = heat_exchange(contact, known, n)
            found.append(one if hanging is None else replace(one, jump=sp.csr_array(one.jump @ hanging.follow)))
    return tuple(found)


def _ordered(loads: Mapping[int, HeatLoad]) -> tuple[tuple[int, HeatLoad], ...]:
    """Loads with their numbers, in the order of the ledger."""

    def rank(item: tuple[int, HeatLoad]) -> tuple[bool, bool, int]:
        return isinstance(item[1], Temperature), isinstance(item[1], HeatSource), item[0]

    return tuple(sorted(loads.items(), key=rank))
