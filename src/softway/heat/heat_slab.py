"""One slab of heat conduction: content differences against the heat that flows in (docs/theory/heat/conduction.md)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray
from softway.errors import NoConvergence
from softway.heat.heat_balance import Balance, Stage, balance, entropy_brought, heats, passed, prescribed, rounding
from softway.heat.heat_model import HeatModel
from softway.heat.operators import Thermal
from softway.solve.linear.backends.superlu import SuperLU, factor_unsymmetric
from softway.solve.linear.interface import Factor, LinearSolver

ITERATIONS = 60
"""Greatest number of iterations in a stage."""
TOLERANCE = 1e-12
"""Greatest sum of the unbalanced heats of the nodes, relative to the heats that take part."""
SHORTENINGS = 30
"""Greatest number of shorter corrections that are tried."""
ENOUGH = 0.8
"""Unbalanced heat along a correction, relative to that before it, at which it is not shortened further."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatFactor:
    """Factor of the matrix C + s K of a linear model, for the weighted length s = theta h [s] of a stage."""

    span: float
    factor: Factor


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StageResult:
    """End of a stage.

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
    """

    after: Thermal
    heats: Array
    passed: Array
    entropy: float
    iterations: int
    factor: HeatFactor | None


def solve_stage(
    model: HeatModel,
    before: Thermal,
    stage: Stage,
    factor: HeatFactor | None = None,
    linear: LinearSolver = SuperLU(),
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

    Raises
    ------
    NoConvergence
        If the heats of the nodes are not balanced after 60 iterations, or a matrix is singular.
    """
    free = model.free_nodes()
    unknowns = prescribed(model, before.unknowns, stage.end)
    frozen = factor if factor is not None and factor.span == stage.theta * stage.span else None
    floor = rounding(model, before, stage)
    for iteration in range(ITERATIONS):
        found = balance(model, before, stage, unknowns, slopes=frozen is None)
        size = float(np.abs(found.values[free]).sum())
        if not np.isfinite(size):
            break
        if iteration and size <= TOLERANCE * found.moved + floor:
            gone = heats(model, before, stage, found)
            brought = entropy_brought(model, stage, found)
            through = passed(model, stage, found)
            return StageResult(
                after=found.after, heats=gone, passed=through, entropy=brought, iterations=iteration, factor=frozen
            )
        if frozen is not None:
            step = frozen.factor.solve(-found.values[free])
        elif not free.any():
            step = np.zeros(0)
        else:
            kind = linear.factor if model.linear else factor_unsymmetric
            factored = kind(_of_free(found, free))
            frozen = HeatFactor(span=stage.theta * stage.span, factor=factored) if model.linear else None
            step = factored.solve(-found.values[free])
        unknowns = _corrected(model, before, stage, unknowns, step, free, found)
    raise NoConvergence(f"the heats of the nodes are not balanced after {ITERATIONS} iterations")


def _of_free(found: Balance, free: BoolArray) -> sp.csc_array:
    """Rows and columns (f, f) of the free nodes."""
    assert found.matrix is not None
    return sp.csc_array(found.matrix[free][:, free])


def _corrected(
    model: HeatModel, before: Thermal, stage: Stage, unknowns: Array, step: Array, free: BoolArray, found: Balance
) -> Array:
    """Unknowns with a correction, shortened where fronts cut cells until the unbalanced heat along it is less."""

    def at(length: float) -> Array:
        out = unknowns.copy()
        out[free] += length * step
        return out

    def along(length: float) -> float:
        return float(balance(model, before, stage, at(length), slopes=False).values[free] @ step)

    start = float(found.values[free] @ step)
    return at(_length(along, start) if model.simplices and start < 0.0 else 1.0)


def _length(along: Callable[[float], float], start: float) -> float:
    """Length at which ``along`` is less than at zero, where it is ``start`` < 0: one, or the zero by bisection."""
    found = along(1.0)
    if found <= -ENOUGH * start:
        return 1.0
    low, high, length = 0.0, 1.0, 1.0
    for _ in range(SHORTENINGS):
        length = 0.5 * (low + high)
        found = along(length)
        if abs(found) <= -ENOUGH * start:
            break
        low, high = (length, high) if found < 0.0 else (low, length)
    return length
