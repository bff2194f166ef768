"""Newton's method: the operator is renewed at every iterate."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.vector_space import VectorSpace
from softway.solve.checks import check_accuracy
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.methods.contact_step import contact_step
from softway.solve.methods.facet_check import check_facets
from softway.solve.methods.iteration import Guess, Iterate, lost
from softway.solve.methods.late_mixing import LateMixing
from softway.solve.operators.factored import Factored
from softway.solve.operators.operator_memory import IterationCount, OperatorMemory, OperatorOrigin
from softway.solve.operators.operator_refresh import analyst, announce

HALVINGS = 6
"""Greatest number of halvings of a Newton step."""
STRETCH = 3.0
"""Factor by which a step grows while the next correction has the same direction."""
STRETCHES = 40
"""Greatest number of such extensions."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Newton:
    """``q <- q - alpha A(q)^-1 r(q)`` with contact on the compliance of the current operator.

    The step is halved while the next correction by the same operator would be longer than this one (natural
    monotonicity test), and taken in full if this never ends.  The scalar of the Energy rule is lagged in the operator.
    Iterates that converge slowly by positive definite operators in place of indefinite ones are mixed.

    Parameters
    ----------
    tolerance
        Change of velocity, relative to the greatest velocity, below which an iterate is accepted.
    limit
        Number of iterations after which the slab is rejected.
    renew
        Renewal of the operator: at every ``iterate``, or at the first one of a ``slab`` (modified Newton method).
    operator
        Settings of the factor.
    handover
        True if the fixed point tries a slab in which these iterates do not converge, before it is shortened.

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
    handover: bool = True

    def __post_init__(self) -> None:
        check_accuracy(self.tolerance, self.limit)

    def iterate(self, system: SlabEquations, guess: Guess) -> Iterator[Iterate]:
        """Iterates from a guess.

        The first step has no scalar: the massless nodes are not yet in equilibrium, and the missing work has no
        meaning.
        """
        yield from self._iterates(system, guess, system.without_closure().evaluate(guess.q, guess.impulse))

    def onward(self, system: SlabEquations, guess: Guess) -> Iterator[Iterate]:
        """Iterates from the last iterate of another method."""
        yield from self._iterates(system, guess, system.evaluate(guess.q, guess.impulse))

    def _iterates(self, system: SlabEquations, guess: Guess, end: Evaluation) -> Iterator[Iterate]:
        q, impulse, active, memory = guess.q, guess.impulse, guess.active, guess.memory
        space, mixing = system.model.space, LateMixing.of(system)
        for count in itertools.count():
            system = system.with_kept_facets_after(end.displacement, active, count)
            if not space.every(np.isfinite(end.residual)):
                yield lost(Guess(q=q, impulse=impulse, active=active, memory=memory), system)
                return
            if self.renew == "iterate" or count == 0:
                memory = self._renewed(system, memory, end)
            frozen = memory.frozen
            assert frozen is not None
            found = contact_step(system, frozen, q, end, impulse, active)
            before, step = q, found.q - q
            kept, active = bool((found.active == active).all()), found.active
            q, end = self._line_searched(system, q, step, found.impulse, frozen)
            change = space.greatest(step)
            sound, completed = check_facets(system, q, change)
            yield Iterate(
                q=q,
                change=change,
                impulse=found.impulse,
                active=active,
                free=found.bare(),
                memory=memory,
                system=system,
                sound=sound,
            )
            if completed is not system:
                system, end = completed, completed.evaluate(q, found.impulse)
            impulse = found.impulse
            if mixing.steady(change, kept):
                q, impulse, end = mixing.mixed(system, before, q, impulse) or (q, impulse, end)

    def _renewed(self, system: SlabEquations, memory: OperatorMemory, end: Evaluation) -> OperatorMemory:
        """Operator memory with the operator at the end of the slab; later slabs may use it."""
        announce(system, self.operator)
        made = self.operator.make(system.stiffness, end.displacement, memory.analysis)
        system.effort.factored(made.factor)
        return replace(
            memory,
            frozen=made.frozen(system.directions()),
            analysis=made.analysis,
            origin=OperatorOrigin.of(system, end.displacement, self.operator, analyst(memory, made, self.operator)),
            span=system.equivalent_span,
            factorisations=memory.factorisations + 1,
            taken=IterationCount(),
            price=made.price,
        )

    def _line_searched(
        self, system: SlabEquations, q: Array, step: Array, impulse: Array, frozen: FrozenOperator
    ) -> tuple[Array, Evaluation]:
        """Next iterate by line search along the step (n, d), and its evaluation.

        If no fraction of the step passes the test, it is taken in full: at kinks short steps would never arrive.
        """
        space, unknowns = system.model.space, system.model.dofs.unknowns(step)
        length, fraction, full = space.norm(step), 1.0, None
        for _ in range(HALVINGS):
            new = q + fraction * step
            end = system.evaluate(new, impulse)
            if length == 0.0:
                return new, end
            if space.every(np.isfinite(end.residual)):
                left = _left(system, new, end, impulse, frozen)
                if space.norm(left) <= max(1.0 - 0.5 * fraction, 1e-2) * length:
                    return new, end
                if fraction == 1.0 and _alike(space, left, unknowns):
                    return self._stretched(system, q, step, impulse, frozen)
                full = (new, end) if fraction == 1.0 else full
            fraction *= 0.5
        return full or (q + fraction * step, system.evaluate(q + fraction * step, impulse))

    def _stretched(
        self, system: SlabEquations, q: Array, step: Array, impulse: Array, frozen: FrozenOperator
    ) -> tuple[Array, Evaluation]:
        """Next iterate beyond the step, as far as the next correction keeps its direction.

        This starts flow from rest, where a viscosity that decreases with the strain rate is far too high.
        """
        fraction, found, space = 1.0, q + step, system.model.space
        best = system.evaluate(found, impulse)
        for _ in range(STRETCHES):
            fraction *= STRETCH
            new = q + fraction * step
            end = system.evaluate(new, impulse)
            if not space.every(np.isfinite(end.residual)):
                break
            if not _alike(space, _left(system, new, end, impulse, frozen), system.model.dofs.unknowns(step), least=0.0):
                break
            found, best = new, end
        return found, best


def _left(system: SlabEquations, q: Array, end: Evaluation, impulse: Array, frozen: FrozenOperator) -> Array:
    """Next correction (f,) by the same operator."""
    rows, _ = system.conditions(q, end, frozen)
    return frozen.solve(system.model.dofs.forces(end.residual) - frozen.prolong(rows.spread(impulse)))


def _alike(space: VectorSpace, left: Array, step: Array, least: float = 0.5) -> bool:
    """True if a correction (f,), to be subtracted, continues a step (f,) with at least a fraction of its length."""
    progress = -space.dot(left, step)
    return progress > max(least * space.dot(step, step), 0.9 * space.norm(left) * space.norm(step))
