"""Heat of solids on new meshes of their present shapes (docs/theory/bodies/remeshing.md#heat)."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from softway.adaptivity.unrelated.heat import HeatTransfer, heat_transfer, sampled
from softway.arrays import Array
from softway.heat.coupled.point_temperature import after_jumps
from softway.heat.coupled.solid_temperature import TEMPERATURE
from softway.heat.fronts.carried_contents import with_contents
from softway.heat.heat_model import HeatModel, HeatPart
from softway.heat.operators import HeatValues, heat_values
from softway.laws.heat.heat_content import ContentCurve, content_curve
from softway.marching.remeshing.carried_heat import temperature_of, temperatures_from
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.scene import State


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
    found = [temperature_of(model) for model in models]
    if found[0] is None or found[1] is None:
        return None
    (k, before), (_, after) = found[0], found[1]
    old, new, last = before.model, after.model, before.values_of(now.start.fields[k])
    out: Array = np.empty(new.n_nodes)
    out[new.n_nodes - len(new.lumps) :] = last.unknowns[old.n_nodes - len(old.lumps) :]
    parts, wanted = {part.name: part for part in old.parts}, dict[str, Array]()
    for part in new.parts:
        was = parts[part.name]
        if part.name not in changed:
            out[part.nodes] = last.unknowns[was.nodes]
            continue
        transfer = _transfer(models, now, (was, part))
        near = np.asarray(transfer.near @ last.unknowns[was.nodes])
        if part.law.latent is not None and not part.at_nodes:
            out[part.nodes], wanted[part.name] = near, transfer.capacity * _melting(transfer, part, old, was, last)
        else:
            out[part.nodes] = _unknowns(transfer, part, old, was, last)
    return with_contents(new, out, wanted)


def _transfer(models: tuple[Model, Model], now: ModelState, parts: tuple[HeatPart, HeatPart]) -> HeatTransfer:
    """Transfer of the heat of a solid: of capacities, or of masses where the capacity depends on the temperature."""
    sides, weights = [], []
    for model, heat, at in zip(models, parts, (now.start.displacement, None), strict=True):
        part, found = next(p for p in model.parts if p.name == heat.name), temperature_of(model)
        assert found is not None
        places = part.mesh.points if at is None else part.mesh.points + at[part.nodes]
        sides.append(sampled(part.mesh.blocks, places, part.internal.section))
        of = found[1].model
        weights.append((of.mass if of.capacity is None else of.capacity)[heat.nodes])
    return heat_transfer(sides[0], sides[1], weights[0], weights[1])


def _unknowns(transfer: HeatTransfer, part: HeatPart, old: HeatModel, was: HeatPart, last: HeatValues) -> Array:
    """Unknowns (m,) of a solid without cut cells."""
    values = last.unknowns[was.nodes]
    if old.capacity is not None:
        return transfer.carried(values, float(old.capacity[was.nodes] @ np.log(values)), np.log)
    curve = part.curve
    assert isinstance(curve, ContentCurve)

    def entropy(content: Array) -> Array:
        return curve.entropy(curve.temperature(content)[0])

    contents = values if part.at_nodes else curve.content(values + part.zero)
    found = transfer.carried(contents, float(old.mass[was.nodes] @ entropy(contents)), entropy)
    return found if part.at_nodes else curve.temperature(found)[0] - part.zero


def _melting(transfer: HeatTransfer, part: HeatPart, old: HeatModel, was: HeatPart, last: HeatValues) -> Array:
    """Specific contents (m,) of a solid with cut cells [J/kg], with the latent heat of its nodes."""
    melts = part.law.latent
    assert melts is not None
    curve, mass = content_curve(part.law, latent=True), old.mass[was.nodes]

    def entropy(content: Array) -> Array:
        temperature = curve.temperature(content)[0]
        share = curve.liquid_share(content, temperature)[0]
        return np.asarray(curve.entropy(temperature) + share * melts.heat / melts.melting)

    contents = last.content[was.nodes] / mass
    return transfer.carried(contents, float(mass @ entropy(contents)), entropy)


def warmed_state(model: Model, state: State, unknowns: Array | None, changed: Collection[str]) -> State:
    """State with the temperatures of the unknowns (k + r,), which the laws of the solids that have ``changed`` know at
    their points.
    """
    found, here = temperatures_from(model, unknowns), temperature_of(model)
    if found is None or here is None or unknowns is None:
        return state
    temperature, memory = here[1], dict(state.memory)
    following = after_jumps(temperature.model, heat_values(temperature.model, unknowns), state.time)
    values = temperature.of_points(following)
    for point in temperature.points:
        name = model.parts[point.solid].name
        if name not in changed:
            continue
        own, (kelvin, factor, _) = memory[name], point.at(values)
        if own.temperature is not None:
            own = replace(own, temperature=kelvin)
        if own.stiffness is not None:
            own = replace(own, stiffness=factor)
        memory[name] = own
    return replace(state, memory=memory, fields={**state.fields, TEMPERATURE.name: found})
