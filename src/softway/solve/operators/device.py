"""Conjugate gradients on a GPU: forces of the cells, products, preconditioner and contact rows on one device."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.vector_space import LocalSpace
from softway.bodies.internal_force.device_force import cell_groups, served
from softway.errors import InputError, within
from softway.model.model import Model
from softway.solve.checks import check_products
from softway.solve.device.gradients import DeviceGradients
from softway.solve.device.library import INSTALL, available, cells, check_device, device_named, launches
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.interface import Analysis
from softway.solve.operators.interface import BuiltOperator
from softway.solve.operators.matrix_free import nodal


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """Jacobi-preconditioned conjugate gradients without a matrix on a CUDA device.

    Internal forces are evaluated there, too.  Solids are elastic (``LinearElastic``, ``StVenantKirchhoff``,
    ``NeoHookean``) in cells that fill their space or a plane; closed contact rows are eliminated on the device.  The
    same kernels run on the processor.  Needs Warp (``pip install 'softway[gpu]'``; docs/reference/runs/device.md).

    Parameters
    ----------
    device
        ``auto`` for the first CUDA device, and the processor where there is none; ``cpu``, or a name such as
        ``cuda:0``.
    tolerance
        Residual at which a solution ends, relative to the right side; the fixed point corrects the rest.
    limit
        Greatest number of products of a solution.

    References
    ----------
    Hestenes, Stiefel (1952), J. Res. Nat. Bur. Standards 49, 409-436; Macklin (2022), Warp: A High-performance Python
    Framework for GPU Simulation and Graphics, https://github.com/nvidia/warp.

    Examples
    --------
    >>> Device(device="cuda:0").limit
    500
    """

    device: str = "auto"
    tolerance: float = 1e-2
    limit: int = 500

    def __post_init__(self) -> None:
        check_device(self.device)
        check_products(self.tolerance, self.limit)

    def require(self, model: Model) -> None:
        """Refuse every model without Warp, devices that are missing, and models whose forces no device evaluates."""
        if not available():
            raise InputError("", "Device without Warp", f"{INSTALL}, or the operator ConjugateGradients")
        with within("device"):
            device_named(self.device)
        remedy = "the operator ConjugateGradients"
        if not isinstance(model.space, LocalSpace):
            raise InputError("", "Device on several ranks", remedy)
        if model.companions:
            raise InputError("", f"Device with {model.companions[0].field.name}", remedy)
        require_served(model, "Device", remedy)

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        model, device = slab.model, device_named(self.device)
        groups = [
            group
            for k, part in enumerate(model.parts)
            for group in cell_groups(part.internal, np.arange(part.nodes.start, part.nodes.stop), k)
        ]
        placed = cells().DeviceCells.of(groups, model.shape, len(model.parts), device)
        product = launches().SlabProduct.of(placed, u, model.dofs.jacobian, model.mass, slab.stiffness_factor)
        local = nodal(slab, u)
        descent = launches().DeviceDescent.of(product, local.matrix, device)
        gradients = DeviceGradients(descent, local, self.tolerance, self.limit)
        return BuiltOperator(factor=gradients, local=local, analysis=None, price=1.0)


def require_served(model: Model, what: str, remedy: str) -> None:
    """Refuse solids with forces that no device evaluates.

    Raises
    ------
    InputError
        With the solid.
    """
    for part in model.parts:
        if not served(part.internal):
            law = "LinearElastic, StVenantKirchhoff or NeoHookean in cells that fill their space or a plane"
            raise InputError("", f"{what} with the solid '{part.name}'", f"{law}, or {remedy}")
