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
from softway.heat.coupled.strain.weak_heat import balanced_heats
from softway.heat.heat_balance import Stage, rounding
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import HeatModel
from softway.heat.heat_slab import HeatFactor, StageResult, is_weak, result_of, solve_slab
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
    received, reversible
        Heat that the motion gave to the solids, and the part of it that nothing dissipated [J].
    stored
        Dissipated energy that did not heat: the cold work [J].
    produced, passed, rounding
        Entropy produced, the entropies that took part, and the rounding of the first [J/K].
    rubbed
        Heat of friction in solids and rigid bodies, and of the impacts of these [J].
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
    reversible: float
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

    At its start: solids with their material states, contacts, temperatures ``before``, heats of
    prescribed temperatures that jumped [J], the strain with its ``amounts`` (2, k + r) [J], see
    :class:`SlabTemperature`, and the damage of ties that break.  The factor is that of its operator without contact and
    such ties.
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
    amounts: Array
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
    return _solved(model, before, stage, halves, factor).after


def _solved(
    model: HeatModel, before: HeatValues, stage: Stage, halves: bool, factor: HeatFactor | None,
    guess: Array | None = None,
) -> StageResult:  # fmt: skip
    """Result of a slab, whose failure is one of the slab and not of the march."""
    try:
        return solve_slab(model, before, stage, halves, factor, guess=guess)
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
    change
        (2, k + r) changes of the energies of a free strain of one and of the elastic energies [J]: of the nodes with
        heat, and none of rigid bodies.
    flow
        (3, k + r) energies of the inelastic strain, see :meth:`Strained.flow` [J]; None without.
    given, spent
        Heat (k + r,) of the dissipation of the material and of ties that break, and its energy in all [J].
    stopped
        Heat (k + r,) of what stops dissipate [J].
    glue
        Exchange across ties that break, and through stops.
    """

    solids: HeatedSolids
    time: TimeOfSlab
    slab: FieldSlab
    sides: tuple[ContactSides, ...]
    end: Deformed
    change: Array
    given: Array
    spent: float
    stopped: Array
    flow: Array | None = None
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
        heat = heat + self.stopped
        result, through = self._solved(heat)
        after, moduli, amounts = result.after, solids.moduli, self.time.amounts + self.change
        over = solids.on_every(moduli.between(before, after, result.mean))
        last = moduli.potentials(after.temperature, after.share)
        energy = solids.of_parts((beside_law(last) * amounts).sum(axis=0))
        lost = solids.of_parts(result.work - self.change[1]) - (energy - slab.start.energy)
        mean, force = self.end.forces(np.stack([over, solids.on_every(last)]), dim)
        mean = slab.first * self.time.strained.force(over, dim) + (1.0 - slab.first) * mean
        entropies = -moduli.slopes(after.temperature, after.share) * amounts
        initial = -moduli.slopes(before.temperature, before.share) * self.time.amounts
        turned = result.turned + np.abs(entropies - initial).sum(axis=0)
        contents = after.content + after.temperature * entropies.sum(axis=0)
        columns = np.stack([heat, contents, self.given, result.produced, turned], axis=1)
        rub, content, given, produced, passed = solids.model.space.sums(columns).tolist()
        gained = self.time.contacts.entropy_of_tools(taken)
        account = HeatOfSlab(
            content=content,
            brought=float(self.time.jumped.sum() + result.heats.sum() - through[self.time.contacts.with_tools].sum()),
            received=float(lost.sum()) + given + rub,
            reversible=float(lost.sum()),
            stored=self.spent - given,
            produced=produced + result.reservoirs + gained,
            passed=passed + gained,
            rounding=result.rounding / solids.model.space.least(after.temperature),
            rubbed=rub,
            through=through + taken,
            liquid=liquid_volumes(solids.model, after),
            rigid=rigid_temperatures(solids.model, after),
        )
        end = FieldState(
            values=solids.on_all(after.temperature), energy=energy,
            force=force, abrupt=self.time.contacts.change(slab.contact),
            unknowns=solids.kept(after),
        )  # fmt: skip
        flows = 0.0 if self.flow is None else solids.of_parts(np.abs(self.flow[1:]).sum(axis=0))
        return FieldSolution(end=end, mean_force=mean, lost=lost, account=account, cancelled=flows)

    def _solved(self, rubbed: Array) -> tuple[StageResult, Array]:
        """Result of a slab with the heat (k + r,) of friction, and the heat (c,) that passed the contacts [J].

        Gaps radiate at the mean temperature of a first solution.
        """
        time, span = self.time, self.slab.span
        strain = ElasticHeat(
            moduli=self.solids.moduli, amounts=self.time.amounts, rates=self.change / span,
            flow=None if self.flow is None else self.flow / span, power=(self.given + rubbed) / span,
            inert=self.solids.inert,
        )  # fmt: skip
        stage = Stage(start=time.start, span=span, theta=1.0 if time.damped else 0.5, strain=strain)
        at, free, guess = time.before.temperature, self.solids.model.free_nodes(), self._expected()
        for _ in range(1 + time.contacts.radiates):
            found, ties = self._exchanges(at), (*self.solids.model.exchanges, *self.glue)
            across = tuple(found.values())
            model = replace(self.solids.model, exchanges=(*ties, *across))
            factor = None if time.factor is None else time.factor.linked((*self.glue, *across), free)
            result = self._balanced(model, stage, strain, factor, guess)
            at = 0.5 * (time.before.temperature + result.after.temperature)
        through = np.zeros(len(self.sides))
        through[list(found)] = result.passed[len(ties) :]
        return result, through

    def _balanced(
        self, model: HeatModel, stage: Stage, strain: ElasticHeat, factor: HeatFactor | None, guess: Array | None
    ) -> StageResult:
        """Result of a slab: by a kernel where it has one stage in which hardly any heat flows from node to node."""
        before, halves = self.time.before, self.time.halves
        if model.whole and is_weak(factor) and not (halves or strain.moduli.curves or strain.flow is not None):
            floor = rounding(model, before, stage)
            found = balanced_heats(model, before, stage, strain, before.unknowns if guess is None else guess, floor)
            if found is not None:
                return result_of(model, before, stage, found, 1, factor, floor)
        with np.errstate(invalid="ignore", over="ignore"):  # moduli at temperatures that are only tried
            return _solved(model, before, stage, halves, factor, guess)

    def _expected(self) -> Array | None:
        """Unknowns (k + r,) of the iterate before; None at the first one."""
        then = self.slab.expected
        if then is None:
            return None
        return then.unknowns if len(then.unknowns) else then.values[self.solids.nodes, 0]

    def _exchanges(self, temperature: Array) -> dict[int, HeatExchange]:
        """Exchange across contacts, with radiation at the ``temperature`` (k + r,) [K]."""
        everywhere, ends = self.solids.on_all(temperature)[:, 0], (self.slab.u0, self.slab.u1)
        rigid = temperature[len(self.solids.nodes) :]
        return self.time.contacts.exchanges(self.slab.contact, ends, self.sides, everywhere, rigid)
