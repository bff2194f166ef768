"""Temperature and moduli at the quadrature points of laws that depend on them, from slab to slab.

In a slab a law that softens has the temperature ``theta + h/2 rate`` of its points, extrapolated to the middle of the
slab from its start and the rate of the slab before; a law whose moduli depend on the temperature has their factor
extrapolated to its end.  A law with a history in a body with free faces knows the free strain at its end as it is
foreseen from the start: that of the heat without motion, and with the rate of what was not foreseen in the slab before.
Values and rates are in the material state (docs/theory/heat/coupling.md).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import (
    MaterialStates,
    during,
    initial_states,
    own_state,
    with_own_state,
)
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import free_axes
from softway.heat.coupled.strain.expansion import pieces, point_values
from softway.heat.heat_balance import put_at_once
from softway.heat.heat_model import HeatModel
from softway.heat.operators import HeatValues
from softway.laws.law import RateLaw, Scalable, softens


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
    softens, scales, expands
        True if the law needs the temperature, the factor of its moduli, and the free strain.
    """

    solid: int
    region: str
    nodes: IntArray
    values: csr_array
    softens: bool
    scales: bool
    expands: bool

    def at(self, values: Array) -> tuple[Array, Array, Array]:
        """Temperature [K], factor of the moduli and free strain (p,) at the points, from those (3, n) of all nodes."""
        one, two, three = (np.asarray(self.values @ v[self.nodes]) for v in values)
        return one, two, three


def point_temperatures(number: int, part: DiscreteSolid, scales: bool, expands: bool) -> Iterator[PointTemperature]:
    """Temperatures of the laws of the solid of this ``number`` that depend on it, also if it ``scales`` all moduli or
    ``expands``.
    """
    free = expands and bool(free_axes(part.internal.section))
    if not any(softens(law) or (scales or free) and isinstance(law, RateLaw) for law in part.materials.laws):
        return
    whole = point_values(part)
    for region, _, nodes, points, _, law in pieces(part):
        soft, scaled, known = softens(law), scales and isinstance(law, Scalable), free and isinstance(law, RateLaw)
        if soft or scaled or known:
            yield PointTemperature(
                solid=number, region=region, nodes=nodes + part.nodes.start, values=csr_array(whole[points][:, nodes]),
                softens=soft, scales=scaled, expands=known,
            )  # fmt: skip


def starting(
    parts: Sequence[DiscreteSolid], points: Sequence[PointTemperature], values: Array
) -> tuple[DiscreteSolid, ...]:
    """Solids whose material states begin at temperatures [K], factors of the moduli and free strains (3, n) of the
    nodes; the laws reach these strains with the initial displacement.
    """
    states = initial_states(parts)
    for point in points:
        temperature, factor, strain = point.at(values)
        state = own_state(states, point.solid, point.region)
        if point.softens:
            state = replace(state, temperature=temperature, warming=np.zeros_like(temperature))
        if point.scales:
            state = replace(state, stiffness=factor, stiffening=np.zeros_like(factor))
        if point.expands:
            none = np.zeros_like(strain)
            state = replace(state, eigenstrain=none, coming_eigenstrain=strain, unforeseen=none)
        states = with_own_state(states, point.solid, point.region, state)
    return during(parts, states, 1.0)


def foreseen(
    parts: Sequence[DiscreteSolid], points: Sequence[PointTemperature], values: Array, span: float
) -> tuple[DiscreteSolid, ...]:
    """Solids in a slab of length ``span`` [s] whose laws know the free strains at its end, of nodes (3, n) that heat
    without motion foresees.
    """
    states = initial_states(parts)
    for point in points:
        state = own_state(states, point.solid, point.region)
        if state.unforeseen is not None:
            coming = point.at(values)[2] + span * state.unforeseen
            state = replace(state, coming_eigenstrain=coming)
            states = with_own_state(states, point.solid, point.region, state)
    return during(parts, states, span)


def warmed(
    states: MaterialStates, points: Sequence[PointTemperature], ends: Array, following: Array, span: float, whole: float
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
        (3, n) temperatures [K], factors of the moduli and free strains of the nodes at the end of the slab and at the
        start of the next one, which differ where loads prescribe a jump.
    whole
        Length of the slab [s], also where nothing is extrapolated.
    """
    for point in points:
        state = own_state(states, point.solid, point.region)
        last, now = point.at(ends), point.at(following)
        if state.temperature is not None:
            state = replace(state, temperature=now[0], warming=(last[0] - state.temperature) / span)
        if state.stiffness is not None:
            state = replace(state, stiffness=now[1], stiffening=(last[1] - state.stiffness) / span)
        if state.eigenstrain is not None and state.unforeseen is not None:
            missed = state.unforeseen + (last[2] - state.eigenstrain) / whole
            state = replace(state, coming_eigenstrain=now[2], unforeseen=missed)
        states = with_own_state(states, point.solid, point.region, state)
    return states


def after_jumps(model: HeatModel, before: HeatValues, time: float) -> HeatValues:
    """Temperatures of the nodes after the jumps of prescribed ones at a time [s]."""
    return put_at_once(model, before, time)[0] if model.held else before
