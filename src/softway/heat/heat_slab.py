"""One slab of heat conduction: content differences against the heat that flows in (docs/theory/heat/conduction.md)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray
from softway.errors import NoConvergence, NumericsError
from softway.heat.heat_balance import (
    Balance,
    Stage,
    at_rest,
    balance,
    entropy_brought,
    entropy_of_reservoirs,
    heats,
    passed,
    prescribed,
    rounding,
)
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import HeatModel
from softway.heat.operators import HeatValues, heat_values, unknowns_of
from softway.solve.linear.backends.superlu import SuperLU, factor_unsymmetric
from softway.solve.linear.interface import Factor, LinearSolver
from softway.solve.linear.weak_coupling import DiagonalGradients, Links, factor_unless_weak

HALVINGS = 8
"""Greatest number of halvings of a slab that does not converge."""
ITERATIONS = 60
"""Greatest number of iterations in a stage."""
TOLERANCE = 1e-12
"""Greatest sum of the unbalanced heats of the nodes, relative to the heats that take part."""
MOVING = 1e-14
"""The same in a body that deforms, whose motion meets the temperature in another iteration."""
SHORTENINGS = 30
"""Greatest number of shorter corrections that are tried."""
REMEDY = 'latent = "node" where matter melts, or shorter slabs'
ENOUGH = 0.8
"""Unbalanced heat along a correction, relative to that before it, at which it is not shortened further."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatFactor:
    """Factor of the matrix C + s K of a linear model, for the weighted length s = theta h [s] of a stage."""

    span: float
    factor: Factor

    def linked(self, exchanges: Sequence[HeatExchange], free: BoolArray) -> "HeatFactor | None":
        """Factor of the model with ``exchanges``, for its ``free`` nodes (n,); None if it has to be factored anew."""
        if not exchanges:
            return self
        if not isinstance(self.factor, DiagonalGradients):
            return None
        jump = sp.csr_array(sp.vstack([e.jump for e in exchanges], format="csr"))
        jump = jump if free.all() else sp.csr_array(jump[:, free])
        weights = self.span * np.concatenate([e.conductances for e in exchanges])
        factor = self.factor.linked(Links(jump=jump, back=sp.csr_array(jump.T), weights=weights))
        return None if factor is None else HeatFactor(span=self.span, factor=factor)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StageResult:
    """End of a stage, or of a slab of several.

    Parameters
    ----------
    after
        Temperatures and contents at the end.
    heats
        Heat that came in by each load on a surface, each source and each prescribed temperature, in this order [J].
    passed
        (k,) heat that passed each contact [J].
    entropy
        Entropy that the loads brought [J/K].
    iterations
        Number of iterations.
    factor
        Factor of a linear model, for the next stage.
    mean, work
        (n,) mean temperature at which the strain takes heat [K], and its work [J], see
        :class:`~softway.heat.heat_balance.HeatOfStrain`.
    produced, turned
        (n,) entropy produced by conduction and dissipation, less what other nodes produce, so that the sum counts
        [J/K], and the magnitudes that take part.
    reservoirs
        Entropy that opponents without nodes gained [J/K].
    rounding
        Rounding of the sum of the heats [J].
    """

    after: HeatValues
    heats: Array
    passed: Array
    entropy: float
    iterations: int
    factor: HeatFactor | None
    mean: Array
    work: Array
    produced: Array
    turned: Array
    reservoirs: float
    rounding: float


def linear_factor(model: HeatModel, span: float, linear: LinearSolver = SuperLU()) -> HeatFactor | None:
    """Factor of C + s K for the weighted length s = ``span`` [s]; None if the model is not linear or has no free node.

    Examples
    --------
    >>> import softway as sw
    >>> from softway.heat.build_heat import build_heat
    >>> law = sw.heat.Conduction(conductivity=1.0, capacity=1.0)
    >>> bar = sw.heat.Conductor(mesh=sw.meshes.Interval(length=1.0, cells=1), law=law, density=2.0, temperature=300.0)
    >>> found = linear_factor(build_heat(sw.heat.HeatScene(bodies={"bar": bar})), 1.0)
    >>> found.factor.solve(np.array([1.0, 1.0])).round(12).tolist()
    [1.0, 1.0]
    """
    free = model.free_nodes()
    if not model.linear or not model.some_free:
        return None
    unknowns = unknowns_of(model, model.initial)
    stage = Stage(start=0.0, span=span, theta=1.0)
    found = balance(model, heat_values(model, unknowns), stage, unknowns, slopes=True)
    return HeatFactor(span=span, factor=factor_unless_weak(_of_free(found, free), linear, model.free_space))


def is_weak(factor: HeatFactor | None) -> bool:
    """True if hardly any heat flows from node to node in the stages of a factor: they have no modes that ring."""
    return factor is not None and isinstance(factor.factor, DiagonalGradients) and factor.factor.weak


