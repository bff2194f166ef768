"""Temperature of solids on other meshes, and its account."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.heat import Heated, carried_heat
from softway.arrays import Array
from softway.bodies.assembled.material_states import scaled
from softway.bodies.inertia.nodal_heat import cell_heat_masses
from softway.heat.coupled.heat_of_solids import HeatOfSolids
from softway.heat.coupled.solid_temperature import SolidTemperature, temperatures_of
from softway.heat.coupled.strain.deformed import deformed
from softway.heat.fronts.carried_contents import melting_contents, with_contents
from softway.heat.heat_model import HeatModel, HeatPart
from softway.heat.operators import HeatValues, entropy, heat_values, liquid_volumes, rigid_temperatures
from softway.laws.heat.heat_content import ContentCurve
from softway.laws.heat.temperature_table import value_at
from softway.marching.state.model_state import ModelState
from softway.model.field import stiffness_factor
from softway.model.model import Model


def temperature_of(model: Model) -> tuple[int, SolidTemperature] | None:
    """The temperature of solids, with its number among the companion fields; None without."""
    return next(iter(temperatures_of(model.companions)), None)


def strained(model: Model) -> bool:
    """True if the heat of a solid depends on its strain."""
    found = temperature_of(model)
    return found is not None and bool(found[1].expansions or found[1].elastic)


def carries_heat(model: Model, name: str) -> bool:
    """True if the heat of a solid can pass to another mesh: content and temperature of its nodes tell each other."""
    found = temperature_of(model)
    if found is None or found[1].model.capacity is not None:
        return True
    return all(isinstance(part.curve, ContentCurve) for part in found[1].model.parts if part.name == name)


def heat_to_pass(
    models: tuple[Model, Model], now: ModelState
) -> tuple[tuple[HeatModel, HeatModel], HeatValues, Array] | None:
    """Heat of the old and the new meshes, its values before, and unknowns (k + r,) on the new meshes, of which those of
    rigid bodies are known; None without heat.
    """
    found = [temperature_of(model) for model in models]
    if found[0] is None or found[1] is None:
        return None
    (k, before), new = found[0], found[1][1].model
    old, last, out = before.model, before.values_of(now.start.fields[k]), np.empty(new.n_nodes)
    out[new.n_nodes - len(new.lumps) :] = last.unknowns[old.n_nodes - len(old.lumps) :]
    return (old, new), last, out


def carried_unknowns(
    models: tuple[Model, Model],
    pairs: Mapping[str, tuple[AdaptedSolid, AdaptedSolid]],
    at_nodes: Mapping[str, sp.csr_array],
    now: ModelState,
) -> Array | None:
    """Unknowns (k + r,) of the heat on new meshes: temperatures, or specific contents if latent heat is at the nodes.

    Parameters
    ----------
    models
        Models of the old and the new meshes.
    pairs
        Solids on both meshes.
    at_nodes
        Values (m, n) at the new nodes of fields on the old ones, for the solids whose mesh changes; others keep theirs.
    now
        State before.

    Raises
    ------
    NumericsError
        If no temperatures of cut cells have the contents before.
    """
    passing = heat_to_pass(models, now)
    if passing is None:
        return None
    (old, heat), last, out = passing
    everywhere = old.everywhere(last.unknowns)
    wanted: dict[str, Array] = {}
    parts = {part.name: part for part in old.parts}
    for part in heat.parts:
        before, near = parts[part.name], at_nodes.get(part.name)
        if near is None:
            out[part.nodes] = last.unknowns[before.nodes]
            continue
        both = (old, before), (heat, part)
        meshes = tuple(_heated(on, *one) for on, one in zip(pairs[part.name], both, strict=True))
        values = everywhere[before.places]
        if part.law.latent is not None and not part.at_nodes:
            out[part.nodes] = np.asarray(near @ values)[part.kept]
            wanted[part.name] = melting_contents(both, (meshes[0], meshes[1]), near, values)
        else:
            out[part.nodes] = _carried((meshes[0], meshes[1]), (before, part), heat, near, values)
    return with_contents(heat, out, wanted)


def _carried(
    meshes: tuple[Heated, Heated], parts: tuple[HeatPart, HeatPart], heat: HeatModel, near: sp.csr_array, values: Array
) -> Array:
    """Unknowns (k,) of a solid without cut cells, from those (n,) of all its old nodes."""
    (before, part), curve = parts, parts[1].curve
    if heat.capacity is not None:
        return carried_heat(*meshes, near, values, np.log)[part.kept]
    assert isinstance(curve, ContentCurve)
    contents = values if part.at_nodes else curve.content(values + part.zero)
    if before.mesh.hanging is not None:
        contents = before.mesh.hanging.following(contents[:, None])[:, 0]
    found = carried_heat(*meshes, near, contents, lambda h: curve.entropy(curve.temperature(h)[0]))[part.kept]
    return found if part.at_nodes else curve.temperature(found)[0] - part.zero


def temperatures_from(model: Model, unknowns: Array | None) -> dict[str, Array] | None:
    """Temperatures (n, 1) of the solids, and (1, 1) of rigid bodies, from the unknowns (k + r,) of their heat [K]."""
    found = temperature_of(model)
    if found is None or unknowns is None:
        return None
    temperature, now = found[1], heat_values(found[1].model, unknowns, slopes=False)
    rigid = zip(temperature.model.lumps, now.temperature[len(temperature.nodes) :], strict=True)
    return {**model.split(temperature.on_all(now.temperature)), **{lump.name: np.array([[t]]) for lump, t in rigid}}


def with_digits(model: Model, state: ModelState, unknowns: Array | None) -> ModelState:
    """State whose heat has these unknowns (k + r,), of which the temperatures are rounded."""
    found = temperature_of(model)
    if found is None or unknowns is None or found[1].model.linear:
        return state
    k, temperature = found
    there = temperature.in_states(state.start.states)
    last, exact = state.start.fields[k], heat_values(temperature.model, unknowns, slopes=False)
    field = there.at(there.on_all(exact.temperature), state.start.displacement, exact)
    fields = (*state.start.fields[:k], field, *state.start.fields[k + 1 :])
    force, energy = state.start.force + (field.force - last.force), state.start.energy + (field.energy - last.energy)
    return replace(state, start=replace(state.start, fields=fields, force=force, energy=energy))


def _heated(on: AdaptedSolid, heat: HeatModel, part: HeatPart) -> Heated:
    """Capacities of the cells of a solid [J/K], or masses where the capacity depends on the temperature [kg]."""
    materials, cells = on.part.materials, on.adapted.mesh.n_cells
    owner = np.zeros(cells, dtype=np.int64) if materials.owner is None else materials.owner
    weight = np.array(materials.densities)[owner]
    if heat.capacity is not None:
        for some in heat.cells:
            own = some.numbers - part.cells.start
            here = (own >= 0) & (own < cells)
            weight[own[here]] *= float(value_at(some.law.capacity, np.ones(1))[0])
    return Heated(adapted=on.adapted, shares=cell_heat_masses(on.adapted.mesh, on.part.internal.section, weight))


def starting_at(model: Model, fields: Mapping[str, Mapping[str, Array]], u: Array) -> Model:
    """Model whose temperature starts from the given values, at the displacement u (n, d)."""
    found = temperature_of(model)
    if found is None:
        return model
    k, temperature = found
    values = model.join(fields[temperature.field.name])
    initial = temperature.model.initial.copy()
    initial[: len(temperature.nodes)] = values[temperature.nodes, 0]
    there = replace(temperature, model=replace(temperature.model, initial=initial))
    companions = (*model.companions[:k], there, *model.companions[k + 1 :])
    factor = stiffness_factor(companions, tuple(c.at(c.initial(), u) for c in companions))
    return replace(model, companions=companions, parts=scaled(model.parts, factor))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatOfState:
    """Heat of a state: contents [J] and capacities [J/K] of the solids (parts,), entropy [J/K], liquids [m^3] and rigid
    temperatures [K].
    """

    contents: Array
    capacities: Array
    entropy: float
    liquid: Mapping[str, float]
    rigid: Mapping[str, float]


def heat_of(model: Model, now: ModelState, anew: Collection[str] = ()) -> HeatOfState | None:
    """Heat of a state; None without.  It has no energy of the free strain of the solids whose reference is ``anew``."""
    found = temperature_of(model)
    if found is None:
        return None
    k, t = found
    state, u, states = now.start.fields[k], now.start.displacement, now.start.states
    values = t.values_of(state)
    amounts = t.of_nodes(deformed(t.expansions, t.elastic, u, states).amounts())
    amounts[0, : len(t.nodes)] *= ~np.array([part.name in anew for part in model.parts])[model.part_of[t.nodes]]
    entropies = -t.moduli.slopes(values.temperature, values.share) * amounts
    return HeatOfState(
        contents=t.of_parts(values.content + (values.temperature * entropies).sum(axis=0)),
        capacities=t.of_parts(values.capacity),
        entropy=entropy(t.model, values) + float(entropies.sum()),
        liquid=liquid_volumes(t.model, values),
        rigid=rigid_temperatures(t.model, values),
    )


def with_content(model: Model, unknowns: Array, before: HeatOfState, after: HeatOfState) -> Array:
    """Unknowns (k + r,) of the heat shifted by as much in each solid as keeps its content: the thermal stress of the
    projected strain holds another entropy, which an adiabatic change gives back.
    """
    found = temperature_of(model)
    assert found is not None
    gap = before.contents - after.contents
    shift = np.divide(gap, after.capacities, out=np.zeros_like(gap), where=after.capacities > 0.0)
    out = unknowns.copy()
    nodes = found[1].nodes
    out[: len(nodes)] += shift[model.part_of[nodes]]
    return out


def account_of_heat(
    last: HeatOfSolids | None, before: HeatOfState | None, after: HeatOfState | None, spent: float
) -> HeatOfSolids | None:
    """Account of the heat after a change of the meshes, in which the solids dissipated ``spent`` [J]; None without."""
    if last is None or before is None or after is None:
        return None
    gained = float((after.contents - before.contents).sum())
    return replace(
        last,
        content=last.content + gained,
        received=last.received + gained,
        reversible=last.reversible + gained,
        cold_work=last.cold_work + spent,
        entropy=last.entropy + after.entropy - before.entropy,
        liquid=after.liquid,
        rigid=after.rigid,
    )
