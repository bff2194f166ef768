"""Slab (time step) of central differences: explicit motion of nodes with inertia, equilibrium of contact nodes.

    v = v0 + h/2 a0,    x1 = x0 + h v,    v1 = v + h/2 a1,    M a = load - f        nodes with inertia
    f(x1) = load + G^T p,   gap(x1) >= 0,  p >= 0                                   massless nodes

Contact forces act on massless nodes only: there are no impacts (docs/theory/solver/explicit.md).
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.contact_layer import layer
from softway.bodies.internal_force.slab_average import Weighted
from softway.bodies.solid import Solid
from softway.contact.contact_rows import ContactRows
from softway.contact.impact_rule import Energy
from softway.errors import InputError
from softway.marching.explicit.contact_equilibrium import solve_contact_nodes, with_remaining
from softway.marching.explicit.massless_nodes import FollowedNodes, MasslessNodes, handed_forces, pushed_nodes
from softway.marching.results.friction_result import first_impulses
from softway.marching.results.slab_result import EnergyBalance
from softway.marching.results.step import Event
from softway.marching.rules.equilibrated import EndForceContact
from softway.marching.rules.massless_slab import ContactForces, equations, slab_result, with_prescribed
from softway.marching.rules.slab_rule import Attempt, Solutions, require_motion_alone, require_nodal
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import require_slow
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks, TimeWeight, moments
from softway.solve.equations.closure import Closure, Unclosed
from softway.solve.equations.mean_force import MeanForce
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.linear.mass_solver import MassSolver, mass_solver
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.iteration import Iterate, Solution
from softway.solve.operators.operator_memory import OperatorMemory


@dataclass(frozen=True, slots=True)
class OpenEndForces:
    """Contact forces at the ends of the slab, without a closure of the energy balance."""

    ends: EndForceContact = EndForceContact()

    def average(self, slab: Slab) -> MeanForce:
        """Mean by the virtual time function."""
        return self.ends.average(slab)

    def closure(self, model: Model, now: ModelState, slab: Slab, attempt: Attempt) -> Closure:
        """No closure."""
        return Unclosed()

    def energy_balance(self, model: Model, slab: Slab) -> EnergyBalance:
        """Bounded in a stable slab."""
        return "free" if self.ends.energy_balance(model, slab) == "free" else "bounded"

    def forces(
        self, model: Model, now: ModelState, system: SlabEquations, solution: Solution, pressure: Array
    ) -> ContactForces:
        """Forces at both ends."""
        return self.ends.forces(model, now, system, solution, pressure)

    def events(
        self, model: Model, now: ModelState, slab: Slab, system: SlabEquations, solution: Solution, closed: BoolArray
    ) -> list[Event]:
        """Touches and releases at the roots of gap and reaction."""
        return self.ends.events(model, now, slab, system, solution, closed)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CentralDifference:
    """Central differences of a model: the inverse mass, and the massless nodes with the nodes that they follow."""

    method: Explicit
    inertia: MassSolver
    still: MasslessNodes
    followed: FollowedNodes
    light: IntArray
    supported: BoolArray | None
    contact: OpenEndForces = OpenEndForces()

    def sloped(self, force: Array, before: Array) -> Array:
        """Slope (n, d) of the velocity by a force (n, d).

        Massless nodes keep the slope ``before`` (n, d) of the previous slab.  It counts twice, because their velocity
        is the mean of a slab.
        """
        out = self.inertia.acceleration(force)
        out[self.light] = 2.0 * before[self.light]
        return out

    def guessed(self, system: SlabEquations, moving: Array, coasting: Array) -> tuple[Array, Array]:
        """Initial guess of q (n, d) and of the end displacement, from the velocity and displacement without contact.

        The array of the velocity is used for q.
        """
        moving[self.light] += system.start.velocity[self.light]
        if self.supported is None:
            return moving, coasting
        q = np.where(self.supported, system.given, moving)
        return q, system.path.end(q)

    def reached(self, q: Array, moving: Array, prescribed: Array | None) -> Array:
        """Velocity (n, d) at the end from q, from ``moving`` for nodes with inertia, which is overwritten, and from
        the velocities of supports if they are ``prescribed`` (n, d).
        """
        out = moving if self.supported is None else np.where(self.supported, q, moving)
        out[self.light] = 0.5 * q[self.light]
        return out if prescribed is None or self.supported is None else np.where(self.supported, prescribed, out)

    def solve(self, model: Model, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt) -> Solutions:
        """Solution of the slab.

        Raises
        ------
        NoConvergence
            If the equilibrium of the contact nodes does not converge.
        """
        h, start = slab.span, now.start
        shock = model.shock_force(start.displacement, h * start.velocity, h)
        push = model.load if shock is None else model.load - shock
        push = push if not model.driven else push - _drag(model, now, slab)
        opening = _opening(model, now, self)
        slope = self.sloped(push - opening, now.acceleration)
        moving = h * slope
        coasting = 0.5 * moving
        moving += start.velocity
        coasting += start.velocity
        coasting *= h
        coasting += start.displacement
        coasting = with_prescribed(model, now, slab, coasting)
        pairs = model.contacts.meet(start.displacement, coasting, slab.start, slab.end)
        require_slow(model, pairs, now.start.displacement, coasting, attempt.approach)
        system = equations(self.contact, model, now, slab, pairs, attempt)
        guess, first = self.guessed(system, moving, coasting), first_impulses(now, slab, system.path.rows)
        it, u1, count = solve_contact_nodes(system, self.still, guess, first, memory, self.method)
        end = _evaluated(system, it, u1)
        closing, left = handed_forces(self.followed, self.still, end.force, _outer(system, self.still, it, end.rows))
        opening += closing
        opening *= 0.5
        end = replace(end, mean_force=opening)
        if shock is not None:
            lost = model.space.totals(shock * (end.displacement - start.displacement))
            end = replace(end, mean_force=end.mean_force + shock, lost=lost)
        solution = Solution(last=it, end=end, predicted=it.free, iterations=count, contraction=0.0)
        slope += self.inertia.acceleration(push - closing)
        slope *= 0.5 * h
        slope += start.velocity
        velocity = self.reached(it.q, slope, model.prescribed(slab.end) if model.driven else None)
        out = slab_result(self.contact, model, now, slab, system, solution, pairs.found, velocity)
        yield out, with_remaining(model.space, it.memory, self.still, left)


def central_difference(model: Model, method: Explicit, weight: TimeWeight) -> CentralDifference:
    """Prepare central differences.

    Raises
    ------
    InputError
        If contact nodes have inertia or no node has, the time weight or the force of a body is not the default, or
        unknowns move several components.
    """
    if weight != EndPeaks():
        problem = f"{weight} with Explicit, whose peak is at the start"
        raise InputError("time.weight", problem, "the default weight, or the solver FixedPoint")
    for name, body in model.scene.bodies.items():
        if isinstance(body, Solid) and body.force != Weighted():
            problem = f"{type(body.force).__name__} with Explicit, which takes the force at instants"
            raise InputError(f"bodies.{name}.force", problem, "the default force, or the solver FixedPoint")
    if not model.inert:
        raise InputError("solver", "Explicit without inertia", "the solver FixedPoint, or with inertia")
    if not isinstance(model.timing, Energy):
        problem = "Explicit with contact nodes that have inertia"
        raise InputError("solver", problem, "the timing Energy, or the solver FixedPoint")
    if model.timing.located:
        raise InputError("solver", "Explicit with located = true", "located = false, or the solver FixedPoint")
    if model.timing.calm > 0.0:
        raise InputError("solver", f"Explicit with calm = {model.timing.calm:g}", "calm = 0, or the solver FixedPoint")
    require_nodal(model, "Explicit")
    require_motion_alone(model, "Explicit")
    light = ~model.massive
    still = MasslessNodes(light=model.free & light[:, None], layer=layer(model.parts, light))
    return CentralDifference(
        method=method,
        inertia=mass_solver(model),
        still=still,
        followed=FollowedNodes.of(model, still),
        light=np.flatnonzero(light),
        supported=None if model.space.every(model.free) else ~model.free,
    )


def _evaluated(system: SlabEquations, it: Iterate, u1: Array) -> Evaluation:
    """Evaluation of all bodies at the end displacement ``u1`` (n, d) of the slab."""
    none = np.zeros(len(system.model.parts))
    energy, force = system.model.energy_and_force(u1)
    return Evaluation(
        residual=np.zeros_like(force),
        displacement=u1,
        force=force,
        energy=energy,
        mean_force=force,
        scalar=none,
        missing_work=none,
        clipped=False,
        rows=it.system.contact.at(u1),
    )


def _drag(model: Model, now: ModelState, slab: Slab) -> Array:
    """Force (n, d) on the free nodes by which a consistent mass resists the prescribed change of velocity [N]."""
    change = np.where(model.free, 0.0, model.prescribed(slab.end) - now.start.velocity)
    return np.asarray(model.mass @ change) / slab.span


def _opening(model: Model, now: ModelState, central: CentralDifference) -> Array:
    """Internal force (n, d) at the start, with residual forces of massless nodes on the nodes that they follow [N]."""
    start = now.start
    rows = now.rows or model.rows(start.displacement, now.time)
    outer = pushed_nodes(central.still, model.load_before, rows, now.pressure, now.traction)
    return handed_forces(central.followed, central.still, start.force, outer)[0]


def _outer(system: SlabEquations, still: MasslessNodes, it: Iterate, rows: ContactRows) -> Array:
    """Forces (f,) of loads and contact at the end of the slab on massless components [N]."""
    m, forces = len(rows.node), it.impulse / (system.path.span * moments(system.weight)[1])
    traction = rows.shear.vectors(rows.shear.components(forces[m:]))
    return pushed_nodes(still, system.model.load, rows, forces[:m], traction)
