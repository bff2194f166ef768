"""Heat of solids on new meshes of their present shapes (docs/theory/bodies/remeshing.md#heat)."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.adaptivity.rezoning.zones import zones_of
from softway.adaptivity.unrelated.heat import HeatTransfer, heat_transfer, sampled
from softway.adaptivity.unrelated.heat_of_zones import HeatedZones, HeatOfZones, heat_of_zones
from softway.arrays import Array
from softway.bodies.assembled.material_states import of_region, with_region
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.inertia.nodal_heat import heat_masses
from softway.heat.coupled.point_temperature import after_jumps
from softway.heat.coupled.solid_temperature import TEMPERATURE
from softway.heat.fronts.carried_contents import with_contents
from softway.heat.heat_model import HeatModel, HeatPart
from softway.heat.operators import HeatValues, entropy, heat_values
from softway.laws.heat.heat_content import ContentCurve, content_curve
from softway.laws.heat.temperature_table import value_at
from softway.marching.remeshing.carried_heat import heat_to_pass, temperature_of, temperatures_from
from softway.marching.remeshing.forming.expansion import stress_of_laws
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.scene import State

ENTROPIES = 12
"""Greatest number of searches for contents of cut cells that do not lower the entropy."""
UNMIXED = 3
"""Searches without an exchange between neighbours."""
MARGIN = 1.5
"""Entropy that the contents get, relative to what the cut cells lack."""


Transfer = HeatTransfer | HeatOfZones
"""Transfer of the heat of a solid of one material, or of several."""


def heat_on(models: tuple[Model, Model], now: ModelState, changed: Collection[str]) -> Array | None:
    """Unknowns (k + r,) of the heat on new meshes of the solids that have ``changed``, of which the others keep theirs;
    None without.

    Parameters
    ----------
    models
        Models of the old and the new meshes.
    now
        State before.
    changed
        Names of the solids.

    Raises
    ------
    NumericsError
        If no temperatures of cut cells have the contents before.
    """
    passing = heat_to_pass(models, now)
    if passing is None:
        return None
    (old, new), last, out = passing
    parts, melting = {part.name: part for part in old.parts}, list[_Melting]()
    for part in new.parts:
        was = parts[part.name]
        if part.name not in changed:
            out[part.nodes] = last.unknowns[was.nodes]
            continue
        transfer = _transfer(models, now, (was, part))
        if part.law.latent is not None and not part.at_nodes:
            out[part.nodes] = np.asarray(transfer.near @ last.unknowns[was.nodes])
            melting.append(_Melting(transfer=transfer, part=part, was=was, old=old, last=last))
        else:
            out[part.nodes] = _unknowns(transfer, part, old, was, last)
    return _melted(new, out, melting)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Melting:
    """Solid with cut cells, whose contents pass over: its parts of the old and the new model, and the heat before."""

    transfer: Transfer
    part: HeatPart
    was: HeatPart
    old: HeatModel
    last: HeatValues

    def contents(self, more: float, rounds: int) -> Array:
        """Contents (m,) of the nodes [J], with ``more`` entropy than that of the contents before [J/K], and mixed with
        their neighbours in some rounds.
        """
        melts, mass = self.part.law.latent, self.old.mass[self.was.nodes]
        assert melts is not None
        curve = content_curve(self.part.law, latent=True)

        def entropies(content: Array) -> Array:
            temperature = curve.temperature(content)[0]
            share = curve.liquid_share(content, temperature)[0]
            return np.asarray(curve.entropy(temperature) + share * melts.heat / melts.melting)

        values = self.last.content[self.was.nodes] / mass
        least = float(mass @ entropies(values)) + more
        found = self.transfer.carried(values, least, entropies)
        for _ in range(rounds):
            found = self.transfer.mixed(found)
        return np.asarray(self.transfer.capacity * found)

    def lacks(self, new: HeatModel, now: HeatValues) -> float:
        """Entropy by which the cut cells on the new mesh are below those on the old one [J/K]."""
        before = entropy(replace(self.old, parts=(self.was,)), self.last)
        return before - entropy(replace(new, parts=(self.part,)), now)


def _melted(heat: HeatModel, unknowns: Array, solids: Sequence[_Melting]) -> Array:
    """Unknowns (k + r,) with which the ``solids`` with cut cells have the contents that pass over.

    Cut cells have less entropy than their contents in equilibrium, by more or less on other meshes: the contents pass
    with as much more as the cells would lose, if need be after an exchange with the neighbours.
    """
    more = dict.fromkeys((one.part.name for one in solids), 0.0)
    found = unknowns
    for k in range(ENTROPIES if solids else 0):
        rounds = max(k - UNMIXED, 0)
        wanted = {one.part.name: one.contents(more[one.part.name], rounds) for one in solids}
        found = with_contents(heat, unknowns, wanted)
        now = heat_values(heat, found, slopes=False)
        lacks = {one.part.name: max(one.lacks(heat, now), 0.0) for one in solids}
        if not any(lacks.values()):
            break
        more = {name: more[name] + MARGIN * lacks[name] for name in more}
    return found


def _transfer(models: tuple[Model, Model], now: ModelState, parts: tuple[HeatPart, HeatPart]) -> Transfer:
    """Transfer of the heat of a solid: of capacities, or of masses where the capacity depends on the temperature."""
    sides = [
        _side(model, heat, at) for model, heat, at in zip(models, parts, (now.start.displacement, None), strict=True)
    ]
    (old, before), (new, after) = sides
    section = new.internal.section
    if new.materials.owner is not None:
        one, other = (
            _zones(model, part, at) for model, (part, at) in zip(models, ((old, before), (new, after)), strict=True)
        )
        return heat_of_zones(one, other, section)
    weights = [_weight(model)[heat.nodes] for model, heat in zip(models, parts, strict=True)]
    samples = [sampled(part.mesh.blocks, places, section) for part, places in sides]
    return heat_transfer(samples[0], samples[1], weights[0], weights[1])


def _side(model: Model, heat: HeatPart, at: Array | None) -> tuple[DiscreteSolid, Array]:
    """A solid, and the places (n, d) of its nodes at displacements of all, or at rest [m]."""
    part = next(p for p in model.parts if p.name == heat.name)
    return part, part.mesh.points if at is None else part.mesh.points + at[part.nodes]


def _weight(model: Model) -> Array:
    """Capacities of all nodes with heat, or masses where the capacity depends on the temperature."""
    found = temperature_of(model)
    assert found is not None
    of = found[1].model
    return of.mass if of.capacity is None else of.capacity


def _zones(model: Model, part: DiscreteSolid, places: Array) -> HeatedZones:
    """A solid of several materials with the capacities, or masses, of its nodes in each."""
    materials, found, factors = part.materials, temperature_of(model), np.ones(part.mesh.n_cells)
    assert found is not None and materials.owner is not None
    heat = found[1].model
    first = next(p for p in heat.parts if p.name == part.name).cells.start
    for cells in heat.cells if heat.capacity is not None else ():
        own = cells.numbers - first
        here = (own >= 0) & (own < part.mesh.n_cells)
        factors[own[here]] = float(value_at(cells.law.capacity, np.ones(1))[0])
    weight, zones = np.asarray(materials.density) * factors, zones_of(part.mesh, materials.owner)
    inside = [materials.owner == k for k in np.unique(materials.owner).tolist()]
    capacities = tuple(heat_masses(part.mesh, part.internal.section, weight, one) for one in inside)
    return HeatedZones(blocks=zones.blocks, places=places, capacities=capacities)


def _unknowns(transfer: Transfer, part: HeatPart, old: HeatModel, was: HeatPart, last: HeatValues) -> Array:
    """Unknowns (m,) of a solid without cut cells."""
    values = last.unknowns[was.nodes]
    if old.capacity is not None:
        return transfer.carried(values, float(old.capacity[was.nodes] @ np.log(values)), np.log)
    curve = part.curve
    assert isinstance(curve, ContentCurve)

    def entropies(content: Array) -> Array:
        return curve.entropy(curve.temperature(content)[0])

    contents = values if part.at_nodes else curve.content(values + part.zero)
    found = transfer.carried(contents, float(old.mass[was.nodes] @ entropies(contents)), entropies)
    return found if part.at_nodes else curve.temperature(found)[0] - part.zero


def warmed_state(model: Model, state: State, unknowns: Array | None, changed: Collection[str]) -> State:
    """State with the temperatures of the unknowns (k + r,), which the laws of the solids that have ``changed`` know at
    their points; their stress there is the whole stress of the state less that of the free strain.
    """
    found, here = temperatures_from(model, unknowns), temperature_of(model)
    if found is None or here is None or unknowns is None:
        return state
    temperature = here[1]
    values = heat_values(temperature.model, unknowns)
    state = stress_of_laws(model, values, state, changed)
    memory, following = dict(state.memory), after_jumps(temperature.model, values, state.time)
    points = temperature.of_points(following)
    for point in temperature.points:
        name = model.parts[point.solid].name
        if name not in changed:
            continue
        own, (kelvin, factor, _) = of_region(memory[name], point.region), point.at(points)
        if own.temperature is not None:
            own = replace(own, temperature=kelvin)
        if own.stiffness is not None:
            own = replace(own, stiffness=factor)
        memory[name] = with_region(memory[name], point.region, own)
    return replace(state, memory=memory, fields={**state.fields, TEMPERATURE.name: found})
