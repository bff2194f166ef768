"""Temperature of the solids of a model: a companion field of their displacement (docs/theory/heat/coupling.md)."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.assembled.heated_nodes import HeatedNodes
from softway.bodies.assembled.material_states import MaterialStates, committed, initial_states
from softway.bodies.discretised import DiscreteSolid
from softway.heat.coupled.contact_exchange import ContactExchange
from softway.heat.coupled.dissipation import Dissipation
from softway.heat.coupled.point_temperature import PointTemperature, after_jumps, foreseen, warmed
from softway.heat.coupled.slab_temperature import SlabTemperature, TimeOfSlab, heat_at_rest
from softway.heat.coupled.strain.deformed import added_stress, beside_law, deformed
from softway.heat.coupled.strain.expansion import Expansion
from softway.heat.coupled.strain.moduli import Moduli
from softway.heat.coupled.strain.stored import ElasticTerm
from softway.heat.coupled.through_ties import BreakingGlue, StopLink, StopsWithHeat, exchanges_of, in_stops
from softway.heat.heat_balance import Stage, put_at_once
from softway.heat.heat_model import HeatModel
from softway.heat.heat_slab import is_weak, linear_factor
from softway.heat.loads.heat_plan import knots
from softway.heat.operators import HeatValues, cell_values, heat_values, unknowns_of
from softway.model.field import Field, FieldSlab, FieldSolution, FieldState, StopsInSlab

TEMPERATURE = Field(name="temperature", unit="K", components=1)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SolidTemperature:
    """:class:`~softway.model.field.FieldEquations` of the temperature of solids with heat; zero on all others.

    Parameters
    ----------
    model
        Conduction in the solids with heat, of k nodes, and in r rigid bodies, its last nodes.
    heated
        The k nodes among the n nodes of all solids.
    moduli
        Potentials of the strain of the k + r nodes.
    expansions
        Thermal expansions.
    elastic
        Elements whose moduli depend on the temperature.
    contacts
        Heat across contacts.
    dissipations
        Dissipations of path-dependent materials that heat.
    inert
        True if the solids have inertia.
    points
        Temperatures at the points of laws that depend on them.
    states
        Material states of the solids outside of a slab, see :meth:`in_states`.
    glue
        Ties that break, with the heat that they conduct and dissipate.
    links, stops
        Stops between rigid bodies that pass heat, and what they do in the slab; None outside.
    time
        Slab of a march; None outside.
    """

    model: HeatModel
    heated: HeatedNodes
    moduli: Moduli
    expansions: tuple[Expansion, ...]
    contacts: ContactExchange
    inert: bool
    elastic: tuple[ElasticTerm, ...] = ()
    dissipations: tuple[Dissipation, ...] = ()
    points: tuple[PointTemperature, ...] = ()
    states: MaterialStates = ()
    glue: tuple[BreakingGlue, ...] = ()
    links: tuple[StopLink, ...] = ()
    stops: StopsWithHeat | None = None
    time: TimeOfSlab | None = None

    @property
    def nodes(self) -> IntArray:
        """The nodes (k,) with heat among those of all solids, without hanging ones."""
        return self.heated.number

    @property
    def field(self) -> Field:
        """The temperature."""
        return TEMPERATURE

    def initial(self) -> Array:
        """Initial temperatures (n, 1) [K]."""
        return self.on_all(self.model.initial)

    def in_states(self, states: MaterialStates) -> "SolidTemperature":
        """Equations outside of a slab, of solids in these material states."""
        return replace(self, states=states)

    @property
    def hangs(self) -> bool:
        """True: temperatures of hanging nodes follow."""
        return True

    @property
    def feels_stops(self) -> bool:
        """True if heat passes through stops."""
        return bool(self.links)

    def with_stops(self, stops: StopsInSlab) -> "SolidTemperature":
        """Equations in a slab with these stops."""
        return replace(self, stops=in_stops(self.links, stops, self.model.n_nodes))

    def in_slab(
        self,
        ends: tuple[float, float],
        parts: Sequence[DiscreteSolid],
        u0: Array,
        start: FieldState,
        beside: Mapping[str, Array],
    ) -> "SolidTemperature":
        """Equations in a slab between two times [s]; the first one and those after a sudden change are damped."""
        span = ends[1] - ends[0]
        sudden = ends[0] == 0.0 or ends[0] in knots(self.model)
        factor = linear_factor(self.model, span if sudden and not self.inert else 0.5 * span)
        damped = sudden or (start.abrupt and not is_weak(factor))
        if damped and not sudden and not self.inert:
            factor = linear_factor(self.model, span)
        before, jumped, _ = put_at_once(self.model, self.values_of(start), ends[0])
        strained = deformed(self.expansions, self.elastic, u0, initial_states(parts))
        halves, amounts = damped and self.inert, self.of_nodes(strained.amounts())
        if any(point.expands for point in self.points):
            stage = Stage(start=ends[0], span=span, theta=1.0 if damped else 0.5)
            still = heat_at_rest(self.model, before, stage, halves, factor)
            parts = foreseen(parts, self.points, self.of_points(still), span)
        time = TimeOfSlab(
            start=ends[0], end=ends[1], solids=parts, contacts=self.contacts, damped=damped,
            halves=halves, before=before, jumped=jumped, strained=strained, amounts=amounts, factor=factor,
            damage=beside.get("damage"),
        )  # fmt: skip
        return replace(self, time=time)

    def at(self, values: Array, u: Array, exact: HeatValues | None = None) -> FieldState:
        """State with the temperatures ``values`` (n, 1), of rigid bodies the initial ones, at the displacement ``u``
        (n, d); with ``exact`` ones where more digits are known.
        """
        shape, now = deformed(self.expansions, self.elastic, u, self.states), exact or self.contents(values)
        found = self.moduli.potentials(now.temperature, now.share)
        energy = self.of_parts((beside_law(found) * self.of_nodes(shape.amounts())).sum(axis=0))
        return FieldState(
            values=values, energy=energy, force=shape.force(self.on_every(found), u.shape[1]),
            unknowns=self.kept(now),
        )  # fmt: skip

    def kept(self, now: HeatValues) -> Array:
        """Unknowns that a state keeps beside the temperatures of the nodes; none where these tell all."""
        return np.zeros(0) if self.model.linear and not self.model.lumps else now.unknowns

    def of_bodies(self, state: FieldState) -> dict[str, Array]:
        """Temperatures (1, 1) of the rigid bodies in a state, by name [K]."""
        return {lump.name: state.unknowns[k : k + 1, None] for k, lump in enumerate(self.model.lumps, len(self.nodes))}

    def with_bodies(self, state: FieldState, found: Mapping[str, Array]) -> FieldState:
        """State whose rigid bodies have the temperatures ``found`` (1, 1) by name [K]."""
        if not self.model.lumps:
            return state
        rigid = [float(found[lump.name][0, 0]) for lump in self.model.lumps]
        return replace(state, unknowns=np.concatenate([state.unknowns[: len(self.nodes)], rigid]))

    def stiffness_factor(self, state: FieldState) -> Array | None:
        """Factor (n,) of the stiffness of the nodes; None if the moduli do not depend on the temperature."""
        return self.factor(state.values)[:, 0] if self.elastic else None

    def factor(self, values: Array) -> Array:
        """Factors (n, 1) of the moduli at temperatures ``values`` (n, 1) [K]; one on nodes without."""
        found = self.moduli.factor(values[self.nodes, 0])
        return self.heated.shared(found, 1.0)[:, None]

    def of_points(self, now: HeatValues) -> Array:
        """Temperatures [K], factors of the moduli and free strains (3, n) on all nodes, from those with heat."""
        strain = self.moduli.free.of(now.temperature, now.share)
        factor = self.factor(self.on_all(now.temperature))[:, 0]
        return np.stack([self.heated.shared(now.temperature), factor, self.heated.shared(strain)])

    @property
    def solids(self) -> Sequence[DiscreteSolid] | None:
        """Solids of the slab, whose laws know the temperatures that are foreseen in it; None outside of a slab."""
        return None if self.time is None else self.time.solids

    def solver(self, slab: FieldSlab) -> SlabTemperature:
        """Solver of the temperature at the end of a slab, from the energies (m,) that friction dissipates [J]."""
        assert self.time is not None
        before = initial_states(self.time.solids) if self.dissipations else ()
        historic = self.dissipations or self.elastic or any(it.relieved is not None for it in self.expansions)
        after = committed(self.time.solids, slab.u1) if historic else ()
        end = deformed(self.expansions, self.elastic, slab.u1, after)
        change = self.of_nodes(end.amounts()) - self.time.amounts
        flow = end.strained.flow(self.time.strained.strained, slab.span)
        out, energies = np.zeros((2, self.heated.count))
        for dissipation in self.dissipations:
            energy = dissipation.energy(before, after)
            out[dissipation.nodes] += dissipation.share * energy
            energies[dissipation.nodes] += energy
        spent = self.model.space.total(self.of_nodes(energies)) if self.dissipations else 0.0
        glue = tuple(one.in_slab(self.time.damage, slab.u1) for one in self.glue if self.time.damage is not None)
        out, spent = out + sum(one.heat for one in glue), spent + sum(float(one.heat.sum()) for one in glue)
        return SlabTemperature(
            solids=self, time=self.time, slab=slab, sides=self.time.contacts.sides(slab.contact), end=end,
            change=change, given=self.of_nodes(out), spent=spent, flow=None if flow is None else self.of_nodes(flow),
            glue=exchanges_of(glue, self.stops),
            stopped=np.zeros(self.model.n_nodes) if self.stops is None else self.stops.heat,
        )  # fmt: skip

    def solve(self, slab: FieldSlab) -> FieldSolution:
        """Temperature at the end of a slab without friction, with the energy that it takes from the motion.

        Raises
        ------
        NoConvergence
            If the heats of the nodes cannot be balanced.
        """
        return self.solver(slab)(np.zeros(len(slab.contact.after)))

    def content(self, state: FieldState, u: Array) -> float:
        """Heat content [J] of a state: internal energy less the energy of the field."""
        now = self.contents(state.values, self.of_bodies(state))
        amounts = self.of_nodes(deformed(self.expansions, self.elastic, u, self.states).amounts())
        entropies = -self.moduli.slopes(now.temperature, now.share) * amounts
        return float(now.content.sum() + (now.temperature * entropies).sum())

    def contents(self, values: Array, rigid: Mapping[str, Array] = MappingProxyType({})) -> HeatValues:
        """Temperatures and contents of the nodes with heat at the temperatures ``values`` (n, 1) [K], and of the rigid
        bodies at their own ``rigid`` or initial ones.
        """
        found = self._temperatures(values)
        for k, lump in enumerate(self.model.lumps, len(self.nodes)):
            if lump.name in rigid:
                found[k] = rigid[lump.name][0, 0]
        return heat_values(self.model, unknowns_of(self.model, found), slopes=False)

    def _temperatures(self, values: Array) -> Array:
        """Temperatures (k + r,) from those (n, 1) of all nodes, of the rigid bodies the initial ones [K]."""
        return np.concatenate([values[self.nodes, 0], self.model.initial[len(self.nodes) :]])

    def in_cells(self, solid: str, values: Array) -> dict[str, Array]:
        """Mean heat fluxes (e, 3) [W/m^2] in the cells of a solid, in the axes and per area of the reference state, and
        liquid shares (e,) if it melts, at temperatures (n, 1) [K]; empty without heat.
        """
        return cell_values(self.model, solid, self.contents(values))

    def values_of(self, state: FieldState) -> HeatValues:
        """Temperatures and contents of a state."""
        known = state.unknowns if len(state.unknowns) else unknowns_of(self.model, state.values[self.nodes, 0])
        return heat_values(self.model, known)

    def warmed(self, states: MaterialStates, state: FieldState) -> MaterialStates:
        """Material states at the end of a slab whose laws know the temperatures of the ``state`` there."""
        if not self.points:
            return states
        assert self.time is not None
        last = self.values_of(state)
        following = after_jumps(self.model, last, self.time.end)
        span = self.time.end - self.time.start
        known = np.inf if self.time.start in knots(self.model) else span
        return warmed(states, self.points, self.of_points(last), self.of_points(following), known, span)

    def stress(self, solid: str, cells: int, values: Array, u: Array) -> Array:
        """Mean stress (cells, 3, 3) of a solid [Pa] that the temperature adds to that of the law, with the ``values``
        (n, 1) of all solids [K] at the displacement ``u`` (n, d) [m].
        """
        now = self.contents(values)
        found = self.on_every(self.moduli.potentials(now.temperature, now.share))
        return added_stress((self.expansions, self.elastic), solid, cells, found, u, self.states)

    def of_parts(self, values: Array) -> Array:
        """Sums (parts,) over the nodes of each solid of values (k + r,)."""
        return self.model.space.totals(values)

    def of_nodes(self, values: Array) -> Array:
        """Values (..., k + r) at the nodes with heat from those (..., n) of all nodes; zero of rigid bodies."""
        return self.heated.sums(values)

    def on_all(self, values: Array) -> Array:
        """Values (n, 1) on all nodes from those (k + r,) with heat."""
        return self.heated.temperatures(values)[:, None]

    def on_every(self, potentials: Array) -> Array:
        """Potentials (2, n) on all nodes from those (2, k + r) with heat; on others those of the law."""
        if len(self.nodes) == self.heated.count:
            return potentials[:, : self.heated.count]
        return np.stack([self.heated.shared(potentials[0]), self.heated.shared(potentials[1], 1.0)])


def temperatures_of(companions: Iterable[object]) -> list[tuple[int, SolidTemperature]]:
    """Temperatures among companion fields, with their numbers."""
    return [(k, c) for k, c in enumerate(companions) if isinstance(c, SolidTemperature)]
