"""Temperature of the solids of a model: a companion field of their displacement (docs/theory/heat/coupling.md)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import MaterialStates
from softway.bodies.discretised import DiscreteSolid
from softway.errors import NoConvergence, NumericsError
from softway.heat.coupled.dissipation import Dissipation
from softway.heat.coupled.expansion import Expansion
from softway.heat.coupled.point_temperature import PointTemperature, after_jumps, warmed
from softway.heat.heat_balance import Stage, StrainHeat, put_at_once
from softway.heat.heat_model import HeatModel
from softway.heat.heat_plan import knots
from softway.heat.heat_slab import HeatFactor, StageResult, linear_factor, solve_slab
from softway.heat.operators import HeatValues, heat_values, unknowns_of
from softway.model.field import Field, FieldSlab, FieldSolution, FieldState

TEMPERATURE = Field(name="temperature", unit="K", components=1)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatOfSlab:
    """Heat of the solids in a slab.

    Parameters
    ----------
    content
        Heat content at the end [J], see :meth:`SolidTemperature.content`.
    brought
        Heat that loads brought, less what they took away [J].
    received
        Heat that the motion gave [J].
    stored
        Dissipated energy that did not heat: the cold work [J].
    produced, passed
        Entropy produced [J/K], and the entropies that took part.
    """

    content: float
    brought: float
    received: float
    stored: float
    produced: float
    passed: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TimeOfSlab:
    """Slab of a march: ends [s], solids with the material states at its start, and the factor of its operator.  It is
    ``damped`` after a sudden change.
    """

    start: float
    end: float
    solids: Sequence[DiscreteSolid]
    damped: bool
    factor: HeatFactor | None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SolidTemperature:
    """:class:`~softway.model.field.FieldEquations` of the temperature of solids with heat; zero on all others.

    Parameters
    ----------
    model
        Conduction in the solids with heat, of k nodes.
    nodes
        (k,) their numbers among the n nodes of all solids.
    count, parts
        Numbers of the nodes n and of the solids.
    part
        (k,) number of the solid of each node.
    reference
        (k,) temperatures without thermal stress [K].
    expansions
        Thermal expansions.
    dissipations
        Dissipations of path-dependent materials that heat.
    softened
        Temperatures at the points of laws that depend on them.
    time
        Slab of a march; None outside.
    """

    model: HeatModel
    nodes: IntArray
    count: int
    parts: int
    part: IntArray
    reference: Array
    expansions: tuple[Expansion, ...]
    dissipations: tuple[Dissipation, ...] = ()
    softened: tuple[PointTemperature, ...] = ()
    time: TimeOfSlab | None = None

    @property
    def field(self) -> Field:
        """The temperature."""
        return TEMPERATURE

    def initial(self) -> Array:
        """Initial temperatures (n, 1) [K]."""
        return self._on_all(self.model.initial)

    def in_slab(self, start: float, end: float, parts: Sequence[DiscreteSolid]) -> "SolidTemperature":
        """Equations in a slab from ``start`` to ``end`` [s]; the first one and those after a knot are damped."""
        span, damped = end - start, start == 0.0 or start in knots(self.model)
        factor = linear_factor(self.model, 0.5 * span)
        return replace(self, time=TimeOfSlab(start=start, end=end, solids=parts, damped=damped, factor=factor))

    def at(self, values: Array, u: Array) -> FieldState:
        """State with the temperatures ``values`` (n, 1) at the displacement ``u`` (n, d)."""
        over = values[self.nodes, 0] - self.reference
        energy = self._of_parts(-over * self.entropy(u))
        return FieldState(values=values, energy=energy, force=self._force(over, u))

    def solve(self, slab: FieldSlab) -> FieldSolution:
        """Temperature at the end of a slab, with the energy that it takes from the motion.

        Raises
        ------
        NoConvergence
            If the heats of the nodes cannot be balanced.
        """
        change = self.entropy(slab.u1) - self.entropy(slab.u0)
        found = self._solved(slab, change)[1]
        end = self.at(self._on_all(found.after.temperature), slab.u1)
        over = found.mean - self.reference
        mean = slab.first * self._force(over, slab.u0) + (1.0 - slab.first) * self._force(over, slab.u1)
        work = self._of_parts(-over * change)
        return FieldSolution(end=end, mean_force=mean, lost=work - (end.energy - slab.start.energy))

    def entropy(self, u: Array) -> Array:
        """Entropy (k,) of the strain at the displacement ``u`` (n, d) [J/K]."""
        out = np.zeros(self.count)
        for expansion in self.expansions:
            out[expansion.nodes] += expansion.entropy(u)
        return out[self.nodes]

    def content(self, values: Array, u: Array) -> float:
        """Heat content [J] of temperatures ``values`` (n, 1): internal energy less the energy of the field."""
        temperature = values[self.nodes, 0]
        of_capacity = heat_values(self.model, unknowns_of(self.model, temperature), slopes=False).content
        return float(of_capacity.sum() + temperature @ self.entropy(u))

    def warmed(self, states: MaterialStates, values: Array) -> MaterialStates:
        """Material states at the end of a slab whose laws know the temperatures ``values`` (n, 1) there."""
        if not self.softened:
            return states
        assert self.time is not None
        following = self._on_all(after_jumps(self.model, values[self.nodes, 0], self.time.end))
        span = np.inf if self.time.start in knots(self.model) else self.time.end - self.time.start
        return warmed(states, self.softened, values[:, 0], following[:, 0], span)

    def heat_of(self, slab: FieldSlab, end: FieldState) -> HeatOfSlab:
        """Heat of a slab that has been solved, with the state at its end."""
        change = self.entropy(slab.u1) - self.entropy(slab.u0)
        jumped, found = self._solved(slab, change)
        work = float(-(found.mean - self.reference) @ change)
        given, spent = self._dissipated(slab.u1)
        return HeatOfSlab(
            content=self.content(end.values, slab.u1),
            brought=float(jumped.sum() + found.heats.sum()),
            received=work - float(end.energy.sum() - slab.start.energy.sum()) + float(given.sum()),
            stored=spent - float(given.sum()),
            produced=float(found.produced.sum()),
            passed=float(found.turned.sum() + np.abs(change).sum()),
        )

    def _solved(self, slab: FieldSlab, change: Array) -> tuple[Array, StageResult]:
        """Heats of prescribed temperatures that jump at the start [J], and the result of a slab."""
        assert self.time is not None
        time, h = self.time, slab.span
        before, jumped, _ = put_at_once(self.model, self._before(slab), time.start)
        strain = StrainHeat(power=self._dissipated(slab.u1)[0] / h, entropy=change / h)
        stage = Stage(start=time.start, span=h, theta=1.0 if time.damped else 0.5, strain=strain)
        try:
            return jumped, solve_slab(self.model, before, stage, time.damped, time.factor)
        except NumericsError as error:
            raise NoConvergence(error.what) from None

    def _dissipated(self, u1: Array) -> tuple[Array, float]:
        """Heat (k,) of the dissipation in a slab, and the energy that it takes in all [J]."""
        assert self.time is not None
        out, spent = np.zeros(self.count), 0.0
        for dissipation in self.dissipations:
            energy = dissipation.energy(self.time.solids, u1)
            out[dissipation.nodes] += dissipation.share * energy
            spent += float(energy.sum())
        return out[self.nodes], spent

    def _before(self, slab: FieldSlab) -> HeatValues:
        """Temperatures and contents at the start of a slab."""
        return heat_values(self.model, unknowns_of(self.model, slab.start.values[self.nodes, 0]))

    def _force(self, over: Array, u: Array) -> Array:
        """Forces (n, d) [N] of temperatures ``over`` (k,) the reference [K] at ``u`` (n, d)."""
        out, whole = np.zeros_like(u), self._on_all(over)[:, 0]
        for expansion in self.expansions:
            out[expansion.nodes] += expansion.force(whole[expansion.nodes], u)
        return out

    def _of_parts(self, values: Array) -> Array:
        """Sums (parts,) over the nodes of each solid of values (k,)."""
        return np.asarray(np.bincount(self.part, weights=values, minlength=self.parts), float)

    def _on_all(self, values: Array) -> Array:
        """Values (n, 1) on all nodes from those (k,) with heat."""
        out = np.zeros((self.count, 1))
        out[self.nodes, 0] = values
        return out


def temperatures_of(companions: Iterable[object]) -> list[tuple[int, SolidTemperature]]:
    """Temperatures among companion fields, with their numbers."""
    return [(k, c) for k, c in enumerate(companions) if isinstance(c, SolidTemperature)]
