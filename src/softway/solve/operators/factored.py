"""The frozen sparse factor."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from softway.solve.backends.choice import best, named
from softway.solve.linear import Analysis, Factor, LinearSolver, Precision, SuperLU, number_type
from softway.solve.operators.operator import Made
from softway.solve.stiffness import Stiffness
from softway.typing import Array

MANY = 2000
"""Unknowns below which a factor in double precision is as fast."""
FEW = 1000
"""Unknowns below which the backend that is always there is as fast."""
ALONE = 10000
"""Unknowns below which threads wait for each other longer than they work."""
ASSEMBLY = 8.0
"""Iterations that the assembly of the matrix and the new compliance of the contact cost."""
ROWS = 17.0
"""Stored numbers for each unknown and iteration that a factor costs: measured with supernodal factors of cubes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Factored:
    """A sparse factor of ``M + h^2/2 mu2 K``: best for most.

    In single precision the factor takes half the memory and time, and the iterates are the same to the tolerance, for
    the residual is always that of double precision.

    Parameters
    ----------
    backend
        Library that factors; by default the fastest that is there.
    precision
        Of the factor; by default single for bodies of large deformation with ``MANY`` unknowns or more: a linear slab
        is solved by one solution in double precision.
    moduli
        ``tangent``, or ``secant``: those of a law with the viscosity held fixed, where a law has such (Picard).
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

    def make(self, slab: Stiffness, u: Array, analysis: Analysis | None) -> Made:
        """The factor of a slab at the displacement ``u`` (n, d)."""
        matrix = slab.operator(u, secant=self.moduli == "secant")
        precision = self._precision(slab)
        if analysis is None:
            analysis = self._solver(matrix.shape[0], precision).analyse(matrix)
        factor = analysis.factor(matrix)
        kind = number_type(precision)
        price = cost(factor, matrix.shape[0], precision)
        return Made(factor=factor, local=None, analysis=analysis, price=price, kind=kind)

    def _solver(self, size: int, precision: Precision) -> LinearSolver:
        if self.backend != "auto":
            return named(self.backend, precision, self.threads)
        return suited(size, precision, self.threads)

    def _precision(self, slab: Stiffness) -> Precision:
        if self.precision != "auto":
            return self.precision
        return "double" if slab.model.linear or slab.model.free.sum() < MANY else "single"


def suited(size: int, precision: Precision = "double", threads: int | None = None) -> LinearSolver:
    """The fastest direct solver for ``size`` unknowns."""
    threads = 1 if threads is None and size < ALONE else threads
    return SuperLU(precision) if size < FEW else best(precision, threads)


def cost(factor: Factor, size: int, precision: Precision = "double") -> float:
    """What a factor of ``size`` unknowns costs, in iterations."""
    return ASSEMBLY + factor.bytes / (np.dtype(number_type(precision)).itemsize * ROWS * max(size, 1))
