"""Internal force of elastic bodies on a device, see :mod:`softway.kernels.device.cells`."""

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation

if TYPE_CHECKING:
    from softway.kernels.device.device_cells import DeviceCells


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeviceEvaluation:
    """Energy, force and products of the tangent on a device; its entries, on the processor.

    The displacement u is (n, d) [m].

    Parameters
    ----------
    processor
        Evaluation by the kernels of the processor.
    cells
        The cells on the device.
    """

    processor: KernelEvaluation
    cells: "DeviceCells"

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy [J] and its derivative with respect to the displacement, (n, d) [N]."""
        out = _zeros(self.cells)
        self.cells.force(_placed(self.cells, u), out)
        return float(self.cells.part_energies()[0]), np.array(out.numpy())

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]."""
        return self.processor.tangent(u)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        out = _zeros(self.cells)
        self.cells.product(_placed(self.cells, u), _placed(self.cells, w), out)
        return np.array(out.numpy())

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        return self.cells.diagonal_blocks(_placed(self.cells, u))


def _zeros(cells: "DeviceCells") -> Any:
    return _arrays().zeros(cells.shape, cells.device)


def _placed(cells: "DeviceCells", u: Array) -> Any:
    return _arrays().numbers(u, cells.device)


def _arrays() -> Any:
    return importlib.import_module("softway.kernels.device.arrays")
