"""Static equilibrium with unilateral contact, from which a march may start."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray
from softway.bodies.assembled.material_states import committed
from softway.bodies.dof_map import DofMap
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import SlabContacts
from softway.errors import Cancel, NoConvergence, NumericsError, heed
from softway.model.cohesive_ties import CohesiveTies, with_glue
from softway.model.field import in_states
from softway.model.model import Model
from softway.solve.constraints.compliance import frozen_operator, row_basis
from softway.solve.constraints.friction_contact import solve_friction
from softway.solve.constraints.normal_active_set import RowConditions, rounded, solve_normal_contact
from softway.solve.constraints.return_map import NO_SLIP, SlipConditions
from softway.solve.effort import Effort
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.operators.choice import factor_operations
from softway.solve.stagnation import Stagnation

LIFT = 1e-7
"""Lift of the stiffness of unsupported bodies, relative to its diagonal: far below their softest mode."""
WANDERING = 1e-9
"""Change of the displacement, relative to its size, that is accepted if it stagnates: free rigid motions drift."""
KEEP_AFTER = 20
"""Steps after which nodes are kept on their facets: a node at the edge of two curved facets may alternate."""
SLOW = 1e-9
"""Fraction of the greatest speed below which a row does not slip at the start."""
PSEUDO = 1e6
"""Time over which slipping rows are followed at the start to find their direction, in sizes over speeds."""
REMEDY = "a smaller load or initial displacement, or more supports"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StaticState:
    """Static equilibrium: displacement (n, d), normal and tangential contact forces (m,) and (m, d) [N], and the rows
    (m,) that slip.
    """

    displacement: Array
    pressure: Array
    traction: Array
    sliding: BoolArray

    @classmethod
    def apart(cls, u: Array, m: int) -> "StaticState":
        """Bodies at the displacement u (n, d) without contact forces on m rows."""
        none = np.zeros((m, u.shape[1]))
        return cls(displacement=u, pressure=np.zeros(m), traction=none, sliding=np.zeros(m, bool))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InitialSlip:
    """Friction in an equilibrium, with slip measured from the displacement ``reference`` (n, d).

    Rows slip if they have a relative ``velocity`` (m, d), and stick otherwise.
    """

    reference: Array
    velocity: Array

    def conditions(self, model: Model, rows: ContactRows, u: Array, extent: float) -> SlipConditions:
        """Slip conditions of a step from the displacement u (n, d); ``extent`` is the greatest coordinate [m]."""
        if model.friction.frictionless:
            return NO_SLIP
        speed = np.linalg.norm(self.velocity, axis=1)
        most = float(speed.max(initial=0.0))
        time = PSEUDO * extent / most if most > 0.0 else 1.0
        passed = rows.shear.weights @ (u - self.reference) + time * self.velocity
        return SlipConditions(
            friction=model.friction.at(u),
            shift=-rows.shear.flat(passed),
            speed_factor=1.0 / time if most > 0.0 else 0.0,
            unit=1.0,
            ahead=0.0,
            before=np.zeros(len(rows.node)),
            sliding=speed > SLOW * most,
        )


@dataclass(frozen=True, slots=True)
class NoInitialSlip:
    """Equilibrium without friction."""

    def conditions(self, model: Model, rows: ContactRows, u: Array, extent: float) -> SlipConditions:
        """No slip conditions."""
        return NO_SLIP


InitialFriction = InitialSlip | NoInitialSlip


def equilibrium(
    model: Model,
    u: Array,
    dofs: DofMap,
    load: Array,
    time: float = 0.0,
    limit: int = 60,
    friction: InitialFriction = NoInitialSlip(),
    cancel: Cancel | None = None,
    effort: Effort | None = None,
    glue: tuple[CohesiveTies, ...] = (),
) -> StaticState:
    """Solve ``f(u) = load + G^T lambda`` on the unknowns for displacement and contact forces.

    Newton's method with the contact rows as inequalities on the gap; the other components keep their values.

    Parameters
    ----------
    u
        (n, d) initial guess [m].
    dofs
        Map of the unknowns; the stiffness among them must be regular.
    load
        (n, d) [N].
    friction
        Friction between the bodies.
    cancel
        Callback at every step that may cancel the computation.
    effort
        Counted work, with progress lines.
    glue
        Ties that break, which hold with the damage that they have.

    Raises
    ------
    NumericsError
        If the iteration does not converge.
    Cancelled
        If ``cancel`` requests it.
    """
    if not dofs.size:
        return StaticState.apart(u, len(model.contacts.contact))
    pairs = model.contacts.rest(u, time)
    return _newton_iteration(model, u, dofs, load, pairs, None, limit, friction, cancel, effort or Effort(), glue)


def fitted(
    model: Model,
    u: Array,
    dofs: DofMap,
    load: Array,
    apart: Array,
    limit: int = 200,
    friction: InitialFriction = NoInitialSlip(),
    cancel: Cancel | None = None,
    effort: Effort | None = None,
) -> StaticState:
    """Static equilibrium of bodies that overlap at the start (press fit): they are pressed apart.

    Unsupported bodies stay in place as far as possible: the stiffness is lifted by ``LIFT`` in proportion to the nodal
    volumes, about the last iterate (proximal steps).  The solution is therefore an equilibrium of the original
    stiffness.  The contact search uses the path from the displacement ``apart`` (n, d), where the surfaces do not
    overlap, to ``u``.

    Raises
    ------
    NumericsError
        If the iteration does not converge.
    Cancelled
        If ``cancel`` requests it.
    """
    d = model.shape[1]
    stiffness = model.tangent(u)
    weight = np.repeat(np.maximum(_nodal_volume(model), 0.0), d)
    nodal = LIFT * (model.space.mean(stiffness.diagonal()) / model.space.mean(weight)) * weight
    lift = dofs.matrix(sp.csc_array(sp.diags_array(nodal)))
    pairs = model.contacts.meet(apart, u, 0.0, 0.0)
    return _newton_iteration(model, u, dofs, load, pairs, lift, limit, friction, cancel, effort or Effort())


def _nodal_volume(model: Model) -> Array:
    """Nodal volume (n,): the volume of each cell is divided equally among its nodes [m^3]."""
    found = np.zeros(model.shape[0])
    for part in model.parts:
        internal = part.internal
        start = 0
        for cells, table in zip(part.mesh.blocks.values(), internal.sampling.rows, strict=True):
            e, q = table.shape[:2]
            volume = internal.sampling.volume[start : start + e * q].reshape(e, q).sum(axis=1) / cells.shape[1]
            np.add.at(found, cells + part.nodes.start, volume[:, None])
            start += e * q
    return found


def _newton_iteration(
    model: Model,
    u: Array,
    dofs: DofMap,
    load: Array,
    pairs: SlabContacts,
    lift: sp.csc_array | None,
    limit: int,
    friction: InitialFriction,
    cancel: Cancel | None,
    effort: Effort,
    glue: tuple[CohesiveTies, ...] = (),
) -> StaticState:
    """Newton's method with the contact rows as inequalities; ``lift`` (k, k) is added to the stiffness."""
    last: tuple[Array, BoolArray] | None = None
    once = model.linear and model.contacts.fixed and lift is None and not model.companions
    seen = Stagnation()
    rounding = rounded(model.space.greatest(model.points))
    for count in range(limit):
        heed(cancel, 0.0)
        pairs = pairs.with_kept_facets(u) if count == KEEP_AFTER and pairs.fixed_rows is None else pairs
        rows = pairs.at(u)
        try:
            stiffness, pull = loaded(model, u, dofs, load, glue)
            lifted = stiffness if lift is None else stiffness + lift
            step, force, active = newton_step(model, rows, u, dofs, pull, lifted, last, friction, effort)
        except NoConvergence as failure:
            raise NumericsError(f"no static equilibrium at the start: {failure}", 0.0, REMEDY) from None
        u, last = u + dofs.nodes(step), (force, active)
        change = model.space.greatest(step)
        if not np.isfinite(change):
            break
        effort.iterated(
            count + 1, change / max(model.space.greatest(u), 1e-300), int(np.count_nonzero(force[: len(rows.node)]))
        )
        size = max(model.space.greatest(u), float(np.abs(rows.offset[rows.near]).max(initial=0.0)))
        seen = seen.after(change)
        if once or change <= max(1e-13 * size, rounding) or (seen.since >= 2 and change <= WANDERING * size):
            return static_state(u, rows, force, active)
    raise NumericsError("no static equilibrium at the start", 0.0, REMEDY)


