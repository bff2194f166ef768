"""Multigrid over ranks by PETSc: the one place where petsc4py enters."""

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.ranks.alone import Alone
from softway.ranks.interface import Ranks
from softway.ranks.mpi import Processes

REMEDY = "apt install python3-petsc4py, conda install petsc4py, or on a cluster its module of PETSc"
OPTIONS = {
    "pc_gamg_type": "agg",
    "pc_gamg_agg_nsmooths": "1",
    "mg_levels_ksp_type": "chebyshev",
    "mg_levels_ksp_max_it": "2",
    "mg_levels_pc_type": "pbjacobi",
}
"""Smoothed aggregation with two Chebyshev steps of the blocks of the nodes on every level: a symmetric cycle."""
PREFIX = "softway_"


@dataclass(frozen=True, slots=True, eq=False)
class Cycle:
    """One cycle of multigrid on the components of own nodes."""

    cycle: Any
    right: Any
    result: Any

    def applied(self, values: Array) -> Array:
        """Result (k, d) of one cycle for the right side (k, d) on own nodes; a call of all ranks."""
        self.right.getArray()[:] = values.ravel()
        self.cycle.apply(self.right, self.result)
        return np.asarray(self.result.getArray()).reshape(values.shape).copy()


def available() -> bool:
    """True if petsc4py is installed."""
    return find_spec("petsc4py") is not None


def multigrid(ranks: Ranks, rows: sp.csr_array, numbers: IntArray, points: Array) -> Cycle:
    """Smoothed aggregation with the rigid motions of the nodes.

    Parameters
    ----------
    ranks
        Processes, or one rank alone.
    rows
        (k d, n d) rows of own nodes.
    numbers
        (n,) numbers of the nodes over all ranks, in which those of each rank follow one another.
    points
        (k, d) places of own nodes [m].

    Raises
    ------
    InputError
        Without petsc4py, or for threads as ranks.
    """
    PETSc, comm = _library(), _communicator(ranks)
    k, d = points.shape
    matrix = PETSc.Mat().create(comm=comm)
    matrix.setSizes(((k * d, None), (k * d, None)), bsize=d)
    matrix.setType("aij")
    columns = (numbers[rows.indices // d] * d + rows.indices % d).astype(PETSc.IntType)
    matrix.setPreallocationCSR((rows.indptr.astype(PETSc.IntType), columns, rows.data))
    matrix.assemble()
    cycle, known = PETSc.PC().create(comm=comm), PETSc.Options()
    for name, value in OPTIONS.items():
        known.setValue(PREFIX + name, value)
    cycle.setOptionsPrefix(PREFIX)
    cycle.setOperators(matrix)
    cycle.setType("gamg")
    cycle.setCoordinates(points)
    cycle.setFromOptions()
    cycle.setUp()
    right, result = matrix.createVecs()
    return Cycle(cycle, right, result)


def _library() -> Any:
    try:
        from petsc4py import PETSc
    except ImportError as error:
        raise InputError("solver.operator", f"petsc4py cannot be loaded: {error}", REMEDY) from None
    return PETSc


def _communicator(ranks: Ranks) -> Any:
    if isinstance(ranks, Processes):
        return ranks.comm
    if isinstance(ranks, Alone):
        return _library().COMM_SELF
    raise InputError("solver.operator", "PETSc over threads", "processes: softway run FILE --ranks N")
