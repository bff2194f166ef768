"""The contact problem of the rows that touch: its conditions, their linearisation, sweeps over it, problems near it."""

from dataclasses import dataclass, replace

import numpy as np

from softway.errors import NoConvergence
from softway.solve.return_map import Slipping, returned
from softway.typing import Array, BoolArray

LIFT = 1e-12
"""Share of the compliance by which rows that depend on each other are told apart."""
EPS = 4.0 * float(np.finfo(float).eps)
"""Share of a multiplier that is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Touching:
    """The contact problem of some rows (c,), with k tangential directions each.

    Its unknowns are changes x (c (1 + k),) of multipliers that are carried already: what cancels between gaps without
    contact and what the whole multipliers move, as it does for a body that only contact holds, costs no digits.

    Parameters
    ----------
    compliance
        (c (1 + k), c (1 + k)): normals first, then the tangential directions row by row.
    free
        (c (1 + k),) gaps and slips under the carried multipliers.
    law
        The conditions on the slip.
    reach
        (c,) compliance of each normal; ``give`` (c,) that of each row along its surface.
    carried
        (c (1 + k),) multipliers.
    rounding
        What the last digits of positions make of gaps and slips.
    """

    compliance: Array
    free: Array
    law: Slipping
    reach: Array
    give: Array
    carried: Array
    rounding: float = 0.0

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.reach)

    def split(self, x: Array) -> tuple[Array, Array]:
        """Normal (c,) and tangential (c, k) parts."""
        return x[: self.count], x[self.count :].reshape(self.law.shift.shape)

    def whole(self, x: Array) -> tuple[Array, Array]:
        """Normal (c,) and tangential (c, k) multipliers after the changes x."""
        return self.split(self.carried + x)

    def drawn(self, x: Array, share: float) -> "Touching":
        """The problem whose multipliers are drawn to those after x: rows give way by a share more of what they do.

        Rows that depend on each other have one solution there, and x solves it if it solves this one.
        """
        more = share * np.concatenate([self.reach, np.repeat(self.give, self.law.shift.shape[1])])
        return replace(
            self,
            compliance=self.compliance + np.diag(more),
            free=self.free - more * x,
            reach=(1.0 + share) * self.reach,
            give=(1.0 + share) * self.give,
        )


def touching(
    compliance: Array, free: Array, law: Slipping, carried: Array | None = None, rounding: float = 0.0
) -> Touching:
    """The contact problem of rows with their compliance, and with gaps and slips under the ``carried`` multipliers.

    Raises
    ------
    NoConvergence
        If rows give way against every force, as they do where crushed matter has no stable tangent.
    """
    count, k = law.shift.shape
    diagonal = np.diag(compliance)
    if count and not diagonal[:count].max() > 0.0:
        raise NoConvergence(f"{count} contact rows give way against their forces (a tangent of crushed cells)")
    give = diagonal[count:].reshape(count, k).mean(axis=1)
    least = 1e-12 * max(float(diagonal.max(initial=0.0)), 1e-300)
    return Touching(
        compliance=compliance,
        free=free,
        law=law,
        reach=np.maximum(diagonal[:count], least),
        give=np.maximum(give, least),
        carried=np.zeros(len(free)) if carried is None else carried,
        rounding=rounding,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Look:
    """The conditions at some multipliers: what they miss (c (1 + k),), in units of y, and what of it is rounding of the
    multipliers; rows that touch and slip (c,); directions (c, k) of the trials; slopes (c, k, k) of the forces to the
    trials and (c,) to the normal multipliers.
    """

    missed: Array
    rounding: Array
    touch: BoolArray
    slips: BoolArray
    way: Array
    slope: Array
    share: Array

    @property
    def worst(self) -> float:
        """Greatest violation beyond rounding."""
        return float(np.maximum(np.abs(self.missed) - self.rounding, 0.0).max(initial=0.0))


def looked(problem: Touching, x: Array) -> Look:
    """The conditions after the changes x (c (1 + k),)."""
    p, s = problem.whole(x)
    gap, slip = problem.split(problem.free + problem.compliance @ x)
    k = s.shape[1]
    touch = p - gap / problem.reach > 0.0
    trial = s - slip / problem.give[:, None]
    size = np.linalg.norm(trial, axis=1)
    way = trial / np.maximum(size, 1e-300)[:, None]
    found = returned(problem.law, size, np.maximum(p, 0.0), 1.0 / problem.give)
    slips = touch & found.slips
    missed_s = np.where(slips[:, None], (s - found.force[:, None] * way) * problem.give[:, None], slip)
    missed_p = np.where(touch, gap, p * problem.reach)
    missed_s = np.where(touch[:, None], missed_s, s * problem.give[:, None])
    turn = np.where(size > 0.0, found.force / np.maximum(size, 1e-300), 0.0)[:, None, None]
    along = way[:, :, None] * way[:, None, :]
    rounding_s = np.where(touch & ~slips, 0.0, EPS * np.linalg.norm(s, axis=1) * problem.give)
    return Look(
        missed=np.concatenate([missed_p, missed_s.ravel()]),
        rounding=np.concatenate([np.where(touch, 0.0, EPS * np.abs(p) * problem.reach), np.repeat(rounding_s, k)]),
        touch=touch,
        slips=slips,
        way=way,
        slope=turn * (np.eye(k) - along) + found.steep[:, None, None] * along,
        share=found.share,
    )


def linearised(problem: Touching, look: Look) -> Array:
    """Derivatives (c (1 + k), c (1 + k)) of what the conditions miss."""
    c, W, touch, slips = problem.count, problem.compliance, look.touch, look.slips
    k = look.way.shape[1]
    diagonal = np.arange(c)
    places = c + k * diagonal[:, None] + np.arange(k)
    matrix = W.copy()
    matrix[:c][~touch], matrix[places[~touch].ravel()] = 0.0, 0.0
    matrix[diagonal, diagonal] += np.where(touch, LIFT, 1.0) * problem.reach
    matrix[places, places] += (np.where(touch, LIFT, 1.0) * problem.give)[:, None]
    at, give, slope = places[slips], problem.give[slips][:, None, None], look.slope[slips]
    matrix[at] = np.einsum("cij,cjn->cin", slope, W[at]) if k > 1 else slope * W[at]
    matrix[at[:, :, None], at[:, None, :]] += give * (np.eye(k) - slope)
    matrix[at, diagonal[slips][:, None]] -= give[:, 0] * look.share[slips, None] * look.way[slips]
    return matrix


def swept(problem: Touching, x: Array, count: int) -> Array:
    """Changes of the multipliers after some sweeps: each row in turn meets its conditions (Gauss-Seidel)."""
    c, W = problem.count, problem.compliance
    x, carried = x.copy(), problem.carried
    k = (len(x) - c) // c
    parts = [problem.law.part(np.array([i])) for i in range(c)]
    for _ in range(count):
        for i in range(c):
            at = c + k * i + np.arange(k)
            gap = problem.free[i] + W[i] @ x
            x[i] = max(x[i] - gap / problem.reach[i], -carried[i])
            slip = problem.free[at] + W[at] @ x
            soft = max(float(np.linalg.eigvalsh(W[np.ix_(at, at)]).max(initial=0.0)), 1e-12 * problem.give[i])
            if not soft > 0.0:
                raise NoConvergence(f"a contact row has the compliance {soft:g} along the surface")
            stiff = 1.0 / soft
            trial = carried[at] + x[at] - stiff * slip
            size = np.linalg.norm(trial)
            pressed = np.maximum(carried[i : i + 1] + x[i : i + 1], 0.0)
            force = returned(parts[i], np.array([size]), pressed, np.array([stiff])).force[0]
            x[at] = force * trial / max(size, 1e-300) - carried[at]
    return x
