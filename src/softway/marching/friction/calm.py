"""Filter of the velocity of sliding bodies at the end of a slab (time step), against flutter that slabs do not resolve.

    v1 <- v1 - calm H^2 (v1 - vs),      H = (M + h^2/4 K~)^-1 h^2/4 K~

K~ is the stiffness of the nodes with inertia: massless nodes are in equilibrium, with the normals of closed rows held,
and the tangents of sticking ones.  vs is a motion with the tools and supports that needs no change of the internal
forces.  H is self-adjoint in the product of M with eigenvalues in [0, 1), so the filter takes energy in every slab
(docs/theory/contact/friction.md).
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.following_nodes import reactions
from softway.marching.results.slab_result import SlabResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.constraints.normal_active_set import multipliers
from softway.solve.constraints.row_basis import RowCoefficients
from softway.solve.equations.energy_balance import body_groups
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.operators.factored import Factored
from softway.solve.operators.operator_memory import OperatorMemory

SAME = 1e-9
"""Relative difference of slab lengths below which they have the same operator."""


def calmed(now: ModelState, slab: Slab, out: SlabResult, calm: float) -> SlabResult:
    """Slab whose velocity at the end is filtered in groups of touching bodies that slip.

    The lost energy is added to the dissipation.  The impulses along held normals and tangents belong to the contact
    forces over the slab, those of held nodes to the supports; both do work on tools and supports that move.

    The result is ``out`` itself without slip, without inertia, in a slab whose weight damps, and where a stiffness with
    negative eigenvalues would let the filter give energy.
    """
    model, rows = out.system.model, out.rows
    slips = out.closed & out.friction.sliding & rows.near
    if not (calm > 0.0 and model.inert and slab.weight == EndPeaks() and slips.any()):
        return out
    group = body_groups(model, (rows, out.closed))
    inside = np.isin(group, group[model.part_of[rows.node[slips]]])[model.part_of]
    held = HeldMotion.of(out, slab.span, inside)
    w = held.strained(out.velocity)
    rest, forces = held.settled(w)
    turn = np.where(held.moving, w - rest, 0.0)
    lost = calm * _square(model, w) - 0.5 * calm**2 * _square(model, turn)
    if lost < 0.0:
        return out
    velocity = out.velocity - calm * turn
    return _booked(out, held, velocity, calm * forces, calm * rest, lost, now)


def _square(model: Model, v: Array) -> float:
    """``v.M v`` of a field (n, d)."""
    return model.space.dot(v, model.mass @ v)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldMotion:
    """Bodies in a slab of length ``span`` [s] with held contact rows.

    Parameters
    ----------
    moving
        (n, 1) nodes with inertia in groups that slip.
    operator
        Inverse of ``M + h^2/4 K`` on the unknowns.
    index
        (k,) held rows, as numbered in ``coefficients``: normals (m,), then tangential components.
    coefficients
        Coefficients of the held rows along the contact directions.
    rate
        (k,) motion of the tools along them [m/s].
    carried
        (n, d) mean velocity of the solids that share unknowns, at their nodes [m/s].
    """

    out: SlabResult
    span: float
    moving: BoolArray
    operator: FrozenOperator
    index: IntArray
    coefficients: RowCoefficients
    rate: Array
    carried: Array

    @classmethod
    def of(cls, out: SlabResult, span: float, inside: BoolArray) -> "HeldMotion":
        """Rows that are closed at the end of a slab, on the nodes ``inside`` (n,)."""
        model, rows = out.system.model, out.rows
        closed = out.closed & rows.near & inside[rows.node]
        sticks = np.repeat(closed & ~out.friction.sliding, rows.shear.tangents.shape[1] if rows.shear.count else 0)
        index = np.flatnonzero(np.concatenate([closed, sticks]))
        operator = _operator(out, span)
        moved = np.concatenate([rows.tool_motion, rows.shear.flat(rows.shear.moved).ravel()])
        return cls(
            out=out,
            span=span,
            moving=(model.massive & inside)[:, None],
            operator=operator,
            index=index,
            coefficients=operator.coefficients(rows, model.dofs).subset(index),
            rate=moved[index] / span,
            carried=_mean_motion(model, out.velocity),
        )

    @property
    def model(self) -> Model:
        """Model in the slab."""
        return self.out.system.model

    def along(self, field: Array) -> Array:
        """Components (k,) of a field (n, d) along the held rows."""
        rows = self.out.rows
        tangential = (
            rows.shear.flat(np.asarray(rows.shear.weights @ field)).ravel() if rows.shear.count else np.zeros(0)
        )
        return np.concatenate([rows.normal_component(field), tangential])[self.index]

    def elastic(self, field: Array) -> Array:
        """``h^2/4 K field`` (n, d)."""
        model = self.model
        return 0.25 * self.span**2 * model.tangent_product(self.out.solution.end.displacement, field)

    def strained(self, velocity: Array) -> Array:
        """``H (v - vs)`` (n, d) on the moving nodes, for the velocities v (n, d).

        The mean motion of each solid is split off, as it strains nothing: with it small vibrations would be lost in the
        rounding errors of fast bodies.
        """
        z, model = velocity - self.carried, self.model
        given = model.supported(z)
        force = model.mass @ (z - given) - (self.elastic(given) if given.any() else 0.0)
        x, _ = self._solved(force, self.rate - self.along(self.carried + given))
        return np.where(self.moving, z - model.dofs.nodes(x, given), 0.0)

    def settled(self, w: Array) -> tuple[Array, Array]:
        """``(M + h^2/4 K~)^-1 M w`` (n, d) for a field w (n, d), and the forces (k,) of the held rows."""
        x, force = self._solved(self.model.mass @ w, np.zeros(len(self.index)))
        return self.model.dofs.nodes(x), force

    def _solved(self, force: Array, rate: Array) -> tuple[Array, Array]:
        """Solution (f,) with forces (n, d) on the nodes and given motion (k,) of the held rows, and their forces."""
        free = self.operator.solve(self.model.dofs.forces(force))
        missing = rate - self.coefficients.from_basis(self.operator.restrict(free))
        found, push = multipliers(self.operator, self.coefficients, missing)
        return free + self.operator.solve_push(push.directions), found


def _mean_motion(model: Model, velocity: Array) -> Array:
    """Mean velocity (n, d) of the solids that share unknowns, or that are glued by ties that break, at their nodes."""
    weight = np.asarray(model.mass.sum(axis=1)).ravel()[:, None]
    of = np.zeros(len(velocity), int) if model.bonds else model.linked[model.part_of]
    out = np.zeros_like(velocity)
    for group in np.unique(of):
        here = (of == group)[:, None]
        out += here * model.space.sums(here * weight * velocity) / model.space.total(here * weight)
    return out


def _operator(out: SlabResult, span: float) -> FrozenOperator:
    """Inverse of ``M + h^2/4 K`` at the end of a slab: that of the slab itself if it is exact there, else a new one."""
    system, memory = out.system, out.solution.last.memory
    if memory.frozen is not None and system.model.linear and _exact(memory, span):
        return memory.frozen
    matrix = SlabMatrix(model=system.model, stiffness_factor=0.25 * span**2, viscous_factor=0.0)
    made = Factored(precision="double").make(matrix, out.solution.end.displacement, None)
    return made.frozen(system.directions())


def _exact(memory: OperatorMemory, span: float) -> bool:
    """True if the operator of a linear model is that of slabs of length ``span`` [s], in double precision."""
    frozen, origin = memory.frozen, memory.origin
    if frozen is None or origin is None or not isinstance(origin.operator, Factored) or origin.positive_definite:
        return False
    same = abs(memory.span / span - 1.0) <= SAME and frozen.scale == 1.0
    return same and frozen.exact and frozen.kind is np.float64 and frozen.turning is None


def _booked(
    out: SlabResult, held: HeldMotion, velocity: Array, impulse: Array, relaxed: Array, lost: float, now: ModelState
) -> SlabResult:
    """Result with a ``velocity`` (n, d) at the end, after impulses (k,) of the held rows [N s] and of internal forces
    ``h^2/4 K relaxed`` (n, d), which have ``lost`` an energy [J].
    """
    model, rows, h = out.system.model, out.rows, held.span
    m = len(rows.node)
    every = np.zeros(m + rows.shear.tangents.shape[1] * rows.shear.count)
    every[held.index] = impulse / h
    along = rows.shear.vectors(rows.shear.components(every[m:])) if rows.shear.count else np.zeros_like(rows.normal)
    normal, tangential = rows.spread(every[:m], model.shape), rows.shear.spread(along)
    support, work = out.support, h * float(every[held.index] @ held.rate)
    if not model.space.every(model.dofs.unsupported):
        inner = model.mass @ (velocity - out.velocity) + held.elastic(relaxed)
        pull = reactions(model.dofs, inner / h - normal - tangential)
        support, work = support + pull, work + h * model.space.total(pull * model.supported(velocity))
    friction = out.friction
    return replace(
        out,
        velocity=velocity,
        acceleration=(velocity - now.start.velocity) / h,
        force=out.force + every[:m],
        push=out.push + normal + tangential,
        support=support,
        work=out.work + work,
        dissipation=out.dissipation + lost,
        friction=replace(friction, mean=friction.mean + along, push=friction.push + tangential),
    )
