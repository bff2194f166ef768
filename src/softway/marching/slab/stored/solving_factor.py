"""Factors of a library for compiled slabs (time steps) of models whose band would be too large."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp

from softway.arrays import IntArray
from softway.errors import NoConvergence
from softway.marching.slab.band import BandOrder, SlabFactor, band_order, banded_factor
from softway.solve.linear.backends.pardiso import Pardiso, SolveCall, solve_call
from softway.solve.linear.interface import Analysis
from softway.solve.operators.factored import suited

LARGEST = 16_000
"""Number of unknowns up to which compiled slabs pay: beyond it, threads that share the forces gain more."""


@dataclass(frozen=True, slots=True, eq=False)
class SolvingFactor:
    """Factor for compiled slabs; ``call`` is that of the library which made it, None for one in a band."""

    factor: SlabFactor
    call: SolveCall | None = None

    @property
    def failed(self) -> bool:
        """True if the library could not solve."""
        return self.call is not None and self.call.failed

    def limited(self) -> AbstractContextManager[None]:
        """Context in which compiled code may solve."""
        return nullcontext() if self.call is None else self.call.limited()


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """Places (f,) of the unknowns, and the function that makes factors of operators; None for one that is not positive
    definite.
    """

    place: IntArray
    factored: Callable[[sp.csc_array], SolvingFactor | None]


def way_of(matrix: sp.csr_array) -> Way | None:
    """How compiled slabs solve with matrices (f, f) of this pattern; None if no compiled code can."""
    order = band_order(matrix)
    if order is not None:
        return Way(order.place, partial(_banded, order))
    size = matrix.shape[0]
    solver = suited(size, "single", threads=1) if 0 < size <= LARGEST else None
    return Way(np.arange(size), partial(_by_library, solver, [])) if isinstance(solver, Pardiso) else None


def _banded(order: BandOrder, matrix: sp.csc_array) -> SolvingFactor | None:
    found = banded_factor(sp.csr_array(matrix), order)
    return None if found is None else SolvingFactor(found)


def _by_library(solver: Pardiso, analyses: list[Analysis], matrix: sp.csc_array) -> SolvingFactor | None:
    """Factor by PARDISO; ``analyses`` keeps its symbolic work for the pattern."""
    try:
        if not analyses:
            analyses.append(solver.analyse(matrix))
        call = solve_call(analyses[0].factor(matrix))
    except NoConvergence:
        return None
    if call is None:
        return None
    empty = np.zeros((0, 0))
    return SolvingFactor(SlabFactor(empty, empty, np.ones(matrix.shape[0]), call.single, call.library), call)
