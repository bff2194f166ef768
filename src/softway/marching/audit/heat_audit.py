"""Audit of the heat of solids: content, heat from loads and from the motion, entropy."""

import numpy as np

from softway.heat.coupled.heat_of_solids import HeatOfSolids
from softway.heat.coupled.slab_temperature import HeatOfSlab
from softway.heat.coupled.solid_temperature import temperatures_of
from softway.heat.operators import liquid_volumes, rigid_temperatures
from softway.marching.results.slab_result import SlabResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model

FALL = 1e-9
"""Fall of the entropy in a slab, relative to the entropies that take part, that is an error of the iteration."""


def initial_heat(model: Model, now: ModelState) -> HeatOfSolids | None:
    """Heat at the start; None without temperature."""
    for k, temperature in temperatures_of(model.companions):
        state = now.start.fields[k]
        values = temperature.contents(state.values, temperature.of_bodies(state))
        return HeatOfSolids(
            content=temperature.in_states(now.start.states).content(state, now.start.displacement),
            through=(0.0,) * len(temperature.contacts.contacts),
            liquid=liquid_volumes(temperature.model, values),
            rigid=rigid_temperatures(temperature.model, values),
        )
    return None


def heat_audit(last: HeatOfSolids | None, out: SlabResult) -> HeatOfSolids | None:
    """Heat after a slab, from that before it; None without temperature."""
    if last is None:
        return None
    for solution in out.solution.end.fields:
        found = solution.account
        if not isinstance(found, HeatOfSlab):
            continue
        return HeatOfSolids(
            content=found.content + last.zero,
            brought=last.brought + found.brought,
            received=last.received + found.received,
            cold_work=last.cold_work + found.stored,
            friction=last.friction + found.rubbed,
            reversible=last.reversible + found.reversible,
            through=tuple((np.array(last.through) + found.through).tolist()),
            liquid=found.liquid,
            rigid=found.rigid,
            entropy=last.entropy + found.produced,
            error=last.error + ((found.content + last.zero - last.content) - (found.brought + found.received)),
            zero=last.zero,
            produced=found.produced,
            passed=found.passed,
            rounding=found.rounding,
        )
    return None


def fallen(heat: HeatOfSolids | None) -> str | None:
    """Message on a slab whose entropy falls; None if it does not."""
    if heat is None or heat.produced >= -(FALL * heat.passed + heat.rounding):
        return None
    return f"the entropy falls by {-heat.produced:.3g} J/K of {heat.passed:.3g} J/K: the slab is too long for its heat"
