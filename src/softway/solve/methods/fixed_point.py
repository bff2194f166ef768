"""Fixed point with a frozen operator: every iteration is one back-substitution and a small contact problem."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.material_states import any_path_dependent
from softway.bodies.assembled.vector_space import VectorSpace
from softway.errors import InputError
from softway.solve.checks import check_accuracy
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.methods.anderson import Anderson
from softway.solve.methods.contact_step import ContactStep
from softway.solve.methods.eliminated_step import contact_steps, pushed_exactly
from softway.solve.methods.facet_check import check_facets
from softway.solve.methods.iteration import Guess, Iterate, lost
from softway.solve.methods.newton import Newton
from softway.solve.methods.one_solution import FirstResidual
from softway.solve.methods.renewal import RETREATS, WINDOW, Course
from softway.solve.operators import ConjugateGradients, Device, Factored, MatrixFree, Multigrid
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.operators.operator_refresh import refreshed, renewed_inside

POOR = 0.8
"""Contraction per iteration above which Newton's method takes over."""
LEAST, SWING = 0.125, 0.9
"""Least part of a step, and ratio of successive changes above which a step is shortened."""
FLOWING, PACE = 5, 0.3
"""Number of iterations and contraction without inertia, where operators do not serve many slabs."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedPoint:
    """``q <- q - P r(q)`` with a frozen operator P and contact on its compliance, accelerated by Anderson mixing.

    The mixing restarts if the contact changes, and after two successive steps without progress.  If the iterates
    contract poorly or go astray, the operator is renewed at one of them, or Newton's method takes over.

    Parameters
    ----------
    depth
        Number of previous iterates for the acceleration; 0 for the plain fixed point.
    tolerance
        Change of velocity, relative to the greatest velocity, below which an iterate is accepted.
    limit
        Number of iterations after which the slab is tried again with a new operator, and then rejected.
    operator
        Kind of operator P; by default chosen by number of unknowns, slab length, shape and memory.
    handover
        True if the operator is renewed inside a slab, or Newton's method takes over, when the iterates contract poorly.

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
    operator: Factored | ConjugateGradients | Device | MatrixFree | Multigrid | Literal["auto"] = "auto"
    handover: bool = True

    def __post_init__(self) -> None:
        if self.depth < 0:
            raise InputError("depth", f"{self.depth} is negative", "0 for the plain fixed point, or about 8")
        check_accuracy(self.tolerance, self.limit)

    def iterate(self, system: SlabEquations, guess: Guess) -> Iterator[Iterate]:
        """Iterates from a guess; where they contract poorly, with a new operator, or with nodes kept on their facets
        and then by Newton's method; where they go astray, from the closest one before.  Without inertia, and on
        redundant rows of crossing edges, changes rise and fall on the way to a solution: there none is astray.

        As in Newton's method, the first step has no scalar where the guess is no solution: its missing work has no
        meaning.  So one step solves a linear law on fixed rows (docs/theory/solver/solver.md).
        """
        newton = Newton(tolerance=self.tolerance, limit=self.limit)
        if self.handover and guess.memory.origin is None and _starts_flowing(system):
            yield from newton.iterate(system, guess)
            return
        guess = replace(guess, memory=refreshed(system, guess.q, guess.memory, self.operator))
        end = (system if guess.near else system.without_closure()).evaluate(guess.q, guess.impulse)
        window, slow = (WINDOW, POOR) if system.model.inert else (FLOWING, PACE)
        turns = self.handover and system.model.inert and not system.model.contacts.crossing_edges
        course = Course(window=window, retreats=0 if turns else RETREATS)
        while True:
            for it in self._iterates(system, guess, end):
                course = course.after(it)
                if course.way_back is not None:
                    break
                yield it
                if self._leaves_operator(it, course, slow):
                    break
            back = course.way_back
            it = back or it
            if not np.isfinite(it.change):
                return
            renews = course.contraction <= slow if back is None else course.retreats == 0
            system, guess = it.system, it.guess
            if renews:
                guess = replace(guess, memory=renewed_inside(system, guess.q, guess.memory, self.operator))
            elif back is None:
                system = system.with_kept_facets(system.path.end(guess.q), guess.active)
            if not renews and system is it.system:
                yield from newton.onward(system, guess)
                return
            course = course.renewed() if renews else Course(window=course.window, retreats=course.retreats)
            end = system.evaluate(guess.q, guess.impulse)

    def _leaves_operator(self, it: Iterate, course: Course, slow: float) -> bool:
        """True if the iterates contract so poorly that a new operator or Newton's method pays; above the contraction
        ``slow`` Newton's method.

        Not on redundant rows, where mixing is faster, and without inertia only for Newton's method.
        """
        if not self.handover or (it.system.model.contacts.crossing_edges and bool(it.active.any())):
            return False
        if course.contraction > slow:
            return True
        scale = it.system.model.space.greatest(it.q, it.system.start.velocity)
        wanted = self.tolerance * max(scale, 1e-300)
        return it.system.model.inert and course.asks_for_renewal(wanted, it.memory.price)

    def _iterates(self, system: SlabEquations, guess: Guess, end: Evaluation) -> Iterator[Iterate]:
        q, impulse, active, memory = guess.q, guess.impulse, guess.active, guess.memory
        assert memory.frozen is not None
        frozen = memory.frozen.in_iteration()
        dofs, space = system.model.dofs, system.model.space
        system = system.prepared(frozen)
        steps = contact_steps(system, frozen)
        mixing = _Mixing(Anderson(self.depth, space.of_unknowns), frozen, space, pushed_exactly(system, frozen))
        last, stuck, part, plain = np.inf, 0, 1.0, np.zeros(0)
        first = None if guess.near else FirstResidual.of(system, frozen, q, end, impulse)
        for count in itertools.count():
            system = system.with_kept_facets_after(end.displacement, active, count)
            if not space.every(np.isfinite(dofs.forces(end.residual))):
                yield lost(Guess(q=q, impulse=impulse, active=active, memory=memory), system)
                return
            step = steps(system, frozen, q, end, impulse, active)
            plain = step.bare() if count == 0 else plain
            before = system.unknowns(q)
            system, new = system.followed(q, step.q, end)
            change = max(space.greatest(new - q), step.missed)
            sound, completed = check_facets(system, new, change)
            yield _iterate(step, q=new, change=change, free=plain, memory=memory, system=system, sound=sound)
            system = completed
            stuck = stuck + 1 if change > 0.99 * last else 0
            part = _next_part(part, change > SWING * last and bool((step.active != active).any()), system)
            if (step.active != active).any() or stuck >= 2:
                mixing.accelerator.restart()
                stuck = 0
            last, active = change, step.active
            mixed, impulse = mixing.mixed((before, impulse), (system.unknowns(new), step.impulse))
            system, q = system.at(before + part * (mixed - before) if part < 1.0 else mixed)
            end = system.evaluate(q, impulse, end)
            if count == 0 and first is not None:
                now = Guess(q=q, impulse=impulse, active=active, memory=memory)
                yield from first.confirmed(now, system, end, (plain, change), self.tolerance)