def solve_slab(
    model: HeatModel,
    before: HeatValues,
    slab: Stage,
    halves: bool = False,
    factor: HeatFactor | None = None,
    linear: LinearSolver = SuperLU(),
    depth: int = 0,
    guess: Array | None = None,
) -> StageResult:
    """Solve a slab in one stage or in two ``halves``; in damped halves if it does not converge.

    Raises
    ------
    NumericsError
        If it does not converge after eight halvings.
    """
    if not halves:
        try:
            return solve_stage(model, before, slab, factor, linear, guess)
        except NoConvergence as error:
            if depth == HALVINGS:
                raise NumericsError(str(error), slab.start, REMEDY) from None
    half = 0.5 * slab.span
    one = replace(slab, span=half, theta=1.0)
    middle = None if guess is None else 0.5 * (before.unknowns + guess)
    first = solve_slab(model, before, one, False, factor, linear, depth + 1, middle)
    strain = None if slab.strain is None else slab.strain.later(half)
    rest = replace(one, start=slab.start + half, strain=strain)
    last = solve_slab(model, first.after, rest, False, first.factor, linear, depth + 1, guess)
    return replace(
        last,
        heats=first.heats + last.heats,
        iterations=first.iterations + last.iterations,
        mean=0.5 * (first.mean + last.mean),
        work=first.work + last.work,
        produced=first.produced + last.produced,
        turned=first.turned + last.turned,
        passed=first.passed + last.passed,
        entropy=first.entropy + last.entropy,
        reservoirs=first.reservoirs + last.reservoirs,
        rounding=first.rounding + last.rounding,
    )


def solve_stage(
    model: HeatModel,
    before: HeatValues,
    stage: Stage,
    factor: HeatFactor | None = None,
    linear: LinearSolver = SuperLU(),
    guess: Array | None = None,
) -> StageResult:
    """Solve a stage: one factor for all stages of equal length of a linear model, else Newton's method.

    Parameters
    ----------
    model
        Conductors.
    before
        Temperatures and contents at the start.
    stage
        Stage.
    factor
        Factor from an earlier stage of the same model.
    linear
        Direct solver of linear models.
    guess
        (n,) unknowns expected at the end; by default those at the start.

    Raises
    ------
    NoConvergence
        If the heats of the nodes are not balanced after 60 iterations, or a matrix is singular.
    """
    free = model.free_nodes()
    unknowns = prescribed(model, before.unknowns if guess is None else guess, stage.end)
    frozen = factor if factor is not None and factor.span == stage.theta * stage.span else None
    floor = rounding(model, before, stage)
    tolerance = TOLERANCE if stage.strain is None else MOVING
    for iteration in range(ITERATIONS):
        found = balance(model, before, stage, unknowns, slopes=frozen is None)
        size = model.free_space.total(np.abs(found.values[free]))
        if not np.isfinite(size):
            break
        floor = floor if model.fronts is None else max(floor, rounding(model, found.after, stage))  # far trials
        if iteration and size <= tolerance * found.moved + floor:
            return result_of(model, before, stage, found, iteration, frozen, floor)
        if frozen is not None:
            step = frozen.factor.solve(-found.values[free])
        elif not model.some_free:
            step = np.zeros(0)
        else:
            own, space, span = _of_free(found, free), model.free_space, stage.theta * stage.span
            factored = factor_unless_weak(own, linear, space) if model.linear else factor_unsymmetric(own)
            frozen = HeatFactor(span=span, factor=factored) if model.linear else None
            step = factored.solve(-found.values[free])
        unknowns = _corrected(model, before, stage, unknowns, step, free, found)
    raise NoConvergence(f"the heats of the nodes are not balanced after {ITERATIONS} iterations")


def result_of(
    model: HeatModel,
    before: HeatValues,
    stage: Stage,
    found: Balance,
    iterations: int,
    frozen: HeatFactor | None,
    floor: float,
) -> StageResult:
    """Result of a stage whose heats are balanced."""
    strain = at_rest(before, found.after) if found.strain is None else found.strain
    power = 0.0 if stage.strain is None else stage.strain.power
    moved = stage.span * (np.abs(found.flow) + np.abs(power)) + np.abs(found.after.content - before.content)
    return StageResult(
        after=found.after,
        heats=heats(model, before, stage, found),
        iterations=iterations,
        factor=frozen,
        mean=strain.mean,
        work=strain.work,
        produced=(stage.span * (power - found.flow) + strain.unknown) / strain.mean,
        turned=moved / strain.mean,
        passed=passed(model, stage, found),
        entropy=entropy_brought(model, stage, found),
        reservoirs=entropy_of_reservoirs(model, stage, found),
        rounding=floor,
    )


def _of_free(found: Balance, free: BoolArray) -> sp.csc_array:
    """Rows and columns (f, f) of the free nodes."""
    assert found.matrix is not None
    return sp.csc_array(found.matrix if free.all() else found.matrix[free][:, free])


def _corrected(
    model: HeatModel, before: HeatValues, stage: Stage, unknowns: Array, step: Array, free: BoolArray, found: Balance
) -> Array:
    """Unknowns with a correction, shortened where fronts cut cells until the unbalanced heat along it is less."""

    def at(length: float) -> Array:
        out = unknowns.copy()
        out[free] += length * step
        return out

    def along(length: float) -> float:
        return float(balance(model, before, stage, at(length), slopes=False).values[free] @ step)

    start = float(found.values[free] @ step) if model.simplices else 0.0
    return at(_length(along, start) if start < 0.0 else 1.0)


def _length(along: Callable[[float], float], start: float) -> float:
    """Length at which ``along`` is less than at zero, where it is ``start`` < 0: one, or the zero by bisection."""
    if along(1.0) <= -ENOUGH * start:
        return 1.0
    low, high, length = 0.0, 1.0, 1.0
    for _ in range(SHORTENINGS):
        length = 0.5 * (low + high)
        found = along(length)
        if abs(found) <= -ENOUGH * start:
            break
        low, high = (length, high) if found < 0.0 else (low, length)
    return length
