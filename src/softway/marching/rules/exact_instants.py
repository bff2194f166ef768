"""Energy rule with exact instants: touch and release divide the slab, and no scalar is needed at small strain."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.slab_motion.exact_instants import ExactInstantMean, exact_instant_mean
from softway.errors import InputError
from softway.marching.results.slab_result import EnergyBalance, contact_event
from softway.marching.results.step import Event
from softway.marching.rules.equilibrated import Equilibrated
from softway.marching.rules.massless_slab import ContactForces, closed_energy_balance, require_end_points
from softway.marching.rules.slab_rule import Attempt, require_frictionless, require_motion_alone, require_nodal
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import TimeWeight
from softway.solve.equations.closure import Closure, Unclosed
from softway.solve.equations.mean_force import ExactMean, MeanForce
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Solution
from softway.solve.methods.newton import Newton


@dataclass(frozen=True, slots=True, eq=False)
class ExactInstantContact:
    """Contact forces between exact instants of touch and release, from the mean of a linear internal force."""

    exact: ExactInstantMean

    def average(self, slab: Slab) -> MeanForce:
        """Exact mean of the internal force."""
        return ExactMean(self.exact)

    def closure(self, model: Model, now: ModelState, slab: Slab, attempt: Attempt) -> Closure:
        """No closure: the exact mean satisfies the balance."""
        return Unclosed()

    def energy_balance(self, model: Model, slab: Slab) -> EnergyBalance:
        """Closed with inertia and the default time weight."""
        return closed_energy_balance(model, slab)

    def forces(
        self, model: Model, now: ModelState, system: SlabEquations, solution: Solution, pressure: Array
    ) -> ContactForces:
        """Mean internal forces of the contact nodes less their loads."""
        end, rows = solution.end, solution.end.rows
        light = ~model.massive[:, None]
        force = rows.normal_forces((end.mean_force - model.load) * light, (pressure > 0.0) | now.closed, model.free)
        return ContactForces(rows=force, nodes=rows.spread(force, model.shape), work=0.0)

    def events(
        self, model: Model, now: ModelState, slab: Slab, system: SlabEquations, solution: Solution, closed: BoolArray
    ) -> list[Event]:
        """Touches and releases at the instants that divide the slab."""
        rows, end = solution.end.rows, solution.end.displacement
        branches = self.exact.branches(now.start.displacement, end, now.closed, solution.last.impulse > 0.0)
        before, after = rows.normal_component(now.start.velocity), 0.5 * rows.normal_component(solution.last.q)
        found = []
        for b in branches:
            kind = "touch" if b.closes else "release"
            speeds = (float(before[b.row]), 0.0) if b.closes else (0.0, float(after[b.row]))
            found.append(contact_event(model, now, slab, rows, end, b.row, kind, b.instant, speeds))
        return found


def exact_instants(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Equilibrated:
    """Prepare the rule.

    Raises
    ------
    InputError
        If a material is nonlinear, an obstacle moves or is curved, a contact has friction, or the time weight does not
        fit.
    """
    require_end_points(model, weight)
    require_frictionless(model, "the located Energy rule")
    require_nodal(model, "the located Energy rule")
    require_motion_alone(model, "the located Energy rule")
    where = "contacts[0].timing.located"
    if not model.linear:
        problem = "the located Energy rule is for small strain"
        raise InputError(where, problem, "located = false, or the material LinearElastic")
    if not model.contacts.fixed:
        problem = "the located Energy rule is for resting half-spaces"
        raise InputError(where, problem, "located = false, or half-spaces at rest")
    stiffness = model.tangent(np.zeros(model.shape))
    exact = exact_instant_mean(model.rows(model.displacement), model.free, model.massive, model.load, stiffness)
    return Equilibrated(method=method, contact=ExactInstantContact(exact))
