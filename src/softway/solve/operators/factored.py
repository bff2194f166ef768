"""Operator with a frozen sparse factor."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.arrays import Array
from softway.model.model import Model
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.backends.choice import best_solver, require_solver, solver_named
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import Analysis, Factor, LinearSolver, Precision, counted, number_type
from softway.solve.operators.interface import BuiltOperator
from softway.solve.operators.positive_definite import positive_definite_factor

MANY = 2000
"""Number of unknowns below which a factor in double precision is as fast."""
FEW = 1000
"""Number of unknowns below which SuperLU, which is always installed, is as fast."""
ALONE = 10000
"""Number of unknowns below which several threads are slower than one."""
ASSEMBLY = 8.0
"""Cost of assembling the matrix and of the new contact compliance, in iterations."""
ROWS = 17.0
"""Factor entries for each unknown that cost one iteration: measured with supernodal factors of cubes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Factored:
    """Sparse factor of ``M + h^2/2 mu2 K``, the best choice for most bodies.

    In single precision the factor takes half the memory and time.  The residual is always computed in double precision:
    the iterates are the same within the tolerance.

    Parameters
    ----------
    backend
        Library that factors; by default the fastest that is installed.
    precision
        Precision of the factor; by default single for bodies of large deformation with at least ``MANY`` unknowns: a
        linear slab needs only one solution in double precision.
    moduli
        ``tangent``, or ``secant``: moduli with fixed viscosity, for laws that have them (Picard iteration).
    threads
        Threads of the backend; by default one for few unknowns, else those of its library.

    Examples
    --------
    >>> Factored().precision
    'auto'
    """

    backend: Literal["auto", "superlu", "pardiso", "cholmod", "mumps"] = "auto"
    precision: Literal["auto", "single", "double"] = "auto"
    moduli: Literal["tangent", "secant"] = "tangent"
    threads: int | None = None

    def require(self, model: Model) -> None:
        """Refuse a backend that does not support the precision, and a number of threads below one."""
        if self.backend == "auto":
            counted(self.threads)
        else:
            require_solver(self.backend, self._precision(model), self.threads)

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """Factor the matrix of a slab at the displacement ``u`` (n, d)."""
        matrix = slab.operator(u, secant=self.moduli == "secant")
        precision = self._precision(slab.model)
        if analysis is None:
            analysis = self._solver(matrix.shape[0], precision).analyse(matrix)
        factor = positive_definite_factor(analysis, matrix) if slab.positive_definite else analysis.factor(matrix)
        kind = number_type(precision)
        price = cost(factor, matrix.shape[0], precision)
        return BuiltOperator(factor=factor, local=None, analysis=analysis, price=price, kind=kind)

    def _solver(self, size: int, precision: Precision) -> LinearSolver:
        if self.backend != "auto":
            return solver_named(self.backend, precision, self.threads)
        return suited(size, precision, self.threads)

    def _precision(self, model: Model) -> Precision:
        if self.precision != "auto":
            return self.precision
        return "double" if model.linear or model.dofs.size < MANY else "single"


def suited(size: int, precision: Precision = "double", threads: int | None = None) -> LinearSolver:
    """Fastest direct solver for ``size`` unknowns."""
    threads = 1 if threads is None and size < ALONE else threads
    return SuperLU(precision) if size < FEW else best_solver(precision, threads)


def cost(factor: Factor, size: int, precision: Precision = "double") -> float:
    """Cost of a factor of ``size`` unknowns, in iterations."""
    return ASSEMBLY + factor.bytes / (np.dtype(number_type(precision)).itemsize * ROWS * max(size, 1))
