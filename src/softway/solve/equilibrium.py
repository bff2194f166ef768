"""Static equilibrium of some components with unilateral contact: how a march starts."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.contact.candidates import Candidates
from softway.contact.encounters import Pairs
from softway.errors import Cancel, NoConvergence, NumericsError, heed
from softway.model import Model
from softway.solve.friction import rubbed
from softway.solve.frozen import basis, freeze
from softway.solve.linear import SuperLU
from softway.solve.normal import Rows, constrain, rounded
from softway.solve.return_map import Slipping
from softway.typing import Array, BoolArray

SHARE = 1e-7
"""Lift of the stiffness of bodies without support, as a share of its diagonal: far below their softest mode."""
ROUNDING = 1e-9
"""Change of the displacement, relative to its size, that is rounding if it no longer falls: free motions wander."""
STEADY = 20
"""Steps after which nodes keep their faces: one at the edge of two curved faces may hop to and fro."""
SLOW = 1e-9
"""Share of the greatest speed below which a place does not slip at the start."""
PSEUDO = 1e6
"""Time over which places that slip at the start are followed to tell their direction, in sizes over speeds."""
REMEDY = "a smaller load or initial displacement, or more supports"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rest:
    """A static equilibrium: displacement (n, d), contact forces (m,) [N] and, where there is friction, tangential
    forces (m, d) and rows (m,) that slip.
    """

    displacement: Array
    pressure: Array
    traction: Array | None = None
    sliding: BoolArray | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Grip:
    """Friction in an equilibrium: slip is counted from the displacement ``held`` (n, d); rows whose opponents pass by
    with ``velocity`` (m, d) slip, and rows that pass by nothing are held.
    """

    held: Array
    velocity: Array

    def conditions(self, model: Model, rows: Candidates, u: Array, reach: float) -> Slipping | None:
        """The conditions on a step from the displacement u (n, d)."""
        if model.rubbing is None or rows.shear is None:
            return None
        speed = np.linalg.norm(self.velocity, axis=1)
        most = float(speed.max(initial=0.0))
        time = PSEUDO * reach / most if most > 0.0 else 1.0
        passed = rows.shear.weights @ (u - self.held) + time * self.velocity
        return Slipping(
            rubbing=model.rubbing.at(u),
            shift=-rows.shear.flat(passed),
            pace=1.0 / time if most > 0.0 else 0.0,
            unit=1.0,
            ahead=0.0,
            before=np.zeros(len(rows.node)),
            sliding=speed > SLOW * most,
        )


def equilibrium(
    model: Model,
    u: Array,
    unknown: BoolArray,
    load: Array,
    time: float = 0.0,
    limit: int = 60,
    grip: Grip | None = None,
    cancel: Cancel | None = None,
) -> Rest:
    """Displacement and contact forces with ``f(u) = load + G^T lambda`` on the unknown components.

    Newton's method with the contact rows as inequalities on the gap; the other components keep their value.

    Parameters
    ----------
    u
        (n, d) first guess.
    unknown
        (n, d) components to find; the stiffness among them must be regular.
    load
        (n, d) [N].
    grip
        Friction; without it there is none.
    cancel
        Asked at every step.

    Raises
    ------
    NumericsError
        If it does not settle.
    Cancelled
        If ``cancel`` says so.
    """
    if not unknown.any():
        return Rest(displacement=u, pressure=np.zeros(len(model.encounters.contact)))
    return _settled(model, u, unknown, load, model.encounters.rest(u, time), None, limit, grip, cancel)


def fitted(
    model: Model,
    u: Array,
    unknown: BoolArray,
    load: Array,
    apart: Array,
    limit: int = 200,
    grip: Grip | None = None,
    cancel: Cancel | None = None,
) -> Rest:
    """Displacement and contact forces of bodies that overlap at the start, pressed apart: a press fit.

    Bodies that no support holds keep their place as far as they can: the stiffness is lifted by a share ``SHARE`` of
    the volume that each node has, about the last iterate (proximal steps), so that the answer is an equilibrium of the
    plain stiffness.  Surfaces are told to face each other on the way from the displacement ``apart`` (n, d), where
    they do not overlap, to ``u``.

    Raises
    ------
    NumericsError
        If it does not settle.
    Cancelled
        If ``cancel`` says so.
    """
    d = model.shape[1]
    keep = np.flatnonzero(unknown.ravel())
    stiffness = model.tangent(u)
    weight = np.repeat(np.maximum(_nodal_volume(model), 0.0), d)
    lift = SHARE * float(stiffness.diagonal().mean() / weight.mean()) * weight
    pairs = model.encounters.meet(apart, u, 0.0, 0.0)
    return _settled(model, u, unknown, load, pairs, sp.csc_array(sp.diags_array(lift[keep])), limit, grip, cancel)


def _nodal_volume(model: Model) -> Array:
    """Volume (n,) of the cells around each node, shared among their nodes [m^3]."""
    found = np.zeros(model.shape[0])
    for part in model.parts:
        internal = part.internal
        start = 0
        for cells, table in zip(part.mesh.blocks.values(), internal.sampling.rows, strict=True):
            e, q = table.shape[:2]
            share = internal.sampling.volume[start : start + e * q].reshape(e, q).sum(axis=1) / cells.shape[1]
            np.add.at(found, cells + part.rows.start, share[:, None])
            start += e * q
    return found


def _settled(
    model: Model,
    u: Array,
    unknown: BoolArray,
    load: Array,
    pairs: Pairs,
    lift: sp.csc_array | None,
    limit: int,
    grip: Grip | None,
    cancel: Cancel | None,
) -> Rest:
    """Newton's method with the contact rows as inequalities; ``lift`` (k, k) is added to the stiffness."""
    keep = np.flatnonzero(unknown.ravel())
    last: tuple[Array, BoolArray] | None = None
    once = model.linear and model.encounters.fixed and lift is None
    best, since = np.inf, 0
    rounding = rounded(model.points)
    u = u.copy()
    for count in range(limit):
        heed(cancel, 0.0)
        pairs = pairs.held(u) if count == STEADY and pairs.known is None else pairs
        rows = pairs.at(u)
        try:
            stiffness = model.tangent(u)[keep][:, keep]
            held = stiffness if lift is None else stiffness + lift
            step, force, active = _step(model, rows, u, unknown, load, held, last, grip)
        except NoConvergence as failure:
            raise NumericsError(f"no static equilibrium at the start: {failure}", 0.0, REMEDY) from None
        u[unknown], last = u[unknown] + step, (force, active)
        change = float(np.abs(step).max())
        if not np.isfinite(change):
            break
        size = max(float(np.abs(u).max()), float(np.abs(rows.offset[rows.near]).max(initial=0.0)))
        best, since = (change, 0) if change < 0.5 * best else (best, since + 1)
        if once or change <= max(1e-13 * size, rounding) or (since >= 2 and change <= ROUNDING * size):
            return _rest(u, rows, force, active)
    raise NumericsError("no static equilibrium at the start", 0.0, REMEDY)


