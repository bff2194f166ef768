"""Thermal expansion on a mesh whose reference is the present shape (docs/theory/bodies/remeshing.md#expansion)."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.material_states import of_region, with_region
from softway.heat.coupled.strain.deformed import deformed
from softway.heat.operators import HeatValues
from softway.marching.remeshing.carried_heat import (
    HeatOfState,
    account_of_heat,
    heat_of,
    strained,
    temperature_of,
    with_content,
)
from softway.marching.state.march_state import EnergyAccount
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.scene import State


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Relieved:
    """What a new reference takes from the energies of the free strain.

    Parameters
    ----------
    energy
        (parts,) energy of the free strain in the strain energy of each solid, which becomes heat [J].
    zero
        What then is missing in the heat content: it is the same at all temperatures [J].
    heat
        Heat of the state without the energy of the free strain; None without temperature.
    """

    energy: Array
    zero: float
    heat: HeatOfState | None

    def booked(self, account: EnergyAccount, after: HeatOfState | None, dissipated: float) -> EnergyAccount:
        """The account with the heat ``after`` the change, and what materials have ``dissipated`` in it [J]."""
        given = float(self.energy.sum())
        heat = account_of_heat(account.heat, self.heat, after, 0.0)
        if heat is not None:
            content, received = heat.content + given, heat.received + given
            reversible, zero = heat.reversible + given, heat.zero + self.zero
            heat = replace(heat, content=content, received=received, reversible=reversible, zero=zero)
        return replace(account, dissipation=account.dissipation + dissipated + given, heat=heat)


def relieved(model: Model, now: ModelState, changed: Collection[str]) -> Relieved:
    """What new references of the solids that have ``changed`` take from the energies of a state on the old meshes."""
    found = temperature_of(model)
    none = np.zeros(len(model.parts))
    if found is None:
        return Relieved(energy=none, zero=0.0, heat=None)
    k, temperature = found
    values = temperature.values_of(now.start.fields[k])
    strain = deformed(temperature.expansions, temperature.elastic, now.start.displacement, now.start.states)
    held, mine = temperature.of_nodes(strain.amounts())[0], [p.name in changed for p in model.parts]
    held[: len(temperature.nodes)] *= np.array(mine)[model.part_of[temperature.nodes]]
    moduli = temperature.moduli
    energy = moduli.potentials(values.temperature, values.share)[0] * held
    entropy = -moduli.slopes(values.temperature, values.share)[0] * held
    zero = float((energy + values.temperature * entropy).sum())
    return Relieved(energy=temperature.of_parts(energy), zero=zero, heat=heat_of(model, now, changed))


def whole_stress(model: Model, now: ModelState, state: State, changed: Collection[str]) -> State:
    """State whose material states have the whole stress: that of the law and that of the free strain."""
    found = temperature_of(model)
    if found is None:
        return state
    k, temperature = found
    return _with_pressure(model, temperature.values_of(now.start.fields[k]), state, changed, 1.0)


def stress_of_laws(model: Model, values: HeatValues, state: State, changed: Collection[str]) -> State:
    """State whose material states have the stress of the law from those with the whole stress, at the heat there."""
    return _with_pressure(model, values, state, changed, -1.0)


def adiabatic(model: Model, unknowns: Array | None, before: Relieved, found: ModelState) -> Array | None:
    """Unknowns (k + r,) of the heat with which a state that was ``found`` has the heat content before: the equilibrium
    of massless nodes has strained it; None where nothing has.
    """
    after = heat_of(model, found)
    if unknowns is None or before.heat is None or after is None or not strained(model):
        return None
    if model.space.greatest(found.start.displacement) == 0.0:
        return None
    return with_content(model, unknowns, before.heat, after)


def _with_pressure(model: Model, values: HeatValues, state: State, changed: Collection[str], sign: float) -> State:
    """State whose stress has the pressure of the free strain taken off, times a ``sign``."""
    found = temperature_of(model)
    assert found is not None
    temperature, memory = found[1], dict(state.memory)
    free = -temperature.on_every(temperature.moduli.potentials(values.temperature, values.share))[0]
    u = model.join(state.displacement)
    for expansion in temperature.expansions:
        if expansion.solid in changed:
            whole, pressure = memory[expansion.solid], expansion.pressures(free, u)[0]
            own = of_region(whole, expansion.region)
            stress = own.stress - (sign * pressure)[:, None, None] * np.eye(3)
            memory[expansion.solid] = with_region(whole, expansion.region, replace(own, stress=stress))
    return replace(state, memory=memory)
