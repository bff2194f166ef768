"""The contact problem of the rows that touch: its conditions, their linearisation, sweeps over it, problems near it."""

from dataclasses import dataclass, replace

import numpy as np

from softway.errors import NoConvergence
from softway.solve.return_map import Slipping, returned
from softway.typing import Array, BoolArray

LIFT = 1e-12
"""Share of the compliance by which rows that depend on each other are told apart."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Touching:
    """The contact problem of some rows (c,), with k tangential directions each.

    Parameters
    ----------
    compliance
        (c (1 + k), c (1 + k)): normals first, then the tangential directions row by row.
    free
        (c (1 + k),) gaps and slips without contact force.
    law
        The conditions on the slip.
    reach
        (c,) compliance of each normal; ``give`` (c,) that of each row along its surface.
    """

    compliance: Array
    free: Array
    law: Slipping
    reach: Array
    give: Array

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self.reach)

    def split(self, x: Array) -> tuple[Array, Array]:
        """Normal (c,) and tangential (c, k) parts."""
        return x[: self.count], x[self.count :].reshape(self.law.shift.shape)

    def drawn(self, x: Array, share: float) -> "Touching":
        """The problem whose multipliers are drawn to x (c (1 + k),): rows give way by a share more of what they do.

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


def touching(compliance: Array, free: Array, law: Slipping) -> Touching:
    """The contact problem of rows with their compliance.

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
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Look:
    """The conditions at some multipliers: what they miss (c (1 + k),), in units of y; rows that touch and slip (c,);
    directions (c, k) of the trials; slopes (c, k, k) of the forces to the trials and (c,) to the normal multipliers.
    """

    missed: Array
    touch: BoolArray
    slips: BoolArray
    way: Array
    slope: Array
    share: Array

    @property
    def worst(self) -> float:
        """Greatest violation."""
        return float(np.abs(self.missed).max(initial=0.0))


def looked(problem: Touching, x: Array) -> Look:
    """The conditions at multipliers x (c (1 + k),)."""
    p, s = problem.split(x)
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
    return Look(
        missed=np.concatenate([missed_p, missed_s.ravel()]),
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
    """Multipliers after some sweeps: each row in turn meets its conditions while the others wait (Gauss-Seidel)."""
    c, W = problem.count, problem.compliance
    x = x.copy()
    k = (len(x) - c) // c
    parts = [problem.law.part(np.array([i])) for i in range(c)]
    for _ in range(count):
        for i in range(c):
            at = c + k * i + np.arange(k)
            gap = problem.free[i] + W[i] @ x
            x[i] = max(x[i] - gap / problem.reach[i], 0.0)
            slip = problem.free[at] + W[at] @ x
            soft = max(float(np.linalg.eigvalsh(W[np.ix_(at, at)]).max(initial=0.0)), 1e-12 * problem.give[i])
            if not soft > 0.0:
                raise NoConvergence(f"a contact row has the compliance {soft:g} along the surface")
            stiff = 1.0 / soft
            trial = x[at] - stiff * slip
            size = np.linalg.norm(trial)
            force = returned(parts[i], np.array([size]), x[i : i + 1], np.array([stiff])).force[0]
            x[at] = force * trial / max(size, 1e-300)
    return x