def loaded(
    model: Model, u: Array, dofs: DofMap, load: Array, glue: tuple[CohesiveTies, ...]
) -> tuple[sp.csc_array, Array]:
    """Stiffness (k, k) on the unknowns, and load (n, d) without what ties that break hold."""
    held = sum((one.at(one.damage, u).force for one in glue), np.zeros_like(load))
    return dofs.matrix(with_glue(model.tangent(u), glue, u) if glue else model.tangent(u)), load - held


def static_state(u: Array, rows: ContactRows, force: Array, active: BoolArray) -> StaticState:
    """Static state with the contact forces and active rows of the last step."""
    m = len(rows.node)
    if len(force) == m:
        return replace(StaticState.apart(u, m), pressure=force)
    traction = rows.shear.vectors(rows.shear.components(force[m:]))
    return StaticState(displacement=u, pressure=force[:m], traction=traction, sliding=active[m:])


def newton_step(
    model: Model,
    rows: ContactRows,
    u: Array,
    dofs: DofMap,
    load: Array,
    stiffness: sp.csc_array,
    last: tuple[Array, BoolArray] | None,
    friction: InitialFriction,
    effort: Effort,
) -> tuple[Array, Array, BoolArray]:
    """One step of Newton's method on the unknowns, the contact forces, and the active rows."""
    if not np.isfinite(stiffness.data).all():
        raise NoConvergence("a step has turned a cell inside out, or its forces overflow")
    slipping = friction.conditions(model, rows, u, model.extent(u))
    rows = rows.without_friction() if slipping.frictionless else rows
    directions = row_basis(rows, dofs, model.contacts.fixed, model.touchable)
    reachable = rows.reachable(dofs)
    target = np.where(reachable, -rows.gap(u), 0.0)
    effort.factor(dofs.size, factor_operations(model))
    frozen = frozen_operator(stiffness, directions, SuperLU())
    coefficients, m = frozen.coefficients(rows, dofs), len(target)
    if last is None:
        last = _open(m, slipping)
    force, active = last
    free = -frozen.solve(dofs.forces(_force(model, u) - load) - frozen.prolong(coefficients.spread(force)))
    conditions = RowConditions(
        target=target,
        equal=np.zeros(m, bool),
        unilateral=reachable,
        slipping=slipping,
        rounding=rounded(model.space.greatest(model.points)),
    )
    solve = solve_normal_contact if slipping.frictionless else solve_friction
    return solve(free, frozen, coefficients, conditions, active, force, effort)


def _force(model: Model, u: Array) -> Array:
    """Internal force (n, d) with that of the initial values of companion fields but ties that break [N]."""
    fields = tuple(c for c in model.companions if not isinstance(c, CohesiveTies))
    if not fields:
        return model.force(u)
    there = in_states(fields, committed(model.parts, u))
    return sum((c.at(c.initial(), u).force for c in there), model.force(u))


def _open(m: int, slipping: SlipConditions) -> tuple[Array, BoolArray]:
    """Zero forces of m open rows, and no active rows."""
    return np.zeros(m + slipping.shift.size), np.zeros(m if slipping.frictionless else 2 * m, bool)
