"""Quadrature of the elements of a body, and its tables for the laws and the kernels."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import csr_array, vstack

from softway.arrays import Array, IntArray
from softway.bodies.elements.dilatation_averages import cell_mean, corner_mean
from softway.bodies.elements.mean_dilatation import MeanDilatation
from softway.bodies.elements.section import Axisymmetric, Bar, PlaneStress, Section, check_section, sampled_rows
from softway.bodies.elements.strain_operator import StrainOperator
from softway.errors import InputError
from softway.kernels.assembly.assembler import assembler, gather_table
from softway.kernels.geometry.jacobians import cell_geometry
from softway.meshes.cells import linear
from softway.meshes.element import Element, element, stiffness_degree, tabulate
from softway.meshes.mesh import Mesh

Dilating = Literal["point", "mean", "corner"]
"""Volume change in an element: at each point, as its mean over the element, or as its averages around the corner nodes
with linear interpolation.
"""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Cells:
    """Elements of one cell type in the order of the mesh.

    Parameters
    ----------
    element
        Shape functions and quadrature.
    nodes
        (e, a) node numbers.
    corners
        (e, a, d) coordinates of the nodes [m].
    volume
        (e, q) reference volume of the points [m^3].
    """

    element: Element
    nodes: IntArray
    corners: Array
    volume: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SampledCells:
    """Elements of a body with their strain operator.

    Parameters
    ----------
    kinds
        Elements of each cell type.
    sampling
        Strain operator between nodes and quadrature points.
    directions
        (p, m, D) or (1, m, D) reference directions of the points.
    """

    kinds: tuple[Cells, ...]
    sampling: StrainOperator
    directions: Array


def sampled_cells(mesh: Mesh, section: Section, dilatation: Dilating, small: bool) -> SampledCells:
    """Build the quadrature tables of a body.

    The quadrature integrates the stiffness of the undistorted element exactly; around an axis of revolution its degree
    is higher by two.  ``small`` is True for the linear theory.

    Raises
    ------
    InputError
        If the section does not fit the elements, or ``dilatation`` is not "point" in a section with a free thickness.
    """
    check_section(mesh, section)
    if dilatation != "point" and isinstance(section, Bar | PlaneStress):
        problem = f"{dilatation!r} with the section {type(section).__name__}, whose thickness is free to change"
        raise InputError("dilatation", problem, "'point'")
    kinds, rows, directions = zip(*(_cells(mesh, cell, section) for cell in mesh.blocks), strict=True)
    nodes: list[IntArray] = list(mesh.blocks.values())
    tables = [gather_table(c, G, mesh.n_nodes) for c, G in zip(nodes, rows, strict=True)]
    table = tables[0] if len(tables) == 1 else csr_array(vstack(tables, format="csr"))
    volume = np.concatenate([cells.volume.ravel() for cells in kinds])
    sampling = StrainOperator(
        section=section,
        volume=volume,
        table=table,
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
) -> MeanDilatation | None:
    """Averaged volume change of the elements; None for the volume change of each point."""
    if chosen == "point":
        return None
    volume = np.concatenate([cells.volume.ravel() for cells in kinds])
    if chosen == "mean":
        return MeanDilatation(section=section, rows=rows, smoothing=cell_mean(rows, volume), small=small)
    corners = [tabulate(linear(c.element.cell), c.element.points)[0] for c in kinds]
    smoothing = corner_mean([c.nodes for c in kinds], corners, volume, mesh.n_nodes, mesh.dim)
    return MeanDilatation(section=section, rows=rows, smoothing=smoothing, small=small)


def _cells(mesh: Mesh, cell: str, section: Section) -> tuple[Cells, Array, Array]:
    """Elements of one cell type, rows (e, q, a, k) of their strain operator, and directions (e q, m, D)."""
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
    """Directions (p, m, D), or (1, m, D) if all points have equal ones."""
    return directions[:1].copy() if np.all(directions == directions[:1]) else directions
