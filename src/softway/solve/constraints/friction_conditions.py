"""Contact problem with friction of the touching rows: conditions, linearisation, Gauss-Seidel sweeps."""

from dataclasses import dataclass, field, replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.errors import NoConvergence
from softway.solve.constraints.return_map import SlipConditions, return_map, undriven
from softway.solve.constraints.turning_slip import chord_force, chord_slope, end_force
from softway.solve.effort import Effort

LIFT = 1e-12
"""Fraction of the compliance added to the diagonal, which makes dependent rows regular."""
GROWN = 1e12
"""Growth of the forces in Gauss-Seidel sweeps, relative to those that close the gaps and stop the slips row by row,
beyond which they grow without bound."""
EPS = 4.0 * float(np.finfo(float).eps)
"""Rounding error of a multiplier, relative to it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FrictionProblem:
    """Contact problem of rows (c,) with k tangential directions each.

    The unknowns are the changes x (c (1 + k),) of the previous multipliers.  So no digits cancel between the gaps
    without contact and the effect of the total multipliers, as they would for a body supported by contact only.

    Parameters
    ----------
    compliance
        (c (1 + k), c (1 + k)): normals first, then the tangential directions row by row.
    free
        (c (1 + k),) gaps and slips under the previous multipliers.
    law
        Slip conditions.
    normal_compliance
        (c,) compliance of each row along its normal; ``tangential_compliance`` (c,) along its surface.
    previous
        (c (1 + k),) previous multipliers.
    equal
        (c,) rows that stay closed, also in tension.
    rounding
        Rounding error of gaps and slips.
    effort
        Counted work of the attempt at the slab.
    """

    compliance: Array
    free: Array
    law: SlipConditions
    normal_compliance: Array
    tangential_compliance: Array
    previous: Array
    equal: BoolArray
    rounding: float = 0.0
    effort: Effort = field(default_factory=Effort)

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.normal_compliance)

    @property
    def pressed(self) -> BoolArray:
        """Rows (c,) that only the normal multipliers known beforehand press."""
        none = np.zeros(self.count, bool)
        return none if self.law.given is None else np.asarray((self.law.given > 0.0) & ~self.equal)

    def split(self, x: Array) -> tuple[Array, Array]:
        """Normal (c,) and tangential (c, k) parts."""
        return x[: self.count], x[self.count :].reshape(self.law.shift.shape)

    def multipliers(self, x: Array) -> tuple[Array, Array]:
        """Total normal (c,) and tangential (c, k) multipliers after the changes x."""
        return self.split(self.previous + x)

    def usual_force(self, x: Array) -> float:
        """Greatest of the previous multipliers, their changes x, and the changes that each row alone would need."""
        alone = np.concatenate([self.normal_compliance, np.repeat(self.tangential_compliance, self.law.shift.shape[1])])
        return float(max(np.abs(v).max(initial=0.0) for v in (self.previous, x, self.free / alone)))

    def drawn(self, x: Array, factor: float) -> "FrictionProblem":
        """Proximal problem: its multipliers are drawn to those after x by ``factor`` times the compliance of the rows.

        Dependent rows have a unique solution there; a solution x of the original problem also solves it.
        """
        more = factor * np.concatenate(
            [self.normal_compliance, np.repeat(self.tangential_compliance, self.law.shift.shape[1])]
        )
        return replace(
            self,
            compliance=self.compliance + np.diag(more),
            free=self.free - more * x,
            normal_compliance=(1.0 + factor) * self.normal_compliance,
            tangential_compliance=(1.0 + factor) * self.tangential_compliance,
        )

    def firmer(self, factor: float) -> "FrictionProblem":
        """The same problem with trial forces for less slip: the compliance of the rows along the surface times
        ``factor``.
        """
        return replace(self, tangential_compliance=factor * self.tangential_compliance)

    def without_friction(self, x: Array) -> Array:
        """Changes after which the tangential multipliers are zero."""
        return np.concatenate([x[: self.count], -self.previous[self.count :]])


def friction_problem(
    compliance: Array,
    free: Array,
    law: SlipConditions,
    previous: Array | None = None,
    rounding: float = 0.0,
    effort: Effort | None = None,
    equal: BoolArray | None = None,
) -> FrictionProblem:
    """Contact problem of rows with their compliance, and with gaps and slips under the ``previous`` multipliers.

    Rows ``equal`` (c,) stay closed, also in tension.

    Raises
    ------
    NoConvergence
        If no row has a positive compliance, as in crushed cells with an unstable tangent.
    """
    count, k = law.shift.shape
    diagonal = np.diag(compliance)
    if count and not diagonal[:count].max() > 0.0:
        raise NoConvergence(f"{count} contact rows have no positive compliance (unstable tangent of crushed cells)")
    tangential_compliance = diagonal[count:].reshape(count, k).mean(axis=1)
    least = 1e-12 * max(float(diagonal.max(initial=0.0)), 1e-300)
    return FrictionProblem(
        compliance=compliance,
        free=free,
        law=law,
        normal_compliance=np.maximum(diagonal[:count], least),
        tangential_compliance=np.maximum(tangential_compliance, least),
        previous=np.zeros(len(free)) if previous is None else previous,
        equal=np.zeros(count, bool) if equal is None else equal,
        rounding=rounding,
        effort=effort or Effort(),
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FrictionResidual:
    """Residual of the contact conditions.

    Parameters
    ----------
    missed, rounding
        (c (1 + k),) violation of the conditions in units of y, and its part by rounding of the multipliers.
    touch, rubs, slips, bent
        (c,) rows whose gap is closed, that touch in the slab, that slip, and whose force is not the trial.
    direction
        (c, k) directions of the trials.
    slope, pressure_slope
        (c, k, k) and (c,) derivatives of the forces of bent rows with respect to the trials and to the normal
        multipliers.
    chord
        (c, k, k) derivatives of the chord forces of slip that turns; None if no slip can turn.
    """

    missed: Array
    rounding: Array
    touch: BoolArray
    rubs: BoolArray
    slips: BoolArray
    bent: BoolArray
    direction: Array
    slope: Array
    pressure_slope: Array
    chord: Array | None = None

    @property
    def status(self) -> bytes:
        """Which rows touch, slip, and have other forces than their trials."""
        return self.touch.tobytes() + self.slips.tobytes() + self.bent.tobytes()

    @property
    def worst(self) -> float:
        """Greatest violation beyond rounding."""
        return float(np.maximum(np.abs(self.missed) - self.rounding, 0.0).max(initial=0.0))


def friction_residual(problem: FrictionProblem, x: Array, moved: Array | None = None) -> FrictionResidual:
    """Evaluate the contact conditions after the changes x (c (1 + k),), which have ``moved`` the rows (c (1 + k),)."""
    p, s = problem.multipliers(x)
    gap, slip = problem.split(problem.free + (problem.compliance @ x if moved is None else moved))
    k, chord = s.shape[1], chord_slope(problem.law.turning, s)
    s = chord_force(problem.law.turning, s)
    touch = problem.equal | (~problem.pressed & (p - gap / problem.normal_compliance > 0.0))
    rubs = touch | problem.pressed
    trial, along = undriven(problem.law, s - slip / problem.tangential_compliance[:, None])
    size = np.linalg.norm(trial, axis=1)
    direction = trial / np.maximum(size, 1e-300)[:, None]
    normal = np.where(problem.equal, p, np.maximum(p, 0.0))
    found = return_map(problem.law, size, normal, 1.0 / problem.tangential_compliance)
    slips = rubs & found.slips
    bent = slips if along is None else slips | (rubs & along.any(axis=1))
    missed_s = np.where(
        bent[:, None], (s - found.force[:, None] * direction) * problem.tangential_compliance[:, None], slip
    )
    missed_p = np.where(touch, gap, p * problem.normal_compliance)
    missed_s = np.where(rubs[:, None], missed_s, s * problem.tangential_compliance[:, None])
    turn = np.where(size > 0.0, found.force / np.maximum(size, 1e-300), 0.0)[:, None, None]
    projector = direction[:, :, None] * direction[:, None, :]
    rounding_s = np.where(rubs & ~bent, 0.0, EPS * np.linalg.norm(s, axis=1) * problem.tangential_compliance)
    slope = turn * (np.eye(k) - projector) + found.steep[:, None, None] * projector
    if along is not None:
        slope = np.where(slips[:, None, None], slope, np.eye(k))
        slope = slope - np.einsum("cij,cj->ci", slope, along)[:, :, None] * along[:, None, :]
    return FrictionResidual(
        missed=np.concatenate([missed_p, missed_s.ravel()]),
        rounding=np.concatenate(
            [np.where(touch, 0.0, EPS * np.abs(p) * problem.normal_compliance), np.repeat(rounding_s, k)]
        ),
        touch=touch,
        rubs=rubs,
        slips=slips,
        bent=bent,
        direction=direction,
        slope=slope,
        pressure_slope=found.pressure_slope,
        chord=chord,
    )


def linearised(problem: FrictionProblem, residual: FrictionResidual) -> Array:
    """Derivatives (c (1 + k), c (1 + k)) of the violation of the conditions."""
    c, W, touch, rubs, bent = problem.count, problem.compliance, residual.touch, residual.rubs, residual.bent
    k = residual.direction.shape[1]
    diagonal = np.arange(c)
    places = c + k * diagonal[:, None] + np.arange(k)
    matrix = W.copy()
    matrix[:c][~touch], matrix[places[~rubs].ravel()] = 0.0, 0.0
    matrix[diagonal, diagonal] += np.where(touch, LIFT, 1.0) * problem.normal_compliance
    matrix[places, places] += (np.where(rubs, LIFT, 1.0) * problem.tangential_compliance)[:, None]
    at, tangential_compliance, slope = (
        places[bent],
        problem.tangential_compliance[bent][:, None, None],
        residual.slope[bent],
    )
    matrix[at] = np.einsum("cij,cjn->cin", slope, W[at]) if k > 1 else slope * W[at]
    own = np.eye(k) - slope
    own = own if residual.chord is None else np.einsum("cij,cjn->cin", own, residual.chord[bent])
    matrix[at[:, :, None], at[:, None, :]] += tangential_compliance * own
    pressure_slope = np.where(residual.slips, residual.pressure_slope, 0.0)[bent, None]
    matrix[at, diagonal[bent][:, None]] -= tangential_compliance[:, 0] * pressure_slope * residual.direction[bent]
    return matrix


def gauss_seidel(problem: FrictionProblem, x: Array, count: int) -> Array:
    """Changes of the multipliers after ``count`` Gauss-Seidel sweeps: each row in turn satisfies its conditions.

    They end before a sweep in which a force is beyond ``GROWN``: with a compliance that is not positive, as in
    crushed cells with an unstable tangent, they grow without bound.

    Raises
    ------
    NoConvergence
        If a row has no positive compliance along the surface.
    """
    c, W = problem.count, problem.compliance
    most = GROWN * problem.usual_force(x)
    x, previous, pressed = x.copy(), problem.previous, problem.pressed
    k = (len(x) - c) // c
    parts = [problem.law.subset(np.array([i])) for i in range(c)]
    for sweep in range(1, count + 1):
        problem.effort.step(f"friction of {c} rows, Gauss-Seidel sweep {sweep}")
        before = x.copy()
        for i in range(c):
            at = c + k * i + np.arange(k)
            gap = problem.free[i] + W[i] @ x
            x[i] = -previous[i] if pressed[i] else x[i] - gap / problem.normal_compliance[i]
            x[i] = x[i] if problem.equal[i] else max(x[i], -previous[i])
            if not abs(x[i]) <= most:
                return before
            slip = problem.free[at] + W[at] @ x
            soft = max(
                float(np.linalg.eigvalsh(W[np.ix_(at, at)]).max(initial=0.0)), 1e-12 * problem.tangential_compliance[i]
            )
            if not soft > 0.0:
                raise NoConvergence(f"a contact row has the compliance {soft:g} along the surface")
            stiff = 1.0 / soft
            trial = chord_force(parts[i].turning, (previous[at] + x[at])[None])[0] - stiff * slip
            trial = undriven(parts[i], trial[None])[0][0]
            size = np.linalg.norm(trial)
            normal = previous[i : i + 1] + x[i : i + 1]
            sticks = size <= parts[i].limit(normal)[0]
            force = size if sticks else return_map(parts[i], np.array([size]), normal, np.array([stiff])).force[0]
            x[at] = end_force(parts[i].turning, (force * trial / max(size, 1e-300))[None])[0] - previous[at]
            if not np.abs(x[at]).max(initial=0.0) <= most:
                return before
    return x
