"""Cells of one or several solids on a device: energy, force, products and diagonal blocks of the tangent."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.device import cells
from softway.kernels.device.arrays import Sums, fetched, integers, numbers, zeros
from softway.kernels.device.door import wp


class CellGroup(NamedTuple):
    """Cells of one type and one law: number and constants of the ``law`` [Pa], ``nodes`` (e, a), ``table`` (q, a, 3)
    and ``geometry`` (e, q, 10), see :mod:`softway.kernels.device.cells`; they belong to the solid ``part``.
    """

    law: int
    moduli: tuple[float, float]
    nodes: IntArray
    table: Array
    geometry: Array
    part: int = 0


class Launched(NamedTuple):
    """Arguments of a group, its first row of forces and its first cell."""

    law: tuple[Any, ...]
    first: int
    cell: int
    arrays: tuple[Any, ...]
    size: tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeviceCells:
    """Cells on a device.

    Parameters
    ----------
    device
        Name of the device.
    shape
        (n, d) of nodal fields.
    groups
        The groups, in the order of the solids.
    start, places
        (n + 1,), (r,) rows of forces of the cells of each node.
    own, energies
        Room for forces (r, d) and energies (cells,) of the cells.
    ends
        (parts + 1,) first cell of each solid.
    """

    device: str
    shape: tuple[int, int]
    groups: tuple[Launched, ...]
    start: Any
    places: Any
    own: Any
    energies: Any
    sums: Sums
    ends: IntArray

    @classmethod
    def of(cls, groups: Sequence[CellGroup], shape: tuple[int, int], parts: int, device: str) -> "DeviceCells":
        """Copy of groups of cells; those of a solid follow each other."""
        n, d = shape
        launched, of, rows, counts = [], [], 0, np.zeros(parts + 1, int)
        for group in groups:
            e, a = group.nodes.shape
            arrays = (
                integers(group.nodes.T, device),
                numbers(group.table, device),
                numbers(group.geometry.transpose(1, 2, 0), device),
            )
            law = (group.law, *group.moduli, d)
            launched.append(Launched(law, rows, int(counts.sum()), arrays, (e, a)))
            of.append(group.nodes.T.ravel())
            rows, counts[group.part + 1] = rows + e * a, counts[group.part + 1] + e
        node = np.concatenate([np.zeros(0, int), *of])
        start = np.concatenate([[0], np.cumsum(np.bincount(node, minlength=n))])
        return cls(
            device=device,
            shape=shape,
            groups=tuple(launched),
            start=integers(start, device),
            places=integers(np.argsort(node, kind="stable"), device),
            own=zeros((max(rows, 1), d), device),
            energies=zeros(max(int(counts.sum()), 1), device),
            sums=Sums.on(device, 1),
            ends=np.cumsum(counts),
        )

    def force(self, u: Any, out: Any) -> None:
        """Write the internal force of the displacement u to ``out`` (n, d), both on the device."""
        for group in self.groups:
            inputs = [*group.law, group.first, group.cell, *group.arrays, u.flatten(), self.own, self.energies]
            wp.launch(cells.force, dim=group.size[0], inputs=inputs, device=self.device)
        self._gather(self.own, out)

    def part_energies(self) -> Array:
        """Energies (parts,) of the solids [J], of the last :meth:`force`."""
        found = np.zeros(len(self.ends) - 1)
        for k, (a, b) in enumerate(zip(self.ends[:-1], self.ends[1:], strict=True)):
            if b > a:
                found[k] = fetched(self.sums.sums(self.energies[int(a) : int(b)].reshape((1, int(b - a)))))[0, 0]
        return found

    def product(self, u: Any, w: Any, out: Any) -> None:
        """Write the product of the tangent at u with w to ``out``; all (n, d) on the device."""
        for group in self.groups:
            inputs = [*group.law, group.first, *group.arrays, u.flatten(), w.flatten(), self.own]
            wp.launch(cells.product, dim=group.size[0], inputs=inputs, device=self.device)
        self._gather(self.own, out)

    def diagonal_blocks(self, u: Any) -> Array:
        """Diagonal blocks (n, d, d) of the tangent at u [N/m], in NumPy."""
        n, d = self.shape
        own, out = zeros((self.own.shape[0], d * d), self.device), zeros((n, d * d), self.device)
        for group in self.groups:
            inputs = [*group.law, group.first, *group.arrays, u.flatten(), own]
            wp.launch(cells.diagonal, dim=group.size, inputs=inputs, device=self.device)
        self._gather(own, out)
        return fetched(out).reshape(n, d, d)

    def _gather(self, own: Any, out: Any) -> None:
        wp.launch(cells.gather, dim=out.shape, inputs=[self.start, self.places, own, out], device=self.device)
