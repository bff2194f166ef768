"""PARDISO of the Intel Math Kernel Library, called by its C interface; the package ``pypardiso`` installs it."""

import ctypes
import weakref
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, files
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softway.arrays import Array, IntArray
from softway.solve.linear.backends.pardiso_call import (
    ANALYSE,
    ANALYSE_AND_FACTOR,
    DEFINITE,
    ENTRIES,
    ERROR,
    ERRORS,
    FACTOR,
    FORGET,
    FORGET_FACTOR,
    INDEFINITE,
    NOT_DEFINITE,
    PERTURBED,
    SIZE,
    SOLVE,
    TYPE,
    Ints,
    PardisoCall,
    address,
)
from softway.solve.linear.interface import LOG, Factor, Precision, by_columns, counted, finite, number_type, unfactored
from softway.solve.linear.pattern import Pattern
from softway.solve.linear.power_scaling import PowerScaled, enlarged, reduced


@dataclass(frozen=True, slots=True)
class Pardiso:
    """PARDISO: Cholesky factor, or L D L^T with a log entry if the matrix is not positive definite.

    Parameters
    ----------
    precision
        Precision of the factor.
    threads
        None for the default of the library.  The number is fixed when a matrix is analysed.

    References
    ----------
    Schenk, Gaertner (2004), Future Gener. Comput. Syst. 20, 475-487.

    Examples
    --------
    >>> Pardiso(precision="single", threads=1).precision
    'single'
    """

    precision: Precision = "double"
    threads: int | None = None

    def __post_init__(self) -> None:
        number_type(self.precision)
        counted(self.threads)

    def analyse(self, matrix: sp.csc_array) -> "_Analysis":
        """Order the unknowns of a sparse symmetric matrix (f, f) by nested dissection.

        Raises
        ------
        ImportError
            If the library cannot be loaded.
        NoConvergence
            If an entry is not a number or the library refuses the matrix.
        """
        finite(matrix)
        library = _library()
        threads = self.threads or int(library["MKL_Get_Max_Threads"]())
        analysis = _Analysis(
            library, threads, _Upper.of(matrix), number_type(self.precision), {DEFINITE: [], INDEFINITE: []}
        )
        analysis.idle[DEFINITE].append(analysis.handle(DEFINITE, analysis.upper.values(matrix, analysis.kind)))
        return analysis

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Analyse and factor a sparse symmetric matrix (f, f)."""
        return self.analyse(matrix).factor(matrix)


def _library() -> ctypes.CDLL:
    """Library of the installed package, or the one that pypardiso finds in the folders."""
    try:
        found = [f for f in files("mkl") or () if f.name.startswith("libmkl_rt")]
        return ctypes.CDLL(str(found[0].locate()))
    except (PackageNotFoundError, IndexError, OSError):
        from pypardiso import ps

        library: ctypes.CDLL = ps.libmkl
        return library


@dataclass(frozen=True, slots=True, eq=False)
class _Upper:
    """Upper triangle by rows, with every diagonal entry, numbered from one as in PARDISO.

    ``where`` (z,) is the place of each entry in the data of the full matrix; entries ``blank`` are not stored there.
    """

    pattern: Pattern
    rows: Ints
    columns: Ints
    where: IntArray
    blank: IntArray

    @classmethod
    def of(cls, matrix: sp.csc_array) -> "_Upper":
        f = matrix.shape[0]
        row = np.repeat(np.arange(f), np.diff(matrix.indptr))
        where = np.flatnonzero(matrix.indices >= row)
        row, column = row[where], matrix.indices[where]
        if len(missing := np.setdiff1d(np.arange(f), row[row == column])):
            row, column = np.append(row, missing), np.append(column, missing)
            order = np.lexsort((column, row))
            row, column = row[order], column[order]
            where = np.append(where, np.full(len(missing), matrix.nnz))[order]
        rows = 1 + np.searchsorted(row, np.arange(f + 1))
        blank = np.flatnonzero(where == matrix.nnz)
        return cls(Pattern.of(matrix), rows.astype(np.int32), (column + 1).astype(np.int32), where, blank)

    def values(self, matrix: sp.csc_array, kind: type[np.floating[Any]]) -> NDArray[Any]:
        """Entries (z,) of a matrix of this pattern."""
        self.pattern.require(matrix)
        if not matrix.nnz:
            return np.zeros(len(self.where), kind)
        values = matrix.data.take(self.where, mode="clip").astype(kind)
        values[self.blank] = 0.0
        return values


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class _Handle:
    """Owner of the memory of one matrix in PARDISO."""

    call: PardisoCall


def _retire(handle: _Handle, idle: list[_Handle]) -> None:
    """Free the factor of a handle and keep its analysis."""
    handle.call(FORGET_FACTOR)
    idle.append(handle)


@dataclass(frozen=True, slots=True, eq=False)
class _Analysis:
    """Analysed pattern; ``idle`` contains analysed handles without factor, for each kind of matrix.

    A handle has one factor at a time: simultaneous factors have own handles with the same analysis.
    """

    library: ctypes.CDLL
    threads: int
    upper: _Upper
    kind: type[np.floating[Any]]
    idle: dict[int, list[_Handle]]

    def factor(self, matrix: sp.csc_array) -> Factor:
        finite(matrix)
        matrix, power = enlarged(matrix, "single" if self.kind is np.float32 else "double")
        values = self.upper.values(matrix, self.kind)
        handle = self.handle(DEFINITE, values)
        definite, error = DEFINITE, handle.call(FACTOR, address(values))
        if error == NOT_DEFINITE:
            LOG.debug("an operator of %d unknowns is not positive definite: factored as L D L^T", matrix.shape[0])
            handle = self.handle(INDEFINITE, values)
            definite, error = INDEFINITE, handle.call(FACTOR, address(values))
        if error or handle.call.parameters[PERTURBED]:
            raise unfactored(
                matrix.shape[0], ERRORS.get(error, f"PARDISO: error {error}") if error else "it is singular"
            )
        factor = _Factor(handle, values, int(handle.call.parameters[ENTRIES]) * values.itemsize)
        weakref.finalize(factor, _retire, handle, self.idle[definite]).atexit = False
        return reduced(factor, power)

    def handle(self, definite: int, values: NDArray[Any]) -> _Handle:
        """Analysed handle for matrices of the kind ``definite``."""
        if self.idle[definite]:
            return self.idle[definite].pop()
        call = PardisoCall.of(self.library, self.threads, (self.upper.rows, self.upper.columns), self.kind, definite)
        handle = _Handle(call)
        weakref.finalize(handle, call, FORGET).atexit = False
        if error := call(ANALYSE, address(values)):
            raise unfactored(len(self.upper.rows) - 1, ERRORS.get(error, f"PARDISO: error {error}"))
        return handle


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class _Factor:
    """Factor in the memory of PARDISO."""

    handle: _Handle
    values: NDArray[Any]
    bytes: int

    @property
    def indefinite(self) -> bool:
        return int(self.handle.call.numbers[TYPE]) != DEFINITE

    def solve(self, b: Array) -> Array:
        if len(b) != self.handle.call.numbers[SIZE]:
            raise ValueError(f"{len(b)} values for {self.handle.call.numbers[SIZE]} unknowns")
        return by_columns(self._rows, b) if b.size else np.zeros(b.shape)

    def _rows(self, b: Array) -> Array:
        right = np.ascontiguousarray(b, self.values.dtype)
        x = np.empty_like(right)
        if error := self.handle.call(SOLVE, address(self.values), len(b), address(right), address(x)):
            raise unfactored(b.shape[1], ERRORS.get(error, f"PARDISO: error {error}"))
        return np.asarray(x, float)

    def schur_complement(self, which: IntArray) -> Array | None:
        """Schur complement (k, k) at the unknowns ``which`` (k,), by a factor of its own that ends there; None if the
        matrix is not positive definite.
        """
        if self.indefinite:
            return None
        call = self.handle.call.condensing(which)
        out = np.zeros((len(which), len(which)), self.values.dtype)
        unused = np.zeros(int(call.numbers[SIZE]), self.values.dtype)
        error = call(ANALYSE_AND_FACTOR, address(self.values), 1, address(unused), address(out))
        call(FORGET)
        if error or call.parameters[PERTURBED]:
            return None
        place = np.searchsorted(np.sort(which), which)
        return np.asarray(out[np.ix_(place, place)], float)


@dataclass(frozen=True, slots=True, eq=False)
class SolveCall:
    """Solution by a factor in single precision, for compiled code: addresses and exponent ``library`` (18,), and
    ``single`` (2, f) for right-hand side and solution, see :func:`softway.kernels.slab.solution.solve`.

    ``limited`` is a context in which the library has the threads of the factor, ``numbers`` are those of its call.
    """

    library: IntArray
    single: NDArray[np.float32]
    limited: Callable[[], AbstractContextManager[None]]
    numbers: Ints
    factor: _Factor

    @property
    def failed(self) -> bool:
        """True if a solution had an error."""
        return bool(self.numbers[ERROR])


def solve_call(factor: Factor) -> SolveCall | None:
    """Solution by a factor for compiled code; None if it is not one of PARDISO in single precision."""
    factor, e = (factor.factor, factor.e) if isinstance(factor, PowerScaled) else (factor, 0)
    if not isinstance(factor, _Factor) or factor.values.dtype != np.float32 or factor.indefinite:
        return None
    call = factor.handle.call
    single = np.zeros((2, int(call.numbers[SIZE])), np.float32)
    arguments, numbers = call.solution(address(factor.values), address(single[0]), address(single[1]))
    return SolveCall(np.append(arguments, e), single, call.limited, numbers, factor)
