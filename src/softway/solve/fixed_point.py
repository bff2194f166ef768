"""The fixed point with a frozen operator: every iteration is one back-substitution and a small contact problem."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.bodies.past import remembering
from softway.errors import InputError
from softway.solve.anderson import Anderson
from softway.solve.carry import Carry
from softway.solve.correction import corrected
from softway.solve.driver import Iterate, lost
from softway.solve.frozen import Frozen
from softway.solve.newton import Newton
from softway.solve.normal import untouched
from softway.solve.operators import Factored, MatrixFree, Multigrid
from softway.solve.prepared import prepared
from softway.solve.settings import check_accuracy
from softway.solve.soundness import looked_at
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.typing import Array, BoolArray

POOR = 0.8
"""Contraction per iteration beyond which Newton's method takes over."""
WINDOW = 10
"""Iterations over which the contraction is judged."""
FLOWING, PACE = 5, 0.3
"""The same without inertia, which carries no operator from slab to slab: how many iterations, and how poor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedPoint:
    """``q <- q - P r(q)`` with a frozen operator P and contact on its compliance, accelerated by Anderson mixing.

    The mixing starts afresh where the contact changes, and where two steps in a row bring nothing.  Where the iterates
    contract poorly, Newton's method goes on from there.

    Parameters
    ----------
    depth
        Iterates that the acceleration looks back on; 0 is the plain fixed point.
    tolerance
        Change of velocity, relative to the greatest velocity, at which an iterate is accepted.
    limit
        Iterations after which the operator is renewed, and then the slab rejected.
    operator
        What P is; by default chosen by size, length of the slab, shape and memory.
    handover
        Whether Newton's method takes over where the iterates contract poorly.

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
    operator: Factored | MatrixFree | Multigrid | Literal["auto"] = "auto"
    handover: bool = True

    def __post_init__(self) -> None:
        if self.depth < 0:
            raise InputError("depth", f"{self.depth} is negative", "0 for the plain fixed point, or about 8")
        check_accuracy(self.tolerance, self.limit)

    def iterate(
        self, system: SlabSystem, q: Array, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        """Iterates from q (n, d), with first impulses (m,) and active rows (m,) of the contact.

        The first step is without scalar, as that of Newton's method is: the guess is no solution, and the work that is
        missing there says nothing.  So it solves a linear law on fixed rows (docs/theory/solver.md).
        """
        newton = Newton(tolerance=self.tolerance, limit=self.limit)
        if self.handover and carry.origin is None and _starts_flowing(system):
            yield from newton.iterate(system, q, carry, impulse, active)
            return
        carry = prepared(system, q, carry, self.operator)
        it: Iterate | None = None
        for it in self._onward(system, q, carry, impulse, active):
            yield it
        if self.handover and it is not None and np.isfinite(it.change):
            yield from newton.onward(it.system, it.q, it.carry, it.impulse, it.active)

    def _onward(
        self, system: SlabSystem, q: Array, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        """Iterates as long as they contract well; where they do not, nodes are first kept on their faces."""
        window, poor = (WINDOW, POOR) if system.model.massive.any() else (FLOWING, PACE)
        end = replace(system, balanced=False).evaluate(q, impulse)
        while True:
            changes: list[float] = []
            for it in self._iterates(system, q, end, carry, impulse, active):
                yield it
                changes = [*changes[-window:], it.change]
                if self.handover and len(changes) > window and it.change > poor**window * changes[0]:
                    break
            if not np.isfinite(it.change):
                return
            system = it.system.held(it.system.path.end(it.q), it.active)
            if system is it.system:
                return
            q, carry, impulse, active = it.q, it.carry, it.impulse, it.active
            end = system.evaluate(q, impulse)

    def _iterates(
        self, system: SlabSystem, q: Array, end: Evaluation, carry: Carry, impulse: Array, active: BoolArray
    ) -> Iterator[Iterate]:
        frozen = carry.frozen
        assert frozen is not None
        keep = system.model.free
        mixing = _Mixing(Anderson(self.depth), frozen)
        last, stuck = np.inf, 0
        for count in itertools.count():
            system = system.steadied(end.displacement, active, count)
            if not np.isfinite(end.residual[keep]).all():
                yield lost(q, active, carry, system)
                return
            step = corrected(system, frozen, q, end, impulse, active)
            if count == 0:
                plain = step.rows.along(untouched(step.free, frozen, step.rows.spread(impulse)))
            change = float(np.abs(step.q - q).max(initial=0.0))
            sound, completed = looked_at(system, step.q, change)
            yield Iterate(
                q=step.q,
                change=change,
                impulse=step.impulse,
                active=step.active,
                free=plain,
                carry=carry,
                system=system,
                sound=sound,
            )
            system = completed
            stuck = stuck + 1 if change > 0.99 * last else 0
            if (step.active != active).any() or stuck >= 2:
                mixing.accelerator.restart()
                stuck = 0
            last, active, before, q = change, step.active, q[keep], q.copy()
            q[keep], impulse = mixing.mixed((before, impulse), (step.q[keep], step.impulse))
            end = system.evaluate(q, impulse)


def _starts_flowing(system: SlabSystem) -> bool:
    """Whether nothing is known of how matter without inertia will flow: no operator made at rest fits."""
    return remembering(system.model.parts) and not system.model.massive.any()


@dataclass(frozen=True, slots=True, eq=False)
class _Mixing:
    """The accelerator of iterates: of the velocities, and of the impulses too where the operator leaves them behind."""

    accelerator: Anderson
    frozen: Frozen

    def mixed(self, x: tuple[Array, Array], value: tuple[Array, Array]) -> tuple[Array, Array]:
        """The next velocities (f,) and impulses (m,), from those that the map was given and those that it gave."""
        if self.frozen.exact:
            return self.accelerator.mix(x[0], value[0]), value[1]
        unit = float(np.abs(self.frozen.answer(np.ones(self.frozen.basis.directions.shape[1]))).max(initial=0.0))
        scale = np.concatenate([np.ones(len(x[0])), np.full(len(x[1]), unit)])
        found = self.accelerator.mix(scale * np.concatenate(x), scale * np.concatenate(value))
        return found[: len(x[0])], found[len(x[0]) :] / max(unit, 1e-300)