def _rest(u: Array, rows: Candidates, force: Array, active: BoolArray) -> Rest:
    """The equilibrium with forces and active rows as they were solved for."""
    m = len(rows.node)
    if rows.shear is None or len(force) == m:
        return Rest(displacement=u, pressure=force[:m])
    traction = rows.shear.vectors(force[m:].reshape(m, -1))
    return Rest(displacement=u, pressure=force[:m], traction=traction, sliding=active[m:])


def _step(
    model: Model,
    rows: Candidates,
    u: Array,
    unknown: BoolArray,
    load: Array,
    stiffness: sp.csc_array,
    last: tuple[Array, BoolArray] | None,
    grip: Grip | None,
) -> tuple[Array, Array, BoolArray]:
    """One step of Newton's method on the unknown components, the contact forces, and the active rows."""
    reach = float(np.abs(model.points + u).max())
    slipping = None if grip is None else grip.conditions(model, rows, u, reach)
    rows = rows if slipping is not None else replace(rows, shear=None)
    directions = basis(rows, unknown, model.encounters.fixed, model.touchable)
    reachable = rows.reachable(unknown)
    target = np.where(reachable, -rows.gap(u), 0.0)
    frozen = freeze(stiffness, directions, SuperLU())
    coefficients = frozen.coefficients(rows, unknown)
    m = len(target)
    if last is None:
        last = (np.zeros(m), np.zeros(m, bool)) if slipping is None else _open(m, slipping)
    force, active = last
    free = -frozen.solve((model.force(u) - load)[unknown] - frozen.push(coefficients.spread(force)))
    conditions = Rows(
        target=target,
        equal=np.zeros(m, bool),
        unilateral=reachable,
        slipping=slipping,
        rounding=rounded(model.points),
    )
    solve = constrain if slipping is None else rubbed
    return solve(free, frozen, coefficients, conditions, active, force)


def _open(m: int, slipping: Slipping) -> tuple[Array, BoolArray]:
    """No forces of m rows with friction, none of which touches."""
    return np.zeros(m + slipping.shift.size), np.zeros(2 * m, bool)
