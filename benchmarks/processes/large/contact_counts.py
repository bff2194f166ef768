"""Counts of what solves and forces have to move, by wrappers around their methods in a process of one's own."""

from collections.abc import Callable
from dataclasses import fields
from time import process_time
from typing import Any

import numpy as np

from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.solve.linear.backends.pardiso import _Factor
from softway.solve.linear.conjugate_gradients import Gradients

VECTORS = 20
"""Vectors that a step of the conjugate gradients reads or writes."""


class Counted:
    """What was done since the last reset: bytes moved, inner steps, solutions with a factor, forces, and times [s].

    Bytes are counted once for every array that has to pass: the matrix, the diagonal blocks and ``VECTORS`` vectors in
    an inner step, a factor twice in a solution, tables and nodal fields in a force.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Count from zero."""
        self.bytes, self.steps, self.solutions, self.forces = 0.0, 0, 0, 0
        self.solving = self.forcing = 0.0

    def inner(self, found: Any, gradients: Gradients, *given: Any) -> None:
        """Conjugate gradients have ended."""
        matrix, blocks = getattr(gradients.times, "__self__", None), gradients.preconditioner.matrix
        once = sum(part.nbytes for m in (matrix, blocks) if m is not None for part in (m.data, m.indices))
        self.steps += found.steps
        self.bytes += found.steps * (once + VECTORS * found.x.nbytes)

    def solved(self, found: Any, factor: _Factor, b: np.ndarray) -> None:
        """A factor has solved for one or more columns."""
        self.solutions += 1
        self.bytes += 2 * factor.bytes

    def forced(self, found: Any, work: KernelEvaluation, u: np.ndarray) -> None:
        """A force has been evaluated."""
        self.forces += 1
        self.bytes += 2 * u.nbytes + sum(_bytes(block) for block in work.cells.blocks)


def _bytes(block: Any) -> int:
    """Bytes of the arrays of a block of cells that a force reads: all but the places of its entries in a matrix."""
    arrays = (getattr(block, f.name) for f in fields(block) if f.name != "pairs")
    return sum(a.nbytes for a in arrays if isinstance(a, np.ndarray))


def streamed(size: int = 2**27, times: int = 6) -> float:
    """Greatest bandwidth at which one thread reads an array of ``size`` bytes [GB/s of its processor time]."""
    array, least = np.ones(size // 8), np.inf
    for _ in range(times):
        start = process_time()
        array.sum()
        least = min(least, process_time() - start)
    return size / least / 1e9


def watched() -> Counted:
    """Counts of conjugate gradients, of PARDISO's factors and of elastic forces in this process, from now on."""
    seen = Counted()
    _wrap(Gradients, "descend", seen, "solving", seen.inner)
    _wrap(_Factor, "solve", seen, "solving", seen.solved)
    for name in ("energy_and_force", "energies_and_force"):
        _wrap(KernelEvaluation, name, seen, "forcing", seen.forced)
    return seen


def _wrap(owner: type, name: str, seen: Counted, clock: str, note: Callable[..., None]) -> None:
    plain = getattr(owner, name)

    def timed(*given: Any, **named: Any) -> Any:
        start = process_time()
        found = plain(*given, **named)
        setattr(seen, clock, getattr(seen, clock) + process_time() - start)
        note(found, *given)
        return found

    setattr(owner, name, timed)
