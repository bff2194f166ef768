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
from softway.heat.coupled.expansion import Strained
from softway.heat.coupled.free_strain import FreeStrain
from softway.heat.heat_balance import Stage, StrainHeat, arithmetic_mean, logarithmic_mean
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import HeatModel
from softway.heat.heat_slab import HeatFactor, StageResult, solve_slab
from softway.heat.operators import HeatValues, liquid_volumes
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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TimeOfSlab:
    """Slab of a march between two times [s], ``damped`` after a sudden change, in two ``halves``.

    At its start: solids with their material states, contacts with their areas, temperatures ``before``, heats of
    prescribed temperatures that jumped [J], and the strain.  The factor is that of its operator without contact.
    """

    start: float
    end: float
    solids: Sequence[DiscreteSolid]
    contacts: ContactExchange
    damped: bool
    halves: bool
    before: HeatValues
    jumped: Array
    strained: Strained
    factor: HeatFactor | None


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
    def free(self) -> FreeStrain:
        """Free strain of the nodes."""
        ...

    def of_parts(self, values: Array) -> Array:
        """Sums (parts,) over the nodes of each solid of values (k,)."""
        ...

    def on_all(self, values: Array) -> Array:
        """Values (n, 1) on all nodes from those (k,) with heat."""
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
    held
        (k,) energies that free strains of one would take from the strain, at both ends [J].
    given, spent
        Heat (k,) of the dissipation of the material, and its energy in all [J].
    """

    solids: HeatedSolids
    time: TimeOfSlab
    slab: FieldSlab
    sides: tuple[ContactSides, ...]
    end: Strained
    held: tuple[Array, Array]
    given: Array
    spent: float

    def __call__(self, rubbed: Array) -> FieldSolution:
        """Temperature at the end, with the energy that it takes from the motion.

        Raises
        ------
        NoConvergence
            If the heats of the nodes cannot be balanced.
        """
        solids, slab, dim = self.solids, self.slab, self.slab.u1.shape[1]
        heat, taken = self.time.contacts.spread(rubbed, self.sides)
        result, through = self._solved(heat)
        (before, held), after, free = self.held, result.after, solids.free
        meanwhile = free.of(result.mean, 0.5 * (self.time.before.share + after.share))
        last = free.of(after.temperature, after.share)
        energy = solids.of_parts(-last * held)
        lost = solids.of_parts(-meanwhile * (held - before)) - (energy - slab.start.energy)
        both = solids.on_all(meanwhile)[:, 0]
        mean = slab.first * self.time.strained.force(both, dim) + (1.0 - slab.first) * self.end.force(both, dim)
        rub = float(heat.sum())
        account = HeatOfSlab(
            content=float(after.content.sum() + (free.coefficient * after.temperature) @ held),
            brought=float(self.time.jumped.sum() + result.heats.sum() - through[self.time.contacts.with_tools].sum()),
            received=float(lost.sum() + self.given.sum()) + rub,
            stored=self.spent - float(self.given.sum()),
            produced=float(result.produced.sum()) + result.reservoirs,
            passed=float(result.turned.sum() + np.abs(free.coefficient * (held - before)).sum()),
            rounding=result.rounding / float(after.temperature.min()),
            rubbed=rub,
            through=through + taken,
            liquid=liquid_volumes(solids.model, after),
        )
        end = FieldState(
            values=solids.on_all(after.temperature), energy=energy,
            force=self.end.force(solids.on_all(last)[:, 0], dim),
            abrupt=self.time.contacts.change(slab.contact),
            unknowns=np.zeros(0) if solids.model.linear else after.unknowns,
        )  # fmt: skip
        return FieldSolution(end=end, mean_force=mean, lost=lost, account=account)

    def _solved(self, rubbed: Array) -> tuple[StageResult, Array]:
        """Result of a slab with the heat (k,) of friction, and the heat (c,) that passed the contacts [J].

        Gaps radiate at the mean temperature of a first solution.
        """
        time, span, (before, held), free = self.time, self.slab.span, self.held, self.solids.free
        mean = logarithmic_mean if self.solids.inert else arithmetic_mean
        strain = StrainHeat(
            power=(self.given + rubbed) / span, entropy=free.coefficient * (held - before) / span,
            freezing=free.melting * 0.5 * (before + held), mean=mean,
        )  # fmt: skip
        stage = Stage(start=time.start, span=span, theta=1.0 if time.damped else 0.5, strain=strain)
        at, loose, guess = time.before.temperature, self.solids.model.free_nodes(), None
        if self.slab.expected is not None and len(self.slab.expected.unknowns):
            guess = self.slab.expected.unknowns
        for _ in range(1 + time.contacts.radiates):
            found, ties = self._exchanges(at), self.solids.model.exchanges
            across = tuple(found.values())
            model = replace(self.solids.model, exchanges=(*ties, *across))
            factor = None if time.factor is None else time.factor.linked(across, loose)
            try:
                result = solve_slab(model, time.before, stage, time.halves, factor, guess=guess)
            except NumericsError as error:
                raise NoConvergence(error.what) from None
            at = 0.5 * (time.before.temperature + result.after.temperature)
        through = np.zeros(len(self.sides))
        through[list(found)] = result.passed[len(ties) :]
        return result, through

    def _exchanges(self, temperature: Array) -> dict[int, HeatExchange]:
        """Exchange across contacts, with radiation at the ``temperature`` (k,) [K]."""
        everywhere, ends = self.solids.on_all(temperature)[:, 0], (self.slab.u0, self.slab.u1)
        return self.time.contacts.exchanges(self.slab.contact, ends, self.sides, everywhere)
