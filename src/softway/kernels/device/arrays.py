"""Arrays, sparse matrices and sums on a device, from arrays of NumPy and SciPy."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.kernels.device import vectors
from softway.kernels.device.door import wp


def place_of(device: str) -> str:
    """Name of the device: ``auto`` is the first CUDA device, and the processor where there is none.

    Raises
    ------
    ValueError
        If Warp does not know the device.
    """
    wp.init()
    if device == "auto":
        return "cuda:0" if wp.get_cuda_devices() else "cpu"
    return str(wp.get_device(device).alias)


def numbers(values: Array, device: str) -> Any:
    """Copy of double-precision numbers on a device."""
    return wp.array(np.ascontiguousarray(values, float), dtype=wp.float64, device=device)


def integers(values: IntArray, device: str) -> Any:
    """Copy of whole numbers on a device."""
    return wp.array(np.ascontiguousarray(values, np.int32), dtype=wp.int32, device=device)


def zeros(shape: int | tuple[int, ...], device: str) -> Any:
    """Zeros on a device."""
    return wp.zeros(shape, dtype=wp.float64, device=device)


def fill(array: Any, values: Array) -> None:
    """Copy numbers into an array on a device."""
    wp.copy(array, wp.array(np.ascontiguousarray(values, float), dtype=wp.float64, device="cpu", copy=False))


def fetched(array: Any) -> Array:
    """Copy of an array of a device, in NumPy."""
    return np.array(array.numpy())


@dataclass(frozen=True, slots=True, eq=False)
class DeviceMatrix:
    """Sparse matrix (m, k) on a device, by rows."""

    start: Any
    columns: Any
    values: Any
    rows: int

    @classmethod
    def of(cls, matrix: Any, device: str) -> "DeviceMatrix":
        """Copy of a sparse matrix of SciPy."""
        rows = sp.csr_array(matrix)
        rows.sum_duplicates()
        return cls(
            integers(rows.indptr, device), integers(rows.indices, device), numbers(rows.data, device), rows.shape[0]
        )

    def times(self, x: Any, out: Any, scale: float = 1.0, before: float = 0.0) -> None:
        """``out = scale A x + before out`` for vectors (k,) and (m,)."""
        if self.rows:
            inputs = [self.start, self.columns, self.values, x, scale, before, out]
            wp.launch(vectors.times, dim=self.rows, inputs=inputs, device=out.device)

    def times_nodes(self, x: Any, out: Any, scale: float = 1.0, before: float = 0.0) -> None:
        """``out = scale A x + before out`` for fields (n, d)."""
        inputs = [self.start, self.columns, self.values, x, scale, before, out]
        wp.launch(vectors.times_nodes, dim=out.shape, inputs=inputs, device=out.device)


@dataclass(frozen=True, slots=True, eq=False)
class Sums:
    """Room for sums in a fixed order: three levels of partial sums of ``rows`` sums at once."""

    wide: Any
    narrow: Any
    total: Any

    @classmethod
    def on(cls, device: str, rows: int = 2) -> "Sums":
        """Room on a device."""
        wide, narrow = (zeros((rows, width), device) for width in (vectors.WIDTH, vectors.NARROW))
        return cls(wide, narrow, zeros((rows, 1), device))

    def products(self, a: Any, b: Any, c: Any) -> Any:
        """Sums (2, 1) of a.c and b.c on the device."""
        wp.launch(vectors.partial, dim=vectors.WIDTH, inputs=[a, b, c, self.wide], device=c.device)
        return self._folded()

    def sums(self, values: Any) -> Any:
        """Sums (rows, 1) of the rows of an array on the device."""
        self._fold(values, self.wide)
        return self._folded()

    def _folded(self) -> Any:
        self._fold(self.wide, self.narrow)
        self._fold(self.narrow, self.total)
        return self.total

    def _fold(self, values: Any, out: Any) -> None:
        wp.launch(vectors.fold, dim=out.shape, inputs=[values, out], device=out.device)