def _iterate(
    step: ContactStep,
    *,
    q: Array,
    change: float,
    free: Array,
    memory: OperatorMemory,
    system: SlabEquations,
    sound: bool,
) -> Iterate:
    """Iterate of a step; arguments as of :class:`~softway.solve.methods.iteration.Iterate`."""
    return Iterate(
        q=q,
        change=change,
        impulse=step.impulse,
        active=step.active,
        free=free,
        memory=memory,
        system=system,
        sound=sound and step.settled,
    )


def _next_part(part: float, swings: bool, system: SlabEquations) -> float:
    """Part of the next step: half of this one where the contact changes without progress, then more again."""
    if not system.model.contacts.crossing_edges:
        return 1.0
    return max(0.5 * part, LEAST) if swings else min(1.0, 2.0 * part)


def _starts_flowing(system: SlabEquations) -> bool:
    """True for path-dependent materials without inertia: no operator made at rest fits their flow."""
    return any_path_dependent(system.model.parts) and not system.model.inert


@dataclass(frozen=True, slots=True, eq=False)
class _Mixing:
    """Accelerator of velocities and impulses: the residuals and closures of the map depend on both.

    The residual to be minimised contains the impulses only if those of an iterate depend on those before: ``exact``
    ones are those of the mixed velocities, up to higher order.
    """

    accelerator: Anderson
    frozen: FrozenOperator
    space: VectorSpace
    exact: bool

    def mixed(self, x: tuple[Array, Array], value: tuple[Array, Array]) -> tuple[Array, Array]:
        """Next velocities (f,) and impulses (m,), from the arguments ``x`` of the map and its ``value``."""
        if self.exact:
            found = self.accelerator.mix(x[0], np.concatenate(value))
            return found[: len(x[0])], found[len(x[0]) :]
        unit = self.space.greatest(self.frozen.solve_push(np.ones(self.frozen.basis.directions.shape[1])))
        scale = np.concatenate([np.ones(len(x[0])), np.full(len(x[1]), unit)])
        found = self.accelerator.mix(scale * np.concatenate(x), scale * np.concatenate(value))
        return found[: len(x[0])], found[len(x[0]) :] / max(unit, 1e-300)
