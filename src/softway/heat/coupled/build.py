"""Model of a scene with the temperatures of its solids."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

import numpy as np

from softway.arrays import IntArray
from softway.bodies.assembled.heated_nodes import heated_nodes
from softway.bodies.assembled.material_states import scaled
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.conductor import Conductor, RigidThermal, Thermal, conduction_laws
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.setup.heat_loads import HeatLoad, place_of
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.solid import Solid
from softway.errors import InputError, within
from softway.heat.build_heat import heat_model
from softway.heat.coupled.contact_exchange import contact_exchange
from softway.heat.coupled.dissipation import Dissipation, dissipations
from softway.heat.coupled.point_temperature import PointTemperature, after_jumps, point_temperatures, starting
from softway.heat.coupled.solid_temperature import SolidTemperature
from softway.heat.coupled.strain.expansion import Expansion, expansions
from softway.heat.coupled.strain.free_strain import FreeStrain
from softway.heat.coupled.strain.moduli import Moduli
from softway.heat.coupled.strain.stored import ElasticTerm, elastic_terms
from softway.heat.coupled.through_ties import breaking_glue, require_heated, through_links, through_ties
from softway.heat.heat_model import HeatModel, Lump
from softway.heat.operators import heat_values, unknowns_of
from softway.heat.regional_laws import regional_laws
from softway.laws.heat.stiffness_table import StiffnessCurve
from softway.laws.law import softens
from softway.mechanisms.members.rigid import Rigid
from softway.model.build import mechanical, with_field
from softway.model.model import Model
from softway.model.scene import Scene


def build(scene: Scene, known: Model | None = None) -> Model:
    """Build the model of a scene: meshes, tables, mass, contacts, and the temperature of solids with heat.

    Parameters
    ----------
    scene
        The scene.
    known
        Model of another scene: solids that are the very same object in both keep its arrays, with the same bits as
        those that are built.

    Raises
    ------
    InputError
        With the place in the scene: if a tag matches nothing, a body does not exist, dimensions are mixed, a solid
        with heat has no temperature, no conduction or no expansion, a law needs the temperature of a solid without, or
        a rigid body has heat where no solid has.

    Examples
    --------
    >>> import softway as sw
    >>> heat = sw.bodies.Thermal(law=sw.heat.Conduction(conductivity=50.0, capacity=500.0), temperature=300.0)
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=1), material=sw.LinearElastic(E=2e11), density=7800.0,
    ...                thermal=heat)
    >>> [field.name for field in build(sw.Scene(bodies={"bar": bar})).fields]
    ['displacement', 'temperature']
    """
    model = mechanical(scene, known)
    heated = {name: body for name, body in scene.bodies.items() if isinstance(body, Solid) and body.thermal is not None}
    loads = {k: load for k, load in enumerate(scene.loads) if not isinstance(load, Gravity | Traction)}
    rigid = {} if scene.mechanism is None else scene.mechanism.bodies
    lumps = tuple(_lump(name, body, body.thermal) for name, body in rigid.items() if body.thermal is not None)
    if lumps and not heated:
        problem, remedy = "of a rigid body among solids without a temperature", "bodies.NAME.thermal of a solid as well"
        raise InputError(f"bodies.{lumps[0].name}.thermal", problem, f"{remedy}, or no thermal of the rigid body")
    _require_heated(loads, [*heated, *(lump.name for lump in lumps)])
    for k, contact in enumerate(scene.contacts):
        if contact.heat is not None and not heated:
            problem = f"heat across {contact.label!r}, of bodies without a temperature"
            raise InputError(f"contacts[{k}].heat", problem, "the heat of a solid, thermal, or a contact without heat")
    _require_temperature(scene)
    require_heated(model, heated)
    return with_temperature(model, heated, loads, lumps) if heated else model


def with_temperature(
    model: Model, heated: Mapping[str, Solid], loads: Mapping[int, HeatLoad], lumps: tuple[Lump, ...] = ()
) -> Model:
    """Model whose solids ``heated`` and rigid bodies ``lumps`` have a temperature, with the heat ``loads`` by their
    numbers in the scene.
    """
    parts = {part.name: part for part in model.parts if part.name in heated}
    thermals = {name: thermal for name, body in heated.items() if (thermal := body.thermal) is not None}
    found: list[Expansion] = []
    spent: list[Dissipation] = []
    elastic: list[ElasticTerm] = []
    softened: list[PointTemperature] = []
    conductors = {}
    for name, part in parts.items():
        with within(f"bodies.{name}"):
            conductors[name] = _conductor(part, thermals[name])
            expands = bool(thermals[name].expansion or thermals[name].melting_strain)
            number = list(model.meshes).index(name)
            if expands:
                found.extend(expansions(number, part))
            spent.extend(dissipations(number, part, thermals[name].heating))
            table = thermals[name].stiffness
            if table is not None:
                elastic.extend(elastic_terms(number, part, min(table.values)))
            softened.extend(point_temperatures(number, part, table is not None, expands))
    heat = heat_model(conductors, loads, lumps=lumps, key="thermal")
    nodes = heated_nodes(parts, model.shape[0], len(lumps))
    always, stops = through_links(model.scene.mechanism, lumps, len(nodes.number))
    heat = replace(heat, exchanges=(*through_ties(model, thermals, nodes), *always))
    pairs = ((part, regional_laws(conductors[part.name], part.mesh)) for part in heat.parts)
    effusivity = {part.name: laws.effusivity(part.mesh, part.volume) for part, laws in pairs}
    equations = SolidTemperature(
        contacts=contact_exchange(model, nodes, effusivity, lumps), inert=model.inert,
        model=replace(heat, space=LocalSpace(_of_solids(model, nodes.number))), heated=nodes,
        moduli=Moduli(free=_free_strain(heat, thermals), curves=tuple(_curves(heat, thermals))),
        expansions=tuple(found), dissipations=tuple(spent), elastic=tuple(elastic), points=tuple(softened),
        glue=tuple(breaking_glue(model, nodes)), links=tuple(stops),
    )  # fmt: skip
    if softened:
        known = heat_values(heat, unknowns_of(heat, heat.initial))
        start = equations.of_points(after_jumps(heat, known, 0.0))
        model = replace(model, parts=starting(model.parts, softened, start))
    return with_field(_scaled(model, equations), equations)


def _of_solids(model: Model, heated: IntArray) -> tuple[slice, ...]:
    """Places of the nodes of each solid among those with heat (k,), ascending."""
    ends = ([part.nodes.start, part.nodes.stop] for part in model.parts)
    return tuple(slice(*np.searchsorted(heated, two).tolist()) for two in ends)


def _scaled(model: Model, equations: SolidTemperature) -> Model:
    """Model with the stiffness of its solids at the initial temperatures."""
    factor = equations.factor(equations.initial())[:, 0] if equations.elastic else None
    return replace(model, parts=scaled(model.parts, factor))


def _curves(heat: HeatModel, thermals: Mapping[str, Thermal]) -> Iterator[tuple[IntArray, StiffnessCurve]]:
    """Nodes with moduli that depend on the temperature, among those with heat, and their factor."""
    for part in heat.parts:
        table = thermals[part.name].stiffness
        if table is not None:
            yield np.arange(heat.n_nodes)[part.nodes], table.curve()


def _free_strain(heat: HeatModel, thermals: Mapping[str, Thermal]) -> FreeStrain:
    """Free strain of the nodes of solids with heat."""
    reference, coefficient, melting = heat.initial.copy(), np.zeros(heat.n_nodes), np.zeros(heat.n_nodes)
    for part in heat.parts:
        thermal = thermals[part.name]
        coefficient[part.nodes], melting[part.nodes] = thermal.expansion, thermal.melting_strain
        if thermal.reference is not None:
            reference[part.nodes] = thermal.reference
    liquid = heat_values(heat, unknowns_of(heat, reference), slopes=False).share
    return FreeStrain(reference=reference, liquid=liquid, coefficient=coefficient, melting=melting)


def _conductor(part: DiscreteSolid, thermal: Thermal) -> Conductor:
    """The solid as a conductor of heat."""
    laws = conduction_laws(thermal.law).values()
    sharp = any(law.latent is not None and not law.latent.half_range for law in laws)
    if sharp and "hex20" in part.mesh.blocks:
        problem = "a sharp front in hex20 cells, which have no simplices between their nodes"
        raise InputError("thermal.law.latent", problem, "hex27, or a half_range")
    materials = part.materials
    uniform = len(set(materials.densities)) == 1
    density = materials.densities[0] if uniform else dict(zip(materials.regions, materials.densities, strict=True))
    return Conductor(
        mesh=part.mesh, law=thermal.law, density=density, section=part.internal.section,
        temperature=thermal.temperature,
    )  # fmt: skip


def _lump(name: str, body: Rigid, thermal: RigidThermal) -> Lump:
    """Rigid body with one temperature."""
    return Lump(
        name=name,
        capacity=thermal.capacity_of(body.mass),
        initial=thermal.temperature,
        effusivity=thermal.effusivity(body.mass, body.density),
        area=thermal.area,
        volume=None if body.density is None else body.mass / body.density,
    )


def _require_temperature(scene: Scene) -> None:
    """Refuse laws that depend on the temperature in solids without one."""
    for name, body in scene.bodies.items():
        if isinstance(body, Solid) and body.thermal is None:
            laws = body.material.values() if isinstance(body.material, Mapping) else (body.material,)
            for law in filter(softens, laws):
                problem = f"missing: {type(law).__name__} softens with the temperature of the solid"
                remedy = "the heat of the solid, thermal = { temperature = ..., law = ... }, or no softening of the law"
                raise InputError(f"bodies.{name}.thermal", problem, remedy)


def _require_heated(loads: Mapping[int, HeatLoad], heated: Collection[str]) -> None:
    """Refuse heat loads on bodies without a temperature."""
    for k, load in loads.items():
        name = place_of(load)[0]
        if name not in heated:
            where = f"loads[{k}].{'of' if hasattr(load, 'of') else 'on'}"
            known = f", or one of {', '.join(heated)}" if heated else ""
            raise InputError(where, f"{name!r} has no temperature", f"the heat of the solid, thermal{known}")
