"""Conjugate gradients on a device, with closed rows that its steps leave at rest."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.kernels.device import vectors
from softway.kernels.device.arrays import DeviceMatrix, Sums, fetched, fill, integers, numbers, zeros
from softway.kernels.device.door import wp


class Fields(NamedTuple):
    """Vectors (f,) of an iteration: residual, preconditioned residual and its product, direction and its product,
    solution and its product.
    """

    r: Any
    z: Any
    w: Any
    p: Any
    Ap: Any
    x: Any
    Ax: Any


@dataclass(frozen=True, slots=True, eq=False)
class DeviceRows:
    """Closed rows G (c, f), with their numbers ``index`` (c,), on a device, see
    :class:`~softway.solve.elimination.closed_rows.ClosedRows`.

    ``inverse`` (c, c) is ``S^-1``, refined ``refinements`` times with the ``compliance`` S; where it would have too
    many entries it is None, and ``answer`` solves on the processor.
    """

    matrix: DeviceMatrix
    transposed: DeviceMatrix
    lifted: DeviceMatrix
    pulled: DeviceMatrix
    compliance: DeviceMatrix
    inverse: DeviceMatrix | None
    refinements: int
    answer: Callable[[Array], Array]
    wanted: Any
    force: Any
    missing: Any
    index: Any

    @classmethod
    def of(
        cls,
        matrices: tuple[Any, Any, Any],
        inverse: Any,
        refinements: int,
        answer: Callable[[Array], Array],
        device: str,
        index: IntArray | None = None,
    ) -> "DeviceRows":
        """Copy of G (c, f), ``D^-1 G^T`` (f, c), S (c, c) and its inverse."""
        G, lifted, S = matrices
        c = G.shape[0]
        return cls(
            matrix=DeviceMatrix.of(G, device),
            transposed=DeviceMatrix.of(sp.csr_array(G.T), device),
            lifted=DeviceMatrix.of(lifted, device),
            pulled=DeviceMatrix.of(sp.csr_array(lifted.T), device),
            compliance=DeviceMatrix.of(S, device),
            inverse=None if inverse is None else DeviceMatrix.of(inverse, device),
            refinements=refinements,
            answer=answer,
            wanted=zeros(c, device),
            force=zeros(c, device),
            missing=zeros(c, device),
            index=integers(np.arange(c) if index is None else index, device),
        )

    def multipliers(self, residual: Any) -> Any:
        """Forces (c,) of the rows that balance a residual best, in an array that the next solution overwrites."""
        self.pulled.times(residual, self.wanted)
        self._solve()
        return self.force

    def balance(self, r: Any) -> None:
        """Take the forces of the rows that balance a residual best out of it."""
        self.transposed.times(self.multipliers(r), r, -1.0, 1.0)

    def remove(self, z: Any) -> None:
        """Take the motion of the rows out of a field."""
        self.matrix.times(z, self.wanted)
        self._solve()
        self.lifted.times(self.force, z, -1.0, 1.0)

    def shortest(self, out: Any) -> None:
        """Shortest motion (f,) that moves the rows as ``wanted``."""
        self._solve()
        self.lifted.times(self.force, out)

    def _solve(self) -> None:
        """``force = S^-1 wanted``."""
        if self.inverse is None:
            fill(self.force, self.answer(fetched(self.wanted)))
            return
        self.inverse.times(self.wanted, self.force)
        for _ in range(self.refinements):
            wp.copy(self.missing, self.wanted)
            self.compliance.times(self.force, self.missing, -1.0, 1.0)
            self.inverse.times(self.missing, self.force, 1.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class DeviceDescent:
    """Conjugate gradients with a product ``times(x, out)`` and the inverse ``blocks`` of the nodes, both on a device.

    The steps are those of :class:`~softway.solve.linear.conjugate_gradients.Gradients`: only the number that tells
    whether to go on comes to the processor in a step.
    """

    times: Callable[[Any, Any], None]
    blocks: DeviceMatrix
    fields: Fields
    sums: Sums
    numbers: Any
    device: str

    @classmethod
    def of(cls, times: Callable[[Any, Any], None], blocks: Any, device: str) -> "DeviceDescent":
        """Room for an iteration; ``blocks`` (f, f) is a sparse matrix of SciPy."""
        fields = Fields(*(zeros(max(blocks.shape[0], 1), device) for _ in Fields._fields))
        own = zeros(vectors.NUMBERS, device)
        return cls(times, DeviceMatrix.of(blocks, device), fields, Sums.on(device), own, device)

    def product(self, x: Array) -> Array:
        """Product (f,) with x (f,), in NumPy."""
        fill(self.fields.z, x)
        self.times(self.fields.z, self.fields.w)
        return fetched(self.fields.w)

    def begin(self, b: Array | None) -> None:
        """Start with the right side b (f,), or with the residual as it is, and a zero solution."""
        if b is not None:
            fill(self.fields.r, b)
        for array in (*self.fields[3:], self.numbers):
            array.zero_()

    def descend(
        self, rows: DeviceRows | None, tolerance: float, limit: int, reference: float = 0.0
    ) -> tuple[int, float]:
        """Iterate from :meth:`begin` to the tolerance; number of steps, and squared norm of the first residual."""
        r, z, w, p, Ap, x, Ax = self.fields
        for _ in range(limit):
            if rows is not None:
                rows.balance(r)
            self.blocks.times(r, z)
            if rows is not None:
                rows.remove(z)
            self.times(z, w)
            sums = self.sums.products(r, w, z)
            inputs = [sums, tolerance, reference, self.numbers]
            wp.launch(vectors.decide, dim=1, inputs=inputs, device=self.device)
            inputs = [self.numbers, z, w, p, Ap, x, Ax, r]
            wp.launch(vectors.advance, dim=r.shape, inputs=inputs, device=self.device)
            if fetched(self.numbers)[5] > 0.0:
                break
        told = fetched(self.numbers)
        return int(told[6]), float(told[0])

    def solution(self) -> tuple[Array, Array]:
        """Solution and its product (f,), in NumPy."""
        return fetched(self.fields.x), fetched(self.fields.Ax)


@dataclass(frozen=True, slots=True, eq=False)
class SlabProduct:
    """Product ``J^T (M + factor K(u)) J`` on a device, from unknowns (f,) to forces on them.

    Parameters
    ----------
    cells, u
        The cells, and the displacement (n, d) of the tangent K.
    jacobian, transposed, mass
        J (n d, f), its transpose and M (n, n).
    factor
        Factor of the tangent [s^2].
    """

    cells: Any
    u: Any
    jacobian: DeviceMatrix
    transposed: DeviceMatrix
    mass: DeviceMatrix
    factor: float
    field: Any
    force: Any

    @classmethod
    def of(cls, cells: Any, u: Array, jacobian: Any, mass: Any, factor: float) -> "SlabProduct":
        """Copy of the matrices of SciPy; ``cells`` are on their device."""
        device = cells.device
        J, T, M = (DeviceMatrix.of(m, device) for m in (jacobian, sp.csr_array(jacobian.T), mass))
        room = [zeros(cells.shape, device) for _ in range(2)]
        return cls(cells, numbers(u, device), J, T, M, factor, *room)

    def __call__(self, x: Any, out: Any) -> None:
        """Write the product with x (f,) to ``out``."""
        self.jacobian.times(x, self.field.flatten())
        self.cells.product(self.u, self.field, self.force)
        self.mass.times_nodes(self.field, self.force, 1.0, self.factor)
        self.transposed.times(self.force.flatten(), out)
