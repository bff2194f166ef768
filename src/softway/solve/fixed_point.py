"""The fixed point with a frozen operator: every iteration is one back-substitution and a small contact problem."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.errors import InputError
from softway.solve.driver import Iterate, lost
from softway.solve.frozen import Carry, freeze
from softway.solve.linear import LinearSolver, SuperLU
from softway.solve.normal import constrain
from softway.solve.system import SlabSystem
from softway.typing import Array

NEARLY = 1e-7
"""Relative change of velocity below which kept faces are compared with the surface."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedPoint:
    """``q <- q - A0^-1 r(q)`` with contact on the compliance of A0, accelerated by Anderson mixing.

    The mixing starts afresh where the contact changes, and where two steps in a row bring nothing.

    Parameters
    ----------
    depth
        Iterates that the acceleration looks back on; 0 is the plain fixed point.
    tolerance
        Change of velocity, relative to the greatest velocity, at which an iterate is accepted.
    limit
        Iterations after which the operator is renewed, and then the slab rejected.

    References
    ----------
    Anderson (1965), J. ACM 12, 547-560; Walker, Ni (2011), SIAM J. Numer. Anal. 49, 1715-1735.

    Examples
    --------
    >>> FixedPoint(depth=0).depth
    0
    """

    depth: int = 8
    tolerance: float = 1e-11
    limit: int = 60

    def __post_init__(self) -> None:
        if self.depth < 0:
            raise InputError("depth", f"{self.depth} is negative", "0 for the plain fixed point, or about 8")
        if not 0.0 < self.tolerance < 1e-2:
            raise InputError("tolerance", f"{self.tolerance:g}", "a number between 1e-14 and 1e-2")
        if self.limit < 1:
            raise InputError("limit", f"{self.limit} iterations", "at least 1")

    def iterate(
        self, system: SlabSystem, q: Array, carry: Carry, guess: Array, solver: LinearSolver = SuperLU()
    ) -> Iterator[Iterate]:
        """Iterates from q (n, d), with ``guess`` (m,) as first impulses of the contact rows."""
        active = guess != 0.0
        carry = prepared(system, carry, solver)
        frozen = carry.frozen
        assert frozen is not None
        keep = system.model.free
        memory = _Anderson(self.depth)
        impulse, last, stuck = guess, np.inf, 0
        for count in itertools.count():
            end = system.evaluate(q, impulse)
            system = system.steadied(end.displacement, count)
            residual = end.residual[keep]
            if not np.isfinite(residual).all():
                yield lost(q, active, carry, system)
                return
            free = q[keep] - frozen.solve(residual)
            rows, conditions = system.conditions(q, end, frozen.basis)
            solved, impulse, now = constrain(free, frozen, rows, conditions, active)
            new = system.filled()
            new[keep] = solved
            change = float(np.abs(new - q).max(initial=0.0))
            sound, completed = _looked_at(system, new, change)
            yield Iterate(
                q=new,
                change=change,
                impulse=impulse,
                active=now,
                free=rows @ frozen.sense(free),
                carry=carry,
                system=system,
                sound=sound,
            )
            system = completed
            stuck = stuck + 1 if change > 0.99 * last else 0
            if (now != active).any() or stuck >= 2:
                memory, stuck = _Anderson(self.depth), 0
            last, active, q = change, now, q.copy()
            q[keep] = memory.mix(q[keep], solved)


def _looked_at(system: SlabSystem, q: Array, change: float) -> tuple[bool, SlabSystem]:
    """Whether an iterate leaves no overlap, and the equations to go on with: overlapped faces are added."""
    if system.pairs is system.searched:
        return True, system
    if change > NEARLY * np.abs(q).max(initial=0.0):
        return False, system
    u1 = system.path.end(q)
    sound = system.sound(u1)
    return sound, system if sound else system.completed(u1)


def prepared(system: SlabSystem, carry: Carry, solver: LinearSolver) -> Carry:
    """The carry with a frozen operator that fits the slab, renewed when it does not."""
    if carry.frozen is not None and not carry.stale and abs(carry.span / system.path.span - 1.0) < 1e-9:
        return carry
    frozen = freeze(system.operator(system.start.displacement), system.directions(), solver)
    return replace(carry, frozen=frozen, span=system.path.span, stale=False, factorisations=carry.factorisations + 1)


class _Anderson:
    """Mixing of the last iterates: the combination whose residual is least."""

    __slots__ = ("depth", "points", "values")

    def __init__(self, depth: int) -> None:
        self.depth = depth
        self.points: list[Array] = []
        self.values: list[Array] = []

    def mix(self, x: Array, g: Array) -> Array:
        """The next point, from the argument ``x`` of the map and its value ``g``."""
        if self.depth == 0:
            return g
        self.points, self.values = [*self.points, x][-self.depth - 1 :], [*self.values, g][-self.depth - 1 :]
        if len(self.points) < 2:
            return g
        f = np.array(self.values) - np.array(self.points)
        df = np.diff(f, axis=0).T
        gamma = np.linalg.lstsq(df, f[-1], rcond=1e-10)[0]
        mixed: Array = g - np.diff(np.array(self.values), axis=0).T @ gamma
        return mixed
