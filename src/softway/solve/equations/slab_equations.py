"""Equations of one slab (time step): momentum of the nodes with inertia, equilibrium of the massless nodes.

    M (q - v0 - J) + h (f_mean + a (f1 - f0) - load) - known impulses = G^T p        nodes with inertia
    h mu2 (f1 - load) = G^T p                                                        massless nodes

They are composed of three parts: the mean force ``f_mean``, averaged by the virtual time function or along the chord
(``mean_force.py``); its closure, by default with the scalar ``a`` that closes the energy balance (``closure.py``); and
the contact rows G with their conditions (``slab_contact.py``).  ``J`` are the unbalanced jumps of the Paper rule.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.assembled.dashpots import Dashpots
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.trajectory import Trajectory
from softway.model.field import FieldContact, FieldSlab, FieldSolution, FieldState, RubbedField
from softway.model.model import Model
from softway.model.time_weight import TimeWeight, moments
from softway.solve.constraints.compliance import FrozenOperator, RowBasis, row_basis
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.constraints.row_basis import RowCoefficients
from softway.solve.effort import Effort
from softway.solve.equations.closure import Closure, Unclosed
from softway.solve.equations.end_forces import EndForces
from softway.solve.equations.energy_balance import EnergyClosure, body_groups
from softway.solve.equations.follower import Follower
from softway.solve.equations.friction_work import row_heats
from softway.solve.equations.mean_force import MeanForce, end_of_slab, first_weight, passed_on
from softway.solve.equations.slab_contact import SlabContact
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.equations.slab_values import Evaluation, SlabStart
from softway.tolerances import KEEP_EDGES_AFTER, KEEP_FACETS_AFTER


def _cold(solution: FieldSolution) -> Callable[[Array], FieldSolution]:
    """Solver of a field that friction does not heat."""
    return lambda rubbed: solution


FIELD_PASSES = 8
"""Greatest number of solutions of the companion fields at an iterate with friction."""
SETTLED = 1e-14
"""Change of the scalar below which the heat of friction does not change."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabEquations:
    """Residual, operator and contact rows of one slab.

    Parameters
    ----------
    model, start, weight, path
        Model, values at t0, virtual time function, and trajectory of the nodes.
    average
        Average of the internal force over the slab.
    closure
        Completion of the mean force that closes the energy balance.
    contact
        Contact rows with their conditions.
    given
        (n, d) values of q on supported components.
    unbalanced
        (n, d) velocity jumps excluded from the momentum equation.
    impulses
        (n, d) known contact impulses [N s].
    effort
        Counted work of the attempt at the slab.
    positive_definite
        True if the operator has to be positive definite.
    follower
        Supports whose motion follows from the forces on them; None without.
    dashpots
        Dashpots at massless nodes that have no equilibrium; None without.
    """

    model: Model
    start: SlabStart
    weight: TimeWeight
    path: Trajectory
    average: MeanForce
    contact: SlabContact
    closure: Closure = Unclosed()
    given: Array | float = 0.0
    unbalanced: Array | float = 0.0
    impulses: Array | float = 0.0
    effort: Effort = field(default_factory=Effort)
    positive_definite: bool = False
    follower: Follower | None = None
    dashpots: Dashpots | None = None

    def evaluate(self, q: Array, impulse: Array, last: Evaluation | None = None) -> Evaluation:
        """Evaluate the residual and its ingredients at q (n, d) with the contact impulses (m,) [N s].

        In an iteration friction heats as with the scalar of the iterate before, the ``last`` one, and companion fields
        begin with its values.
        """
        model, start, h = self.model, self.start, self.path.span
        u1 = self.path.end(q)
        end = end_of_slab(model, u1)
        energy, force = end.energy, end.force
        mean = self.average.mean(model, start, self.path, q, end)
        viscous = None if end.viscous is None else passed_on(model, end.viscous)
        lost: Array = np.zeros(len(energy))
        shock = model.shock_force(0.5 * (start.displacement + u1), u1 - start.displacement, h)
        if shock is not None:
            mean, lost = mean + shock, model.space.totals(shock * (u1 - start.displacement))
        if self.dashpots is not None:
            pull = self.dashpots.force(u1 - start.displacement, h)
            mean, force = mean + pull, force + pull
        rows = self.contact.at(u1)
        ends = self._ends(u1, (force, mean, viscous), energy + lost, rows, impulse)
        coupled, completed = self._completed(ends, last)
        for found in coupled:
            energy, force, lost = energy + found.end.energy, force + found.end.force, lost + found.lost
        residual = model.mass @ (q - start.velocity - self.unbalanced)
        residual += h * (completed.mean - model.load) - self.impulses
        still = np.flatnonzero(~model.massive)
        residual[still] = h * moments(self.weight)[1] * (force[still] - model.load[still])
        return Evaluation(
            residual=model.space.filled(residual),
            displacement=u1,
            force=force,
            energy=energy,
            mean_force=completed.mean,
            scalar=completed.scalar,
            missing_work=completed.missing_work,
            clipped=completed.clipped,
            bounded=completed.bounded,
            rows=rows,
            lost=lost + completed.lost,
            fields=coupled,
        )

    def _completed(self, bare: EndForces, last: Evaluation | None) -> tuple[tuple[FieldSolution, ...], EnergyClosure]:
        """Companion fields and closure of a slab, from the values at its ends without these fields.

        The heat of friction depends on the scalar (parts,) that closes the balance, and that hardly on the heat: it is
        that of the ``last`` iterate, or found by iteration.
        """
        if not self.model.companions:
            return (), self.closure.close(self.model, bare)
        scalar: Array = np.zeros(len(self.model.parts)) if last is None else last.scalar
        solvers, rubbed = self._field_solvers(bare, last), self._rubbed(bare, scalar)
        for _ in range(FIELD_PASSES):
            coupled = tuple(solve(rubbed) for solve in solvers)
            completed = self.closure.close(self.model, self._joined(bare, coupled))
            settled = last is not None or np.abs(completed.scalar - scalar).max() <= SETTLED
            if settled or not bare.rubs:
                break
            scalar = completed.scalar
            rubbed = self._rubbed(bare, scalar)
        return coupled, completed

    def _field_solvers(self, ends: EndForces, last: Evaluation | None) -> list[Callable[[Array], FieldSolution]]:
        """Solvers of the companion fields for the displacement at the end, from the energies (m,) of friction [J]."""
        start, span, first = self.start, self.path.span, first_weight(self.weight)
        contact = FieldContact(first=ends.rows0, last=ends.rows1, before=ends.force0, after=ends.force1)
        found: list[Callable[[Array], FieldSolution]] = []
        expected = (None,) * len(start.fields) if last is None else tuple(f.end for f in last.fields)
        for c, state, then in zip(self.model.companions, start.fields, expected, strict=True):
            slab = FieldSlab(
                span=span, start=state, u0=ends.u0, u1=ends.u1, contact=contact, first=first, expected=then
            )
            found.append(c.solver(slab) if isinstance(c, RubbedField) else _cold(c.solve(slab)))
        return found

    def _rubbed(self, ends: EndForces, scalar: Array) -> Array:
        """Energy (m,) that friction forces with the ``scalar`` (parts,) dissipate at the rows [J]."""
        model, (first, last) = self.model, (ends.rows0, ends.rows1)
        if not ends.rubs:
            return np.zeros(len(last.node))
        part = model.part_of[last.node]
        group = body_groups(model, (first, ends.force0 > 0.0), (last, ends.force1 > 0.0))[part]
        a = scalar[part][:, None]
        weighted = ((first, (0.5 - a) * ends.shear0), (last, (0.5 + a) * ends.shear1))
        return row_heats(weighted, ends.u1 - ends.u0, group)

    def _joined(self, bare: EndForces, coupled: tuple[FieldSolution, ...]) -> EndForces:
        """Values at the ends with companion fields."""
        energy, force, mean = bare.V1, bare.f1, bare.mean
        for start, found in zip(self.start.fields, coupled, strict=True):
            energy, force = energy + found.end.energy + found.lost, force + found.end.force
            mean = mean + self._carried(start, found)
        cancelled = sum((found.cancelled for found in coupled), bare.cancelled)
        return replace(bare, V1=energy, f1=force, mean=mean, cancelled=cancelled)

    def _carried(self, start: FieldState, found: FieldSolution) -> Array:
        """Mean force (n, d) of a field [N].

        Massless nodes are in equilibrium at the ends: what differs from these acts on the nodes that they follow.
        """
        first = first_weight(self.weight)
        ends = first * start.force + (1.0 - first) * found.end.force
        return ends + passed_on(self.model, found.mean_force - ends) if self.model.inert else ends

    def _ends(
        self, u1: Array, found: tuple[Array, Array, Array | None], energy: Array, rows: ContactRows, impulse: Array
    ) -> EndForces:
        start, m, initial, (force, mean, viscous) = self.start, len(rows.node), self.contact.initial, found
        forces = impulse / (self.path.span * moments(self.weight)[1])
        return EndForces(
            u0=start.displacement,
            u1=u1,
            f0=start.force,
            f1=force,
            V0=start.energy,
            V1=energy,
            mean=mean,
            v0=start.velocity,
            rows0=initial.rows,
            rows1=rows,
            force0=initial.pressure,
            force1=forces[:m],
            shear0=initial.traction,
            shear1=rows.shear.vectors(rows.shear.components(forces[m:])),
            viscous=viscous,
        )

    def conditions(self, q: Array, end: Evaluation, frozen: FrozenOperator) -> tuple[RowCoefficients, RowConditions]:
        """Contact rows along the contact directions of an operator, with their conditions, linear at q (n, d)."""
        return self.contact.linearised(self.model, self.path.span, q, end, frozen)

    def without_closure(self) -> "SlabEquations":
        """Equations without closure of the energy balance, for an initial guess that is not in equilibrium."""
        return replace(self, closure=Unclosed())

    def prepared(self, frozen: FrozenOperator) -> "SlabEquations":
        """Equations whose supports follow by the answer of an operator."""
        return self if self.follower is None else replace(self, follower=self.follower.prepared(frozen))

    def followed(self, q: Array, step: Array, end: Evaluation) -> tuple["SlabEquations", Array]:
        """Equations with the supports moved, and a step (n, d) from q (n, d) that was made with supports held."""
        if self.follower is None:
            return self, step
        dofs = self.model.dofs
        return self.at(np.concatenate(self.follower.answered(dofs.unknowns(q), dofs.unknowns(step), end)))

    def unknowns(self, q: Array) -> Array:
        """Unknowns (f,) of q (n, d), and after them the motion of supports that follow."""
        found = self.model.dofs.unknowns(q)
        return found if self.follower is None else np.concatenate([found, self.follower.x])

    def at(self, unknowns: Array) -> tuple["SlabEquations", Array]:
        """Equations with the motion of supports, and q (n, d), of such :meth:`unknowns`."""
        dofs = self.model.dofs
        if self.follower is None:
            return self, dofs.nodes(unknowns, self.given)
        follower = self.follower.at(unknowns[dofs.size :])
        given = follower.given(np.asarray(self.given))
        return replace(self, given=given, follower=follower), dofs.nodes(unknowns[: dofs.size], given)

    def with_kept_facets_after(self, u1: Array, active: BoolArray, count: int) -> "SlabEquations":
        """Equations after ``count`` iterations: from ``KEEP_FACETS_AFTER`` on nodes are kept on their facets.

        A node that alternates between two facets would prevent convergence.
        """
        after = KEEP_EDGES_AFTER if self.model.contacts.crossing_edges else KEEP_FACETS_AFTER
        return self.with_kept_facets(u1, active) if count == after else self

    def with_kept_facets(self, u1: Array, active: BoolArray) -> "SlabEquations":
        """Equations with nodes kept on their facets at ``u1`` (n, d); the same object if nothing changes."""
        contact = self.contact.with_kept_facets(u1, active)
        return self if contact is self.contact else replace(self, contact=contact)

    def directions(self, turning: bool = False) -> RowBasis:
        """Contact directions for any slab, in axes that may be ``turning`` with the nodes."""
        rows, model, contacts = self.path.rows, self.model, self.model.contacts
        if turning or contacts.fixed or contacts.known is None or not contacts.known.any():
            return row_basis(rows, model.dofs, contacts.fixed and not turning, model.touchable)
        return row_basis(rows, model.dofs, False, contacts.changing, contacts.known)

    @property
    def stiffness_factor(self) -> float:
        """Factor of the stiffness in the operator, ``h^2/2 mu2`` [s^2]."""
        return 0.5 * self.path.span**2 * moments(self.weight)[1]

    @property
    def equivalent_span(self) -> float:
        """Length of a slab with the default time weight that has the same operator [s]."""
        return self.path.span * float(np.sqrt(2.0 * moments(self.weight)[1]))

    @property
    def stiffness(self) -> SlabMatrix:
        """Matrix ``M + h^2/2 mu2 K`` on the unknowns."""
        viscous_factor = first_weight(self.weight) / moments(self.weight)[1] if self.model.inert else 0.0
        dashpots = self.dashpots
        damping = None if dashpots is None else dashpots.stiffness(self.model.dofs.jacobian, self.path.span)
        return SlabMatrix(
            model=self.model,
            stiffness_factor=self.stiffness_factor,
            viscous_factor=viscous_factor,
            positive_definite=self.positive_definite,
            damping=damping,
        )
