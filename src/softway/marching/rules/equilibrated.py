"""Energy rule: massless contact nodes, in constrained equilibrium at the end of the slab (time step)."""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_set import SlabContacts
from softway.contact.impact_rule import Energy
from softway.errors import InputError
from softway.marching.friction.calm import calmed
from softway.marching.results.friction_result import first_impulses
from softway.marching.results.slab_result import EnergyBalance, SlabResult
from softway.marching.results.step import Event
from softway.marching.rules.contact_instants import releases, touches
from softway.marching.rules.massless_slab import (
    ContactForces,
    MasslessContact,
    closed_energy_balance,
    end_velocity,
    equations,
    require_end_points,
    slab_result,
    with_prescribed,
)
from softway.marching.rules.slab_rule import Attempt, Solutions
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import EARLY, above, require_open, require_slow
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.equations.closure import Closure, EndForcesOnly, EnergyScalar, Unclosed
from softway.solve.equations.mean_force import MeanForce, WeightedMean
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.cancellable import cancellable
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess, Solution, iterate
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Equilibrated:
    """Slabs with massless contact nodes in equilibrium; contact rows are inequalities on the gap at the end.

    ``calm`` is the filter of the velocity in slabs that slip, see :func:`~softway.marching.friction.calm.calmed`.
    """

    method: FixedPoint | Newton
    contact: MasslessContact
    calm: float = 0.0

    def solve(self, model: Model, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt) -> Solutions:
        """Solutions of the slab, each more accurate than the previous one."""
        h, start = slab.span, now.start
        rate = start.velocity + h * now.acceleration
        coasting = start.displacement + h * np.where(model.massive[:, None], 0.5 * (start.velocity + rate), rate)
        coasting = with_prescribed(model, now, slab, coasting)
        contacts = model.contacts
        pairs = contacts.meet(start.displacement, coasting, slab.start, slab.end, contacts.closest)
        require_slow(model, pairs, start.displacement, coasting, attempt.approach)
        if above(slab.span, attempt.lowest):
            require_open(model, pairs, now, coasting, slab.span, EARLY * attempt.lowest)
        method, guess, before = cancellable(self.method, attempt.cancel, slab.start), attempt.guess, 0
        missed: SlabContacts | None = pairs
        while missed is not None:
            pairs, missed = missed, None
            system = equations(self.contact, model, now, slab, pairs, attempt)
            iterates = method.iterate(system, guess or _guess(model, now, slab, system, rate, memory))
            for solution in iterate(system, iterates, max(method.tolerance, attempt.tolerance), method.limit):
                solution = replace(solution, iterations=before + solution.iterations)
                missed = pairs.missed(solution.end.displacement)
                if missed is not None:
                    guess, before = solution.last.guess, solution.iterations
                    break
                yield self._result(now, slab, system, solution, pairs.found), solution.last.memory

    def _result(self, now: ModelState, slab: Slab, system: SlabEquations, solution: Solution, found: int) -> SlabResult:
        """Result of a solution; supports that follow from the forces have moved."""
        follower = solution.last.system.follower
        if follower is not None:
            system = replace(system, model=follower.model, follower=follower)
        velocity = end_velocity(system.model, slab, solution.last.q)
        out = slab_result(self.contact, system.model, now, slab, system, solution, found, velocity)
        return calmed(now, slab, out, self.calm) if self.calm > 0.0 else out


def _guess(
    model: Model, now: ModelState, slab: Slab, system: SlabEquations, rate: Array, memory: OperatorMemory
) -> Guess:
    """Solution expected if the velocity goes on to ``rate`` (n, d) at the end."""
    q = np.where(model.massive[:, None], rate, 2.0 * rate)
    q = q - model.supported(q) + model.supported(np.broadcast_to(system.given, q.shape))
    impulse, active = first_impulses(now, slab, system.path.rows)
    return Guess(q=q, impulse=impulse, active=active, memory=memory)


@dataclass(frozen=True, slots=True)
class EndForceContact:
    """Contact forces linear in time between the ends of the slab; one scalar per body closes the energy balance."""

    def average(self, slab: Slab) -> MeanForce:
        """Mean by the virtual time function."""
        return WeightedMean(slab.weight)

    def closure(self, model: Model, now: ModelState, slab: Slab, attempt: Attempt) -> Closure:
        """Closure by the scalar; with another time weight, and friction or massless nodes, forces at the end only."""
        if slab.weight == EndPeaks():
            return EnergyScalar(attempt.energy_along_motion)
        return Unclosed() if model.friction.frictionless and model.space.every(model.massive) else EndForcesOnly()

    def energy_balance(self, model: Model, slab: Slab) -> EnergyBalance:
        """Closed with inertia and the default time weight."""
        return closed_energy_balance(model, slab)

    def forces(
        self, model: Model, now: ModelState, system: SlabEquations, solution: Solution, pressure: Array
    ) -> ContactForces:
        """Forces at both ends, weighted by the scalar of each body."""
        first, rows = system.contact.initial.rows, solution.end.rows
        a = solution.end.scalar[model.part_of[rows.node]]
        old, new = (0.5 - a) * now.pressure, (0.5 + a) * pressure
        if first is rows:
            nodes = rows.spread(old + new, model.shape)
        else:
            nodes = first.spread(old, model.shape) + rows.spread(new, model.shape)
        return ContactForces(rows=old + new, nodes=nodes, work=float(old @ first.tool_motion + new @ rows.tool_motion))

    def events(
        self, model: Model, now: ModelState, slab: Slab, system: SlabEquations, solution: Solution, closed: BoolArray
    ) -> list[Event]:
        """Touches and releases at the roots of gap and reaction."""
        found = touches(model, now, slab, system, solution, closed)
        return found + releases(model, now, slab, solution.end.rows, solution, closed)


def equilibrated(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Equilibrated:
    """Prepare the rule.

    Raises
    ------
    InputError
        If the time weight does not fit, or the velocity shall be filtered beside rigid bodies.
    """
    require_end_points(model, weight)
    calm = model.timing.calm if isinstance(model.timing, Energy) else 0.0
    if calm > 0.0 and model.rigid is not None:
        raise InputError("contacts[0].timing.calm", f"{calm:g} beside rigid bodies", "calm = 0")
    return Equilibrated(method=method, contact=EndForceContact(), calm=calm)
