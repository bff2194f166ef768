"""Temperature at the quadrature points of laws that depend on it, from slab to slab.

In a slab such a law has the temperature ``theta + h/2 rate`` of its points, extrapolated to the middle of the slab from
its start and the rate of the slab before; both are in the material state (docs/theory/heat/coupling.md).
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
from softway.laws.law import softens


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
    """

    solid: int
    region: str
    nodes: IntArray
    values: csr_array

    def at(self, temperatures: Array) -> Array:
        """Temperature (p,) at the points from those (n,) of the nodes of all solids [K]."""
        return np.asarray(self.values @ temperatures[self.nodes])


def point_temperatures(number: int, part: DiscreteSolid) -> Iterator[PointTemperature]:
    """Temperatures of the laws of the solid of this ``number`` that depend on it."""
    whole = point_values(part) if any(map(softens, part.materials.laws)) else None
    for region, _, nodes, points, _, law in pieces(part):
        if whole is not None and softens(law):
            values = csr_array(whole[points][:, nodes])
            yield PointTemperature(solid=number, region=region, nodes=nodes + part.nodes.start, values=values)


def starting(
    parts: Sequence[DiscreteSolid], points: Sequence[PointTemperature], temperatures: Array
) -> tuple[DiscreteSolid, ...]:
    """Solids whose material states begin at the temperatures (n,) of the nodes [K]."""
    states = initial_states(parts)
    for point in points:
        found = point.at(temperatures)
        states = _replaced(states, point, found, np.zeros_like(found))
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
        (n,) temperatures of the nodes at the end of the slab and at the start of the next one, which differ where loads
        prescribe a jump [K].
    """
    for point in points:
        before = _own(states, point).temperature
        assert before is not None
        states = _replaced(states, point, point.at(following), (point.at(ends) - before) / span)
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


def _replaced(states: MaterialStates, point: PointTemperature, temperature: Array, warming: Array) -> MaterialStates:
    """States with other temperatures of the points."""
    state, new = states[point.solid], replace(_own(states, point), temperature=temperature, warming=warming)
    assert state is not None
    if point.region:
        new = replace(state, regions={**state.regions, point.region: new})
    return (*states[: point.solid], new, *states[point.solid + 1 :])
