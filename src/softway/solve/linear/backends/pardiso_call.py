"""A call of PARDISO with the memory of one matrix."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from softway.arrays import IntArray

Ints = NDArray[np.int32]

ANALYSE, FACTOR, ANALYSE_AND_FACTOR, SOLVE, FORGET_FACTOR, FORGET = 11, 22, 12, 33, 0, -1
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
CONDENSED = 35
"""Places of ``iparm``.  With several threads only the two-level factor gives reproducible solutions."""

PARAMETERS = {OWN: 1, ORDERING: 2, REFINEMENTS: 0, SMALLEST: 13, ENTRIES: -1, PIVOTING: 1}
"""Nested dissection, no refinement, pivots below 1e-13 of the matrix are perturbed, factor entries are counted, pivots
of one or two rows if indefinite."""


def address(array: NDArray[Any]) -> int:
    """Address of the first entry of an array."""
    return int(array.__array_interface__["data"][0])


@dataclass(frozen=True, slots=True, eq=False)
class PardisoCall:
    """Call of PARDISO with the memory of one matrix, its ``numbers`` and ``parameters``.

    ``read`` are the first entries of rows, their columns and, to condense the matrix, marks of the unknowns that stay;
    ``head``, ``pattern`` and ``tail`` are addresses in the order of the arguments.
    """

    limit: Any
    function: Any
    threads: int
    numbers: Ints
    parameters: Ints
    state: NDArray[np.int64]
    read: tuple[Ints, ...]
    head: tuple[int, ...]
    pattern: tuple[int, ...]
    tail: tuple[int, ...]

    @classmethod
    def of(cls, library: ctypes.CDLL, threads: int, read: tuple[Ints, Ints], kind: type, definite: int) -> Self:
        """Call for matrices of a pattern, with numbers of a ``kind``, positive ``definite`` or not."""
        function = library["pardiso"]
        function.argtypes, function.restype = [ctypes.c_void_p] * 16, None
        parameters, numbers = np.zeros(64, np.int32), np.zeros(7, np.int32)
        for place, value in PARAMETERS.items():
            parameters[place] = value
        parameters[TWO_LEVELS], parameters[SINGLE] = threads > 1, kind is np.float32
        numbers[[ONE, SIZE, TYPE]] = 1, len(read[0]) - 1, definite
        limit = library["MKL_Set_Num_Threads_Local"]
        return cls._with((limit, function), threads, (numbers, parameters), read)

    @classmethod
    def _with(
        cls, functions: tuple[Any, Any], threads: int, settings: tuple[Ints, Ints], read: tuple[Ints, ...]
    ) -> Self:
        """Call with its own memory."""
        state, (numbers, parameters) = np.zeros(64, np.int64), settings
        at = [address(numbers) + 4 * k for k in range(len(numbers))]
        rows, columns, marks = (*(address(a) for a in read), 0)[:3]
        return cls(
            limit=functions[0],
            function=functions[1],
            threads=threads,
            numbers=numbers,
            parameters=parameters,
            state=state,
            read=read,
            head=(address(state), at[ONE], at[ONE], at[TYPE], at[PHASE], at[SIZE]),
            pattern=(rows, columns, marks, at[COUNT]),
            tail=(address(parameters), at[QUIET]),
        )

    def condensing(self, which: IntArray) -> Self:
        """Call for the same matrix that eliminates all unknowns but ``which`` (k,)."""
        numbers, parameters = self.numbers.copy(), self.parameters.copy()
        parameters[CONDENSED] = 1
        marks = np.zeros(int(numbers[SIZE]), np.int32)
        marks[which] = 1
        return self._with((self.limit, self.function), self.threads, (numbers, parameters), (*self.read[:2], marks))

    def solution(self, values: int, b: int, x: int) -> tuple[IntArray, Ints]:
        """Addresses (17,) of the arguments of a solution for one right-hand side, and of the function; and its numbers,
        which have to be kept.
        """
        numbers = self.numbers.copy()
        numbers[[PHASE, COUNT, ERROR]] = SOLVE, 1, 0
        moved = address(numbers) - address(self.numbers)
        own = range(address(self.numbers), address(self.numbers) + self.numbers.nbytes)
        given = (*self.head, values, *self.pattern, *self.tail, b, x, own[0] + 4 * ERROR)
        function = ctypes.cast(self.function, ctypes.c_void_p).value
        return np.array([*(a + moved if a in own else a for a in given), function], np.int64), numbers

    @contextmanager
    def limited(self) -> Iterator[None]:
        """Let the library use the threads of this call."""
        before = self.limit(self.threads)
        try:
            yield
        finally:
            self.limit(before)

    def __call__(self, phase: int, values: int = 0, count: int = 1, b: int = 0, x: int = 0) -> int:
        """Run a phase and return its error, with the addresses of entries, ``count`` right-hand sides and solutions."""
        self.numbers[PHASE], self.numbers[COUNT] = phase, count
        with self.limited():
            self.function(*self.head, values, *self.pattern, *self.tail, b, x, address(self.numbers) + 4 * ERROR)
        return int(self.numbers[ERROR])
