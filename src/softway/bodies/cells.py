"""The cells of a body with their quadrature, as the laws and the kernels need them."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import csr_array, vstack

from softway.bodies.dilatation import Dilatation
from softway.bodies.sampling import Sampling
from softway.bodies.section import Axisymmetric, Bar, PlaneStress, Section, check_section, sampled_rows
from softway.bodies.smoothing import cell_mean, corner_mean
from softway.errors import InputError
from softway.kernels.gather import assembler, gather_table
from softway.kernels.geometry import cell_geometry
from softway.space.cells import linear
from softway.space.element import Element, element, stiffness_degree, tabulate
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray

Dilating = Literal["point", "mean", "corner"]
"""Whether the change of volume is taken at each point of a cell, as its mean over the cell, or as its means around the
corners of the cells with linear interpolation in between.
"""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Cells:
    """Cells of one kind as the mesh has them: ``element``, ``nodes`` (e, a), their places ``corners`` (e, a, d) [m] and
    the ``volume`` (e, q) [m^3] of the points.
    """

    element: Element
    nodes: IntArray
    corners: Array
    volume: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SampledCells:
    """The cells of a body, kind by kind, their :class:`Sampling`, and the reference directions (p, m, D) or (1, m, D)
    of their points.
    """

    kinds: tuple[Cells, ...]
    sampling: Sampling
    directions: Array


def sampled_cells(mesh: Mesh, section: Section, dilatation: Dilating, small: bool) -> SampledCells:
    """Quadrature and tables of a body.

    The quadrature integrates the stiffness of the undistorted cell exactly; around an axis of revolution it has two
    degrees more.  ``small``: whether strains are those of the linear theory.

    Raises
    ------
    InputError
        If the cells cannot fill space in this way, or have no volume of their own to take the mean of.
    """
    check_section(mesh, section)
    if dilatation != "point" and isinstance(section, Bar | PlaneStress):
        problem = f"{dilatation!r} in a {type(section).__name__}, whose thickness is free to change"
        raise InputError("dilatation", problem, "'point'")
    kinds, rows, directions = zip(*(_cells(mesh, cell, section) for cell in mesh.blocks), strict=True)
    nodes: list[IntArray] = list(mesh.blocks.values())
    tables = [gather_table(c, G, mesh.n_nodes) for c, G in zip(nodes, rows, strict=True)]
    table = csr_array(vstack(tables, format="csr"))
    volume = np.concatenate([cells.volume.ravel() for cells in kinds])
    sampling = Sampling(
        section=section,
        volume=volume,
        table=table,
        transposed=table.T.tocsr(),
        rows=rows,
        pattern=assembler(nodes, mesh.n_nodes, mesh.dim),
        dilatation=_dilatation(mesh, section, dilatation, small, kinds, rows),
    )
    return SampledCells(kinds=kinds, sampling=sampling, directions=_merged(np.concatenate(directions)))


def _dilatation(
    mesh: Mesh,
    section: Section,
    chosen: Dilating,
    small: bool,
    kinds: tuple[Cells, ...],
    rows: tuple[Array, ...],
) -> Dilatation | None:
    """What the law sees of the change of volume, None where it sees it as it is."""
    if chosen == "point":
        return None
    volume = np.concatenate([cells.volume.ravel() for cells in kinds])
    if chosen == "mean":
        return Dilatation(section=section, rows=rows, smoothing=cell_mean(rows, volume), small=small)
    corners = [tabulate(linear(c.element.cell), c.element.points)[0] for c in kinds]
    smoothing = corner_mean([c.nodes for c in kinds], corners, volume, mesh.n_nodes, mesh.dim)
    return Dilatation(section=section, rows=rows, smoothing=smoothing, small=small)


def _cells(mesh: Mesh, cell: str, section: Section) -> tuple[Cells, Array, Array]:
    """Cells of one kind, their rows (e, q, a, k) and the directions (e q, m, D) of their points."""
    table = element(cell, stiffness_degree(cell) + (2 if isinstance(section, Axisymmetric) else 0))
    corners = mesh.points[mesh.blocks[cell]]
    gradients, measures, directions = cell_geometry(corners, table.dN, table.weights)
    x = np.einsum("qa,ead->eqd", table.N, corners)
    volume = measures * section.measure(x)
    rows = np.ascontiguousarray(sampled_rows(section, gradients, table.N, x))
    m = 3 if isinstance(section, Axisymmetric) else directions.shape[-2]
    if m != directions.shape[-2]:
        directions = np.broadcast_to(np.eye(m), (*volume.shape, m, m))
    cells = Cells(element=table, nodes=mesh.blocks[cell], corners=corners, volume=volume)
    return cells, rows, directions.reshape(-1, *directions.shape[-2:])


def _merged(directions: Array) -> Array:
    """One set of directions (1, m, D) if all points share it."""
    return directions[:1].copy() if np.all(directions == directions[:1]) else directions
