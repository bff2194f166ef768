"""Newton's method: the operator is renewed at every iterate, for comparison with the fixed point."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.solve.driver import Iterate, lost
from softway.solve.frozen import Carry, freeze
from softway.solve.linear import LinearSolver, SuperLU
from softway.solve.normal import constrain
from softway.solve.system import SlabSystem
from softway.typing import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Newton:
    """``q <- q - A(q)^-1 r(q)`` with contact on the compliance of the current operator.

    The scalar of the Energy rule is lagged in the operator.

    Parameters
    ----------
    tolerance
        Change of velocity, relative to the greatest velocity, at which an iterate is accepted.
    limit
        Iterations after which the slab is rejected.

    Examples
    --------
    >>> Newton().limit
    40
    """

    tolerance: float = 1e-11
    limit: int = 40

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance < 1e-2:
            raise InputError("tolerance", f"{self.tolerance:g}", "a number between 1e-14 and 1e-2")
        if self.limit < 1:
            raise InputError("limit", f"{self.limit} iterations", "at least 1")

    def iterate(
        self, system: SlabSystem, q: Array, carry: Carry, guess: Array, solver: LinearSolver = SuperLU()
    ) -> Iterator[Iterate]:
        """Iterates from q (n, d), with ``guess`` (m,) as first impulses of the contact rows."""
        active = guess != 0.0
        keep, directions, impulse = system.model.free, system.directions(), guess
        for count in itertools.count():
            end = system.evaluate(q, impulse)
            system = system.steadied(end.displacement, count)
            if not np.isfinite(end.residual).all():
                yield lost(q, active, carry, system)
                return
            matrix, rows = system.conditions(q, end, directions)
            frozen = freeze(system.operator(end.displacement), directions, solver)
            carry = Carry(frozen=frozen, span=system.path.span, stale=True, factorisations=carry.factorisations + 1)
            free = q[keep] - frozen.solve(end.residual[keep])
            solved, impulse, active = constrain(free, frozen, matrix, rows, active)
            new = system.filled()
            new[keep] = solved
            change = float(np.abs(new - q).max(initial=0.0))
            yield Iterate(
                q=new,
                change=change,
                impulse=impulse,
                active=active,
                free=matrix @ frozen.sense(free),
                carry=carry,
                system=system,
                sound=True,
            )
            q = new
