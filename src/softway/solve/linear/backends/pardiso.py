"""PARDISO of the Intel Math Kernel Library, called by its C interface; the package ``pypardiso`` installs it."""

import ctypes
import weakref
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, files
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softway.arrays import Array, IntArray
from softway.solve.linear.interface import LOG, Precision, by_columns, counted, finite, number_type, unfactored
from softway.solve.linear.pattern import Pattern

Ints = NDArray[np.int32]

ANALYSE, FACTOR, SOLVE, FORGET_FACTOR, FORGET = 11, 22, 33, 0, -1
DEFINITE, INDEFINITE = 2, -2
NOT_DEFINITE = -4
ONE, SIZE, TYPE, PHASE, COUNT, QUIET, ERROR = range(7)
"""Places of the numbers that are passed to PARDISO by address."""
ERRORS = {
    -1: "inconsistent input",
    -2: "not enough memory",
    -3: "no ordering found",
    -4: "a pivot is zero or of the wrong sign",
    -5: "internal error",
    -7: "a diagonal entry is zero",
    -8: "too many entries for indices of 32 bits",
}
OWN, ORDERING, REFINEMENTS, SMALLEST, PERTURBED, ENTRIES, PIVOTING, TWO_LEVELS, SINGLE = 0, 1, 7, 9, 13, 17, 20, 23, 27
"""Places of ``iparm``.  With several threads only the two-level factor gives reproducible solutions."""

PARAMETERS = {OWN: 1, ORDERING: 2, REFINEMENTS: 0, SMALLEST: 13, ENTRIES: -1, PIVOTING: 1}
"""Nested dissection, no refinement, pivots below 1e-13 of the matrix are perturbed, factor entries are counted, pivots
of one or two rows if indefinite."""


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

    def factor(self, matrix: sp.csc_array) -> "_Factor":
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


def _address(array: NDArray[Any]) -> int:
    return int(array.__array_interface__["data"][0])


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


@dataclass(frozen=True, slots=True, eq=False)
class _Call:
    """Call of PARDISO with the memory of one matrix, its ``numbers`` and ``parameters``.

    ``head``, ``pattern`` and ``tail`` are addresses in the order of its arguments.
    """

    limit: Any
    function: Any
    threads: int
    numbers: Ints
    parameters: Ints
    kept: tuple[NDArray[Any], ...]
    head: tuple[int, ...]
    pattern: tuple[int, ...]
    tail: tuple[int, ...]

    @classmethod
    def of(cls, library: ctypes.CDLL, threads: int, upper: "_Upper", kind: type, definite: int) -> "_Call":
        function = library["pardiso"]
        function.argtypes, function.restype = [ctypes.c_void_p] * 16, None
        state, parameters, numbers = np.zeros(64, np.int64), np.zeros(64, np.int32), np.zeros(7, np.int32)
        for place, value in PARAMETERS.items():
            parameters[place] = value
        parameters[TWO_LEVELS], parameters[SINGLE] = threads > 1, kind is np.float32
        numbers[[ONE, SIZE, TYPE]] = 1, len(upper.rows) - 1, definite
        at = [_address(numbers) + 4 * k for k in range(len(numbers))]
        return cls(
            limit=library["MKL_Set_Num_Threads_Local"],
            function=function,
            threads=threads,
            numbers=numbers,
            parameters=parameters,
            kept=(state, upper.rows, upper.columns),
            head=(_address(state), at[ONE], at[ONE], at[TYPE], at[PHASE], at[SIZE]),
            pattern=(_address(upper.rows), _address(upper.columns), 0, at[COUNT]),
            tail=(_address(parameters), at[QUIET]),
        )

    def __call__(self, phase: int, values: int = 0, count: int = 1, b: int = 0, x: int = 0) -> int:
        """Run a phase and return its error, with the addresses of entries, ``count`` right-hand sides and solutions."""
        self.numbers[PHASE], self.numbers[COUNT] = phase, count
        before = self.limit(self.threads)
        try:
            self.function(*self.head, values, *self.pattern, *self.tail, b, x, _address(self.numbers) + 4 * ERROR)
        finally:
            self.limit(before)
        return int(self.numbers[ERROR])


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class _Handle:
    """Owner of the memory of one matrix in PARDISO."""

    call: _Call


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

    def factor(self, matrix: sp.csc_array) -> "_Factor":
        finite(matrix)
        values = self.upper.values(matrix, self.kind)
        handle = self.handle(DEFINITE, values)
        definite, error = DEFINITE, handle.call(FACTOR, _address(values))
        if error == NOT_DEFINITE:
            LOG.debug("an operator of %d unknowns is not positive definite: factored as L D L^T", matrix.shape[0])
            handle = self.handle(INDEFINITE, values)
            definite, error = INDEFINITE, handle.call(FACTOR, _address(values))
        if error or handle.call.parameters[PERTURBED]:
            raise unfactored(
                matrix.shape[0], ERRORS.get(error, f"PARDISO: error {error}") if error else "it is singular"
            )
        factor = _Factor(handle, values, int(handle.call.parameters[ENTRIES]) * values.itemsize)
        weakref.finalize(factor, _retire, handle, self.idle[definite]).atexit = False
        return factor

    def handle(self, definite: int, values: NDArray[Any]) -> _Handle:
        """Analysed handle for matrices of the kind ``definite``."""
        if self.idle[definite]:
            return self.idle[definite].pop()
        call = _Call.of(self.library, self.threads, self.upper, self.kind, definite)
        handle = _Handle(call)
        weakref.finalize(handle, call, FORGET).atexit = False
        if error := call(ANALYSE, _address(values)):
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
        if error := self.handle.call(SOLVE, _address(self.values), len(b), _address(right), _address(x)):
            raise unfactored(b.shape[1], ERRORS.get(error, f"PARDISO: error {error}"))
        return np.asarray(x, float)
