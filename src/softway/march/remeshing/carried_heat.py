"""Temperature of solids on other meshes, and its account."""

from collections.abc import Callable, Mapping
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
from softway.heat.heat_model import HeatModel, HeatPart
from softway.heat.operators import entropy, liquid_volumes, rigid_temperatures
from softway.laws.heat.heat_content import ContentCurve
from softway.laws.heat.temperature_table import value_at
from softway.march.state.model_state import ModelState
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
    if found is None:
        return True
    heat = found[1].model
    parts = [part for part in heat.parts if part.name == name]
    return all(part.law.latent is None and _curve(heat, part) is not False for part in parts)


def _curve(heat: HeatModel, part: HeatPart) -> ContentCurve | None | bool:
    """Content of the nodes of a part; None if it is linear, False if several curves meet there."""
    if heat.capacity is not None:
        return None
    return part.curve if isinstance(part.curve, ContentCurve) else False


def carried_temperatures(
    models: tuple[Model, Model],
    pairs: Mapping[str, tuple[AdaptedSolid, AdaptedSolid]],
    at_nodes: Mapping[str, sp.csr_array],
    values: Mapping[str, Array],
) -> dict[str, Array]:
    """Temperatures (m, 1) of the solids on new meshes, from those (n, 1) on the old ones [K], with the values (m, n) at
    the new nodes of fields on the old ones for those whose mesh changes; others stay.
    """
    out = dict(values)
    heats = [found[1].model for model in models if (found := temperature_of(model)) is not None]
    for name, near in at_nodes.items():
        parts = [next((p for p in heat.parts if p.name == name), None) for heat in heats]
        if not parts or any(part is None for part in parts):
            out[name] = np.zeros((near.shape[0], 1))
            continue
        one, other = (
            _heated(on, heat, part)
            for on, heat, part in zip(pairs[name], heats, parts, strict=True)
            if part is not None
        )
        to, back, rule = _measures(heats[0], parts[0])
        found_values = carried_heat(one, other, near, to(values[name][:, 0]), rule)
        out[name] = back(found_values)[:, None]
    return out


Measure = Callable[[Array], Array]


def _measures(heat: HeatModel, part: HeatPart | None) -> tuple[Measure, Measure, Measure]:
    """What passes over of the temperatures [K], the temperature of it, and its entropy per capacity."""
    curve = None if part is None else _curve(heat, part)
    if not isinstance(curve, ContentCurve):
        return np.array, np.array, np.log
    return curve.content, lambda h: curve.temperature(h)[0], lambda h: curve.entropy(curve.temperature(h)[0])


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


def heat_of(model: Model, now: ModelState) -> HeatOfState | None:
    """Heat of a state; None without."""
    found = temperature_of(model)
    if found is None:
        return None
    k, t = found
    state, u, states = now.start.fields[k], now.start.displacement, now.start.states
    values = t.contents(state.values, t.of_bodies(state))
    amounts = t.of_nodes(deformed(t.expansions, t.elastic, u, states).amounts())
    entropies = -t.moduli.slopes(values.temperature, values.share) * amounts
    return HeatOfState(
        contents=t.of_parts(values.content + (values.temperature * entropies).sum(axis=0)),
        capacities=t.of_parts(values.capacity),
        entropy=entropy(t.model, values) + float(entropies.sum()),
        liquid=liquid_volumes(t.model, values),
        rigid=rigid_temperatures(t.model, values),
    )


def with_content(
    model: Model, values: Mapping[str, Array], before: HeatOfState, after: HeatOfState
) -> dict[str, Array]:
    """Temperatures of the solids shifted by as much in each one as keeps its content [K]: the thermal stress of the
    projected strain holds another entropy, which an adiabatic change gives back.
    """
    gap = before.contents - after.contents
    shift = np.divide(gap, after.capacities, out=np.zeros_like(gap), where=after.capacities > 0.0)
    shifted = {part.name: values[part.name] + change for part, change in zip(model.parts, shift, strict=True)}
    return {**values, **shifted}


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
