"""Conjugate gradients on a device behind the interface of those of the processor."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import Array, IntArray
from softway.solve.device.library import launches
from softway.solve.elimination.closed_rows import REFINEMENTS, ClosedRows, lift_of
from softway.solve.elimination.contact_sweeps import Projection
from softway.solve.linear.conjugate_gradients import Descent
from softway.solve.linear.interface import Factor

if TYPE_CHECKING:
    from softway.kernels.device.gradients import DeviceDescent, DeviceRows

TOGETHER = 64
"""Greatest number of rows that depend on each other, up to which their compliance is inverted for the device."""


@dataclass(frozen=True, slots=True, eq=False)
class DeviceGradients:
    """Conjugate gradients whose vectors stay on a device from the right side to the solution.

    See :class:`~softway.solve.linear.conjugate_gradients.Gradients`; the ``preconditioner`` is that on the processor,
    for contact forces.

    Parameters
    ----------
    descent
        The iteration on the device.
    preconditioner
        Inverse of the blocks of the nodes.
    tolerance, limit
        Residual at which a solution ends, relative to the right side, and greatest number of products.
    """

    descent: "DeviceDescent"
    preconditioner: Factor
    tolerance: float
    limit: int
    bytes: int = 0
    indefinite: bool = False
    kept: "list[tuple[ClosedRows, DeviceRows]]" = field(default_factory=list)

    def times(self, x: Array) -> Array:
        """Product (f,) with the matrix."""
        return self.descent.product(x)

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k) to the tolerance."""
        if b.ndim == 2:
            return np.stack([self.solve(column) for column in b.T], axis=1)
        return self.descend(b, Projection(None, self.preconditioner)).x

    def descend(
        self, b: Array, precondition: Callable[[Array], tuple[Array, Array]], reference: float = 0.0
    ) -> Descent:
        """Solution for b (f,) in the range of a preconditioner, with the closed rows that it leaves at rest."""
        assert isinstance(precondition, Projection)
        self.descent.begin(b)
        rows = None if precondition.closed is None else self._rows(precondition.closed)
        steps, first = self.descent.descend(rows, self.tolerance, self.limit, reference)
        x, Ax = self.descent.solution()
        return Descent(x=x[: len(b)], Ax=Ax[: len(b)], first=first, steps=steps)

    def _rows(self, closed: ClosedRows) -> "DeviceRows":
        """Closed rows on the device; the last ones are kept."""
        if not self.kept or self.kept[0][0] is not closed:
            self.kept[:] = [(closed, device_rows(closed, self.descent.device))]
        return self.kept[0][1]


def device_rows(closed: ClosedRows, device: str, index: IntArray | None = None) -> "DeviceRows":
    """Closed rows on a device, with their numbers ``index`` (c,) among all rows."""
    matrices = closed.matrix, closed.lifted, sp.csr_array(closed.compliance)
    refinements = 0 if closed.factor is None else REFINEMENTS
    made: DeviceRows = launches().DeviceRows.of(matrices, _inverse(closed), refinements, closed.forces, device, index)
    return made


def _inverse(closed: ClosedRows) -> sp.csr_array | None:
    """Inverse (c, c) of the compliance S by its groups of dependent rows; None where one has more than ``TOGETHER``."""
    if closed.factor is None:
        return sp.csr_array(sp.diags_array(1.0 / closed.diagonal))
    count, group = connected_components(closed.compliance, directed=False)
    if np.bincount(group).max() > TOGETHER:
        return None
    lift, S = lift_of(closed.diagonal), sp.csr_array(closed.compliance)
    order = np.argsort(group, kind="stable")
    blocks = []
    for rows in np.split(order, np.cumsum(np.bincount(group, minlength=count))[:-1]):
        blocks.append(np.linalg.inv(S[rows][:, rows].toarray() + lift * np.eye(len(rows))))
    whole = sp.block_diag(blocks, format="csr")
    back = np.argsort(order, kind="stable")
    return sp.csr_array(sp.csr_array(whole)[back][:, back])
