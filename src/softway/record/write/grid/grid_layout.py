"""Layout of all solids in one unstructured grid: one list of points, one list of cells, and the solid of each cell."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.mesh import Mesh

VTK = {
    "bar2": 3,
    "bar3": 21,
    "tri3": 5,
    "tri6": 22,
    "quad4": 9,
    "quad8": 23,
    "quad9": 28,
    "tet4": 10,
    "tet10": 24,
    "hex8": 12,
    "hex20": 25,
    "hex27": 29,
}
"""VTK cell type of each element; the node orders agree."""
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
"""Order of the six components of a symmetric tensor in VTK: xx yy zz xy yz xz."""


class Grid(Protocol):
    """Solids, reference coordinates, and cells in the format of VTK with the numbers of their solids."""

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the solids in order."""
        ...

    @property
    def dimension(self) -> int:
        """Dimension d of space."""
        ...

    @property
    def reference(self) -> Array:
        """Reference coordinates (n, 3) [m]."""
        ...

    @property
    def connectivity(self) -> IntArray:
        """Nodes (k,) of all cells."""
        ...

    @property
    def offsets(self) -> IntArray:
        """Starts (e + 1,) of the cells in the connectivity."""
        ...

    @property
    def types(self) -> IntArray:
        """VTK types (e,) of the cells."""
        ...

    @property
    def body(self) -> IntArray:
        """Number (e,) of the solid of each cell."""
        ...


def blocks(grid: Grid) -> dict[str, IntArray]:
    """Connectivity (cells, nodes) by cell name."""
    out = {}
    for name, mine in _named(grid).items():
        width = int(grid.offsets[mine[0] + 1] - grid.offsets[mine[0]])
        out[name] = grid.connectivity[grid.offsets[mine][:, None] + np.arange(width)]
    return out


def owners(grid: Grid) -> dict[str, IntArray]:
    """Numbers (cells,) of the solids of the cells by cell name, in the order of :func:`blocks`."""
    return {name: grid.body[mine] for name, mine in _named(grid).items()}


def _named(grid: Grid) -> dict[str, IntArray]:
    """Numbers (cells,) of the cells with each name."""
    return {name: np.flatnonzero(grid.types == kind) for name, kind in VTK.items() if (grid.types == kind).any()}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layout:
    """Grid that holds all solids one after the other; d is the dimension of space.

    Parameters
    ----------
    bodies
        Names of the solids in order; the cell array ``body`` numbers them from 0.
    rows
        Points of each solid in the grid, by name.
    reference
        (n, 3) reference coordinates [m].
    connectivity, offsets, types, body
        Cells in the format of VTK: (k,), (e + 1,), (e,); and (e,) number of the solid of each cell.
    touching
        (m,) slave point of each contact row, by contact.
    dimension
        Dimension d of space.
    """

    bodies: tuple[str, ...]
    rows: Mapping[str, slice]
    reference: Array
    connectivity: IntArray
    offsets: IntArray
    types: IntArray
    body: IntArray
    touching: Mapping[str, IntArray]
    dimension: int

    def nodal(self, fields: Mapping[str, Array]) -> Array:
        """Vector field (n, 3) on the grid from the fields of the solids (n, d)."""
        out = np.zeros((len(self.reference), 3))
        for name, rows in self.rows.items():
            out[rows, : self.dimension] = fields[name]
        return out

    def forces(self, pressure: Mapping[str, Array]) -> Array:
        """Normal contact force (n,) on the slave points from the forces of the contact rows (m,) [N]."""
        out = np.zeros(len(self.reference))
        for name, points in self.touching.items():
            np.add.at(out, points, pressure[name])
        return out

    def tangential(self, traction: Mapping[str, Array]) -> Array:
        """Tangential contact force (n, 3) on the slave points from the forces of the contact rows (m, d) [N]."""
        out = np.zeros((len(self.reference), 3))
        for name, points in self.touching.items():
            np.add.at(out[:, : self.dimension], points, traction[name])
        return out


def layout(meshes: Mapping[str, Mesh], touching: Mapping[str, IntArray]) -> Layout:
    """Lay out the solids in one grid, with the slave points of each contact."""
    counts = [mesh.n_nodes for mesh in meshes.values()]
    ends = np.cumsum([0, *counts])
    rows = {name: slice(int(a), int(b)) for name, a, b in zip(meshes, ends[:-1], ends[1:], strict=True)}
    cells = [
        (name, body, kind, nodes)
        for body, (name, mesh) in enumerate(meshes.items())
        for kind, nodes in mesh.blocks.items()
    ]
    sizes = np.concatenate([np.full(len(nodes), nodes.shape[1]) for *_, nodes in cells])
    dimension = next(iter(meshes.values())).dim
    reference = np.zeros((int(ends[-1]), 3))
    for name, mesh in meshes.items():
        reference[rows[name], :dimension] = mesh.points
    return Layout(
        bodies=tuple(meshes),
        rows=rows,
        reference=reference,
        connectivity=np.concatenate([(nodes + rows[name].start).ravel() for name, _, _, nodes in cells]),
        offsets=np.concatenate([[0], np.cumsum(sizes)]),
        types=np.concatenate([np.full(len(nodes), VTK[kind]) for _, _, kind, nodes in cells]),
        body=np.concatenate([np.full(len(nodes), body) for _, body, _, nodes in cells]),
        touching=touching,
        dimension=dimension,
    )


def components(stress: Array) -> Array:
    """Six components (e, 6) of symmetric tensors (e, 3, 3), in the order of ``PAIRS``."""
    return np.stack([0.5 * (stress[:, i, j] + stress[:, j, i]) for i, j in PAIRS], axis=1)


def von_mises(stress: Array) -> Array:
    """Von Mises equivalent stress ``sqrt(3/2 s : s)`` (e,) of Cauchy stresses (e, 3, 3).

    Examples
    --------
    >>> von_mises(np.diag([2.0, 0.0, 0.0])[None])
    array([2.])
    """
    s = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
    return np.sqrt(1.5 * np.einsum("eij,eij->e", s, s))
