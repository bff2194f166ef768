"""Temperature and moduli at the quadrature points of laws that depend on them, from slab to slab.

In a slab a law that softens has the temperature ``theta + h/2 rate`` of its points, extrapolated to the middle of the
slab from its start and the rate of the slab before; a law whose moduli depend on the temperature has their factor
extrapolated to its end.  Values and rates are in the material state (docs/theory/heat/coupling.md).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import MaterialStates, during, initial_states
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.material_state import MaterialState
from softway.heat.coupled.strain.expansion import pieces, point_values
from softway.heat.heat_balance import put_at_once
from softway.heat.heat_model import HeatModel
from softway.heat.operators import heat_values, unknowns_of
from softway.laws.law import Scalable, softens


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointTemperature:
    """Temperature at the points of the elements of one law.

    Parameters
    ----------
    solid, region
        Number of the solid, and name of its region; empty for a solid of one law.
    nodes
        (k,) their nodes among those of all solids.
    values
        (p, k) functions of heat at the quadrature points.
    softens, scales
        True if the law needs the temperature, and the factor of its moduli.
    """

    solid: int
    region: str
    nodes: IntArray
    values: csr_array
    softens: bool
    scales: bool

    def at(self, values: Array) -> tuple[Array, Array]:
        """Temperature [K] and factor of the moduli (p,) at the points from those (2, n) of the nodes of all solids."""
        return np.asarray(self.values @ values[0][self.nodes]), np.asarray(self.values @ values[1][self.nodes])


def point_temperatures(number: int, part: DiscreteSolid, scales: bool) -> Iterator[PointTemperature]:
    """Temperatures of the laws of the solid of this ``number`` that depend on it, also if it ``scales`` all moduli."""
    if not any(softens(law) or (scales and isinstance(law, Scalable)) for law in part.materials.laws):
        return
    whole = point_values(part)
    for region, _, nodes, points, _, law in pieces(part):
        soft, scaled = softens(law), scales and isinstance(law, Scalable)
        if soft or scaled:
            yield PointTemperature(
                solid=number, region=region, nodes=nodes + part.nodes.start, values=csr_array(whole[points][:, nodes]),
                softens=soft, scales=scaled,
            )  # fmt: skip


def starting(
    parts: Sequence[DiscreteSolid], points: Sequence[PointTemperature], values: Array
) -> tuple[DiscreteSolid, ...]:
    """Solids whose material states begin at temperatures [K] and factors of the moduli (2, n) of the nodes."""
    states = initial_states(parts)
    for point in points:
        temperature, factor = point.at(values)
        state = _own(states, point)
        if point.softens:
            state = replace(state, temperature=temperature, warming=np.zeros_like(temperature))
        if point.scales:
            state = replace(state, stiffness=factor, stiffening=np.zeros_like(factor))
        states = _replaced(states, point, state)
    return during(parts, states, 1.0)


def warmed(
    states: MaterialStates, points: Sequence[PointTemperature], ends: Array, following: Array, span: float
) -> MaterialStates:
    """Material states at the end of a slab of length ``span`` [s], with the temperatures of the next one.

    An infinite length lets the next slab extrapolate nothing.

    Parameters
    ----------
    states
        States with the temperatures at the start of the slab.
    points
        Laws that depend on the temperature.
    ends, following
        (2, n) temperatures [K] and factors of the moduli of the nodes at the end of the slab and at the start of the
        next one, which differ where loads prescribe a jump.
    """
    for point in points:
        state, last, now = _own(states, point), point.at(ends), point.at(following)
        if state.temperature is not None:
            state = replace(state, temperature=now[0], warming=(last[0] - state.temperature) / span)
        if state.stiffness is not None:
            state = replace(state, stiffness=now[1], stiffening=(last[1] - state.stiffness) / span)
        states = _replaced(states, point, state)
    return states


def after_jumps(model: HeatModel, temperatures: Array, time: float) -> Array:
    """Temperatures (k,) of the nodes [K] after the jumps of prescribed ones at a time [s]."""
    if not model.held:
        return temperatures
    return put_at_once(model, heat_values(model, unknowns_of(model, temperatures)), time)[0].temperature


def _own(states: MaterialStates, point: PointTemperature) -> MaterialState:
    """State of the points."""
    state = states[point.solid]
    assert state is not None
    return state.regions[point.region] if point.region else state


def _replaced(states: MaterialStates, point: PointTemperature, new: MaterialState) -> MaterialStates:
    """States with a new one of the points."""
    state = states[point.solid]
    assert state is not None
    if point.region:
        new = replace(state, regions={**state.regions, point.region: new})
    return (*states[: point.solid], new, *states[point.solid + 1 :])
