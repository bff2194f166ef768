"""Temperature of solids in one slab (time step), with all that does not depend on the heat of friction."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.errors import NoConvergence, NumericsError
from softway.heat.coupled.contact_exchange import ContactExchange
from softway.heat.coupled.contact_sides import ContactSides
from softway.heat.coupled.strain.deformed import Deformed, beside_law
from softway.heat.coupled.strain.moduli import ElasticHeat, Moduli
from softway.heat.heat_balance import Stage
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import HeatModel
from softway.heat.heat_slab import HeatFactor, StageResult, solve_slab
from softway.heat.operators import HeatValues, liquid_volumes, rigid_temperatures
from softway.model.field import FieldSlab, FieldSolution, FieldState


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatOfSlab:
    """Heat of the solids in a slab.

    Parameters
    ----------
    content
        Heat content at the end [J], see :meth:`SolidTemperature.content`.
    brought
        Heat that loads and tools brought, less what they took away [J].
    received
        Heat that the motion gave to the solids [J].
    stored
        Dissipated energy that did not heat: the cold work [J].
    produced, passed, rounding
        Entropy produced, the entropies that took part, and the rounding of the first [J/K].
    rubbed
        Heat of friction in the solids [J].
    through
        (c,) heat that passed each contact from the solid named first [J].
    liquid
        Liquid volume at the end of each solid that melts [m^3].
    rigid
        Temperature at the end of each rigid body that has one [K].
    """

    content: float
    brought: float
    received: float
    stored: float
    produced: float
    passed: float
    rounding: float
    rubbed: float
    through: Array
    liquid: Mapping[str, float]
    rigid: Mapping[str, float]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TimeOfSlab:
    """Slab of a march between two times [s], ``damped`` after a sudden change, in two ``halves``.

    At its start: solids with their material states, contacts with their areas, temperatures ``before``, heats of
    prescribed temperatures that jumped [J], the strain, and the damage of ties that break.  The factor is that of its
    operator without contact and such ties.
    """

    start: float
    end: float
    solids: Sequence[DiscreteSolid]
    contacts: ContactExchange
    damped: bool
    halves: bool
    before: HeatValues
    jumped: Array
    strained: Deformed
    factor: HeatFactor | None
    damage: Array | None = None


def heat_at_rest(
    model: HeatModel, before: HeatValues, stage: Stage, halves: bool, factor: HeatFactor | None
) -> HeatValues:
    """Temperatures at the end of a slab without motion and without contact.

    Raises
    ------
    NoConvergence
        If the heats of the nodes cannot be balanced.
    """
    try:
        return solve_slab(model, before, stage, halves, factor).after
    except NumericsError as error:
        raise NoConvergence(error.what) from None


class HeatedSolids(Protocol):
    """Solids with a temperature, see :class:`~softway.heat.coupled.solid_temperature.SolidTemperature`."""

    @property
    def model(self) -> HeatModel:
        """Conduction."""
        ...

    @property
    def nodes(self) -> IntArray:
        """Nodes (k,) with a temperature."""
        ...

    @property
    def inert(self) -> bool:
        """True if the solids have inertia."""
        ...

    @property
    def moduli(self) -> Moduli:
        """Potentials of the strain of the k nodes and of rigid bodies."""
        ...

    def kept(self, now: HeatValues) -> Array:
        """Unknowns that a state keeps beside the temperatures of the nodes."""
        ...

    def of_parts(self, values: Array) -> Array:
        """Sums (parts,) over the nodes of each solid of values (k + r,)."""
        ...

    def on_all(self, values: Array) -> Array:
        """Values (n, 1) on all nodes from those (k + r,) with heat."""
        ...

    def on_every(self, potentials: Array) -> Array:
        """Potentials (2, n) on all nodes from those (2, k + r) with heat."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabTemperature:
    """Temperature of the solids in a slab, from the energies (m,) that friction dissipates at the contact rows [J].

    Parameters
    ----------
    solids
        Solids with heat.
    time, slab
        The slab at its start, and as the motion has it.
    sides
        Sides of the rows of each contact with heat.
    end
        Strain at the end.
    start, change
        (2, k + r) energies of a free strain of one and elastic energies at the start, and their changes [J]: of the
        nodes with heat, and none of rigid bodies.
    flow
        (3, k + r) energies of the inelastic strain, see :meth:`Strained.flow` [J].
    given, spent
        Heat (k + r,) of the dissipation of the material and of ties that break, and its energy in all [J].
    glue
        Exchange across ties that break.
    """

    solids: HeatedSolids
    time: TimeOfSlab
    slab: FieldSlab
    sides: tuple[ContactSides, ...]
    end: Deformed
    start: Array
    change: Array
    given: Array
    spent: float
    flow: Array
    glue: tuple[HeatExchange, ...] = ()

    def __call__(self, rubbed: Array) -> FieldSolution:
        """Temperature at the end, with the energy that it takes from the motion.

        Raises
        ------
        NoConvergence
            If the heats of the nodes cannot be balanced.
        """
        solids, slab, dim, before = self.solids, self.slab, self.slab.u1.shape[1], self.time.before
        heat, taken = self.time.contacts.spread(rubbed, self.sides)
        result, through = self._solved(heat)
        after, moduli, amounts = result.after, solids.moduli, self.start + self.change
        over = solids.on_every(moduli.between(before, after, result.mean))
        last = moduli.potentials(after.temperature, after.share)
        energy = solids.of_parts((beside_law(last) * amounts).sum(axis=0))
        lost = solids.of_parts(result.work - self.change[1]) - (energy - slab.start.energy)
        mean = slab.first * self.time.strained.force(over, dim) + (1.0 - slab.first) * self.end.force(over, dim)
        entropies = -moduli.slopes(after.temperature, after.share) * amounts
        initial = -moduli.slopes(before.temperature, before.share) * self.start
        rub = float(heat.sum())
        account = HeatOfSlab(
            content=float(after.content.sum() + (after.temperature * entropies).sum()),
            brought=float(self.time.jumped.sum() + result.heats.sum() - through[self.time.contacts.with_tools].sum()),
            received=float(lost.sum() + self.given.sum()) + rub,
            stored=self.spent - float(self.given.sum()),
            produced=float(result.produced.sum()) + result.reservoirs,
            passed=float(result.turned.sum() + np.abs(entropies - initial).sum()),
            rounding=result.rounding / float(after.temperature.min()),
            rubbed=rub,
            through=through + taken,
            liquid=liquid_volumes(solids.model, after),
            rigid=rigid_temperatures(solids.model, after),
        )
        end = FieldState(
            values=solids.on_all(after.temperature), energy=energy,
            force=self.end.force(solids.on_every(last), dim), abrupt=self.time.contacts.change(slab.contact),
            unknowns=solids.kept(after),
        )  # fmt: skip
        flows = solids.of_parts(np.abs(self.flow[1:]).sum(axis=0))
        return FieldSolution(end=end, mean_force=mean, lost=lost, account=account, cancelled=flows)

    def _solved(self, rubbed: Array) -> tuple[StageResult, Array]:
        """Result of a slab with the heat (k + r,) of friction, and the heat (c,) that passed the contacts [J].

        Gaps radiate at the mean temperature of a first solution.
        """
        time, span = self.time, self.slab.span
        strain = ElasticHeat(
            moduli=self.solids.moduli, amounts=self.start, rates=self.change / span,
            flow=self.flow / span if self.flow.any() else None, power=(self.given + rubbed) / span,
            inert=self.solids.inert,
        )  # fmt: skip
        stage = Stage(start=time.start, span=span, theta=1.0 if time.damped else 0.5, strain=strain)
        at, free, guess = time.before.temperature, self.solids.model.free_nodes(), None
        if self.slab.expected is not None and len(self.slab.expected.unknowns):
            guess = self.slab.expected.unknowns
        for _ in range(1 + time.contacts.radiates):
            found, ties = self._exchanges(at), (*self.solids.model.exchanges, *self.glue)
            across = tuple(found.values())
            model = replace(self.solids.model, exchanges=(*ties, *across))
            factor = None if time.factor is None else time.factor.linked((*self.glue, *across), free)
            try:
                with np.errstate(invalid="ignore", over="ignore"):  # moduli at temperatures that are only tried
                    result = solve_slab(model, time.before, stage, time.halves, factor, guess=guess)
            except NumericsError as error:
                raise NoConvergence(error.what) from None
            at = 0.5 * (time.before.temperature + result.after.temperature)
        through = np.zeros(len(self.sides))
        through[list(found)] = result.passed[len(ties) :]
        return result, through

    def _exchanges(self, temperature: Array) -> dict[int, HeatExchange]:
        """Exchange across contacts, with radiation at the ``temperature`` (k + r,) [K]."""
        everywhere, ends = self.solids.on_all(temperature)[:, 0], (self.slab.u0, self.slab.u1)
        rigid = temperature[len(self.solids.nodes) :]
        return self.time.contacts.exchanges(self.slab.contact, ends, self.sides, everywhere, rigid)
