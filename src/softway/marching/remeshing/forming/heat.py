"""Heat of solids on new meshes of their present shapes (docs/theory/bodies/remeshing.md#heat)."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.adaptivity.unrelated.heat import HeatTransfer, heat_transfer, sampled
from softway.arrays import Array
from softway.heat.coupled.point_temperature import after_jumps
from softway.heat.coupled.solid_temperature import TEMPERATURE
from softway.heat.fronts.carried_contents import with_contents
from softway.heat.heat_model import HeatModel, HeatPart
from softway.heat.operators import HeatValues, entropy, heat_values
from softway.laws.heat.heat_content import ContentCurve, content_curve
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

    transfer: HeatTransfer
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
        own, (kelvin, factor, _) = memory[name], point.at(points)
        if own.temperature is not None:
            own = replace(own, temperature=kelvin)
        if own.stiffness is not None:
            own = replace(own, stiffness=factor)
        memory[name] = own
    return replace(state, memory=memory, fields={**state.fields, TEMPERATURE.name: found})
