"""Newton's method: the operator is renewed at every iterate."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.solve.carry import Carry, Origin, Taken
from softway.solve.correction import corrected
from softway.solve.driver import Iterate, lost
from softway.solve.frozen import Frozen
from softway.solve.normal import untouched
from softway.solve.operators.factored import Factored
from softway.solve.prepared import analyst
from softway.solve.settings import check_accuracy
from softway.solve.soundness import looked_at
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.typing import Array, BoolArray

HALVINGS = 6
"""Halvings of a Newton step, after which it is taken as it is."""
STRETCH = 3.0
"""Factor by which a step grows while the next correction would go on in its direction."""
STRETCHES = 40
"""How often it may grow."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Newton:
    """``q <- q - alpha A(q)^-1 r(q)`` with contact on the compliance of the current operator.

    The step is halved while the next correction by the same operator would be longer than this one (natural
    monotonicity test).  The scalar of the Energy rule is lagged in the operator.

    Parameters
    ----------
    tolerance
        Change of velocity, relative to the greatest velocity, at which an iterate is accepted.
    limit
        Iterations after which the slab is rejected.
    renew
        When the operator is renewed: at every ``iterate``, or at the first one of a ``slab`` (modified Newton method).
    operator
        How the operator is made.

    References
    ----------
    Deuflhard (2011), Newton methods for nonlinear problems, 3.3.

    Examples
    --------
    >>> Newton().limit
    40
    """

    tolerance: float = 1e-11
    limit: int = 40
    renew: Literal["iterate", "slab"] = "iterate"
    operator: Factored = Factored(precision="double")

    def __post_init__(self) -> None:
        check_accuracy(self.tolerance, self.limit)

    def iterate(
        self, system: SlabSystem, q: Array, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        """Iterates from q (n, d), with first impulses (m,) and active rows (m,) of the contact.

        The first step is without scalar: before it the nodes without inertia are in no equilibrium, and the work that
        is missing says nothing.
        """
        end = replace(system, balanced=False).evaluate(q, impulse)
        yield from self._iterates(system, q, end, carry, impulse, active)

    def onward(
        self, system: SlabSystem, q: Array, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        """Iterates from one of another method."""
        yield from self._iterates(system, q, system.evaluate(q, impulse), carry, impulse, active)

    def _iterates(
        self, system: SlabSystem, q: Array, end: Evaluation, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        for count in itertools.count():
            system = system.steadied(end.displacement, active, count)
            if not np.isfinite(end.residual).all():
                yield lost(q, active, carry, system)
                return
            if self.renew == "iterate" or count == 0:
                carry = self._renewed(system, carry, end)
            frozen = carry.frozen
            assert frozen is not None
            found = corrected(system, frozen, q, end, impulse, active)
            step, active = found.q - q, found.active
            q, end = self._searched(system, q, step, found.impulse, frozen)
            change = float(np.abs(step).max(initial=0.0))
            sound, completed = looked_at(system, q, change)
            yield Iterate(
                q=q,
                change=change,
                impulse=found.impulse,
                active=active,
                free=found.rows.along(untouched(found.free, frozen, found.rows.spread(impulse))),
                carry=carry,
                system=system,
                sound=sound,
            )
            if completed is not system:
                system, end = completed, completed.evaluate(q, found.impulse)
            impulse = found.impulse

    def _renewed(self, system: SlabSystem, carry: Carry, end: Evaluation) -> Carry:
        """The carry with the operator at the end of the slab; later slabs may go on with it."""
        made = self.operator.make(system.stiffness, end.displacement, carry.analysis)
        return replace(
            carry,
            frozen=made.frozen(system.directions()),
            analysis=made.analysis,
            origin=Origin.of(system, end.displacement, self.operator, analyst(carry, made, self.operator)),
            span=system.reach,
            factorisations=carry.factorisations + 1,
            taken=Taken(),
            price=made.price,
        )

    def _searched(
        self, system: SlabSystem, q: Array, step: Array, impulse: Array, frozen: Frozen
    ) -> tuple[Array, Evaluation]:
        """The next iterate on the way of the step (n, d), and its evaluation."""
        length, share = float(np.linalg.norm(step)), 1.0
        for halvings in itertools.count():
            new = q + share * step
            end = system.evaluate(new, impulse)
            if halvings == HALVINGS or length == 0.0:
                return new, end
            if np.isfinite(end.residual).all():
                left = _left(system, new, end, impulse, frozen)
                if np.linalg.norm(left) <= max(1.0 - 0.5 * share, 1e-2) * length:
                    return new, end
                if share == 1.0 and _alike(left, step[system.model.free]):
                    return self._stretched(system, q, step, impulse, frozen)
            share *= 0.5
        raise AssertionError

    def _stretched(
        self, system: SlabSystem, q: Array, step: Array, impulse: Array, frozen: Frozen
    ) -> tuple[Array, Evaluation]:
        """The next iterate beyond the step, as far as the next correction keeps its direction.

        So flow starts from rest, where a viscosity that falls with the rate is far too great.
        """
        share, found = 1.0, q + step
        best = system.evaluate(found, impulse)
        for _ in range(STRETCHES):
            share *= STRETCH
            new = q + share * step
            end = system.evaluate(new, impulse)
            if not np.isfinite(end.residual).all():
                break
            if not _alike(_left(system, new, end, impulse, frozen), step[system.model.free], least=0.0):
                break
            found, best = new, end
        return found, best


def _left(system: SlabSystem, q: Array, end: Evaluation, impulse: Array, frozen: Frozen) -> Array:
    """The correction (f,) that the same operator would make next."""
    rows, _ = system.conditions(q, end, frozen)
    return frozen.solve(end.residual[system.model.free] - frozen.push(rows.spread(impulse)))


def _alike(left: Array, step: Array, least: float = 0.5) -> bool:
    """Whether a correction (f,), to be subtracted, goes on along a step (f,), with at least a share of its length."""
    along = -float(left @ step)
    return along > max(least * float(step @ step), 0.9 * float(np.linalg.norm(left) * np.linalg.norm(step)))
