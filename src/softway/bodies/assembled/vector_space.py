"""Reductions over the nodes of all solids: sums, inner products, greatest values (docs/theory/solver/vector_space.md).

Everything that combines values of many nodes or unknowns into a few goes through a ``VectorSpace``, so that the nodes
may be distributed over several processes.  Values of contact rows and of solids are the same in every process.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.arrays import Array, BoolArray


class VectorSpace(Protocol):
    """Reductions over arrays whose first axis runs over nodes (n, ...) or unknowns (f,)."""

    def greatest(self, *fields: Array) -> float:
        """Greatest magnitude of all values; 0 without values."""
        ...

    def least(self, field: Array) -> float:
        """Least value; infinite without values."""
        ...

    def total(self, density: Array | BoolArray) -> float:
        """Sum of all values."""
        ...

    def mean(self, density: Array) -> float:
        """Mean of all values."""
        ...

    def sums(self, density: Array) -> Array:
        """Sums (...) over the first axis of (n, ...)."""
        ...

    def totals(self, density: Array) -> Array:
        """Sums (parts,) of a nodal quantity (n, ...) over each solid."""
        ...

    def totals_of(self, densities: Sequence[Array]) -> Array:
        """Sums (k, parts) of several nodal quantities (n, d) over each solid, in one message."""
        ...

    def dot(self, a: Array, b: Array) -> float:
        """Inner product of two fields of the same shape."""
        ...

    def norm(self, field: Array) -> float:
        """Euclidean norm of a field."""
        ...

    def products(self, a: Array, b: Array) -> Array:
        """``a^T b`` over the first axis of (n, k) or (n,), and (n, d) or (n,)."""
        ...

    def products_of(self, a: Array, vectors: Sequence[Array]) -> tuple[Array, ...]:
        """``a^T b`` (k,) of several vectors b (n,), in one message."""
        ...

    def works(self, forces: Array, motion: Array) -> Array:
        """Works (k,) of several force fields (k, n, d) along a motion (n, d)."""
        ...

    def every(self, mask: BoolArray) -> bool:
        """True if all values are true."""
        ...

    def gather(self, field: Array) -> Array:
        """Field over the nodes of all processes, for the search of contacts."""
        ...

    @property
    def of_unknowns(self) -> "VectorSpace":
        """Space of arrays whose first axis runs over the unknowns; entries beyond are the same in every process."""
        ...

    def among(self, rows: slice | BoolArray) -> "VectorSpace":
        """Space of some of the nodes."""
        ...

    def filled(self, field: Array) -> Array:
        """Field (n, ...) that is complete at a process's own nodes, with the values of the others at all nodes."""
        ...

    def combined(self, weights: Array, fields: Array) -> Array:
        """Sum (f,) of fields (k, f) with weights (k,)."""
        ...


@dataclass(frozen=True, slots=True)
class LocalSpace:
    """All nodes in one process; ``solids`` are the nodes of each solid.

    Examples
    --------
    >>> space = LocalSpace((slice(0, 1), slice(1, 3)))
    >>> space.totals(np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])).tolist()
    [3.0, 18.0]
    """

    solids: tuple[slice, ...]

    def greatest(self, *fields: Array) -> float:
        """Greatest magnitude of all values."""
        found = [float(np.abs(f).max(initial=0.0)) for f in fields]
        return found[0] if len(found) == 1 else max(found)

    def least(self, field: Array) -> float:
        """Least value."""
        return float(field.min(initial=np.inf))

    def total(self, density: Array | BoolArray) -> float:
        """Sum of all values."""
        return float(np.sum(density))

    def mean(self, density: Array) -> float:
        """Mean of all values."""
        return float(np.mean(density))

    def sums(self, density: Array) -> Array:
        """Sums over the first axis."""
        return np.asarray(density.sum(axis=0))

    def totals(self, density: Array) -> Array:
        """Sums (parts,) over each solid."""
        return np.array([density[rows].sum() for rows in self.solids])

    def totals_of(self, densities: Sequence[Array]) -> Array:
        """Sums (k, parts) over each solid."""
        return np.array([self.totals(density) for density in densities])

    def dot(self, a: Array, b: Array) -> float:
        """Inner product."""
        return float(np.vdot(a, b))

    def norm(self, field: Array) -> float:
        """Euclidean norm."""
        return float(np.linalg.norm(field))

    def products(self, a: Array, b: Array) -> Array:
        """``a^T b`` over the first axis."""
        return np.asarray(a.T @ b)

    def products_of(self, a: Array, vectors: Sequence[Array]) -> tuple[Array, ...]:
        """``a^T b`` of several vectors."""
        return tuple(self.products(a, b) for b in vectors)

    def works(self, forces: Array, motion: Array) -> Array:
        """Works (k,) of force fields along a motion."""
        return np.einsum("kni,ni->k", forces, motion)

    def every(self, mask: BoolArray) -> bool:
        """True if all values are true."""
        return bool(mask.all())

    def gather(self, field: Array) -> Array:
        """The field itself."""
        return field

    @property
    def of_unknowns(self) -> "LocalSpace":
        """The space itself."""
        return self

    def among(self, rows: slice | BoolArray) -> "LocalSpace":
        """The space itself: it sums whatever it gets."""
        return self

    def filled(self, field: Array) -> Array:
        """The field itself."""
        return field

    def combined(self, weights: Array, fields: Array) -> Array:
        """Sum (f,) of weighted fields."""
        return np.asarray(weights @ fields)
