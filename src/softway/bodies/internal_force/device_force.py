"""Forces of solids on a device: which ones a device evaluates, and the cells of their kernels as groups for it."""

import importlib
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.elements.kernel_cells import Block
from softway.bodies.elements.section import Axisymmetric
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.elastic.device_evaluation import DeviceEvaluation
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.regions import RegionForces
from softway.kernels.jit.lanes import LANES
from softway.laws.bulk import LinearElastic, NeoHookean, StVenantKirchhoff

if TYPE_CHECKING:
    from softway.kernels.device.device_cells import CellGroup

LAWS: dict[type, int] = {LinearElastic: 0, StVenantKirchhoff: 1, NeoHookean: 2}
"""Numbers of the laws, see :mod:`softway.kernels.device.materials`."""


def served(internal: BodyForce) -> bool:
    """True for forces that a device evaluates: of the laws of ``LAWS`` in cells that fill their space or a plane."""
    if isinstance(internal, RegionForces):
        return all(served(term.internal) for term in internal.terms)
    if not isinstance(internal, ElasticForce) or isinstance(internal.section, Axisymmetric):
        return False
    work = internal.work.processor if isinstance(internal.work, DeviceEvaluation) else internal.work
    return type(internal.material) in LAWS and isinstance(work, KernelEvaluation) and work.mean == 0


def cell_groups(internal: BodyForce, nodes: IntArray, part: int = 0) -> "list[CellGroup]":
    """Groups of the cells of a solid whose nodes have the numbers ``nodes`` (n,), of forces that are :func:`served`."""
    if isinstance(internal, RegionForces):
        return [g for term in internal.terms for g in cell_groups(term.internal, nodes[term.nodes], part)]
    assert isinstance(internal, ElasticForce)
    work = internal.work.processor if isinstance(internal.work, DeviceEvaluation) else internal.work
    assert isinstance(work, KernelEvaluation)
    group = importlib.import_module("softway.kernels.device.device_cells").CellGroup
    own = np.concatenate([nodes, nodes[work.cells.extra], [-1]])
    moduli = (float(work.law.moduli[0]), float(work.law.moduli[1]))
    law = LAWS[type(internal.material)]
    return [group(law, moduli, *_cells(block, own), part) for block in work.cells.blocks]


def _cells(block: Block, own: IntArray) -> tuple[IntArray, Array, Array]:
    """Nodes (e, a), table (q, a, 3) and geometry (e, q, 10) of a block, without empty lanes, in the order of cells."""
    nodes = own[block.rows].transpose(0, 2, 1).reshape(-1, block.rows.shape[1])
    b, q = block.geometry.shape[:2]
    geometry = block.geometry.reshape(b, q, -1, LANES).transpose(0, 3, 1, 2).reshape(b * LANES, q, -1)
    order = np.argsort(block.points.ravel(), kind="stable")
    order = order[nodes[order, 0] >= 0]
    return nodes[order], block.table, geometry[order]


def on_device(internal: BodyForce, device: str) -> BodyForce:
    """The same force, evaluated on a device where that can; material states and stresses stay on the processor."""
    if isinstance(internal, RegionForces):
        return replace(
            internal, terms=tuple(replace(t, internal=on_device(t.internal, device)) for t in internal.terms)
        )
    if not served(internal) or not isinstance(internal, ElasticForce):
        return internal
    work = internal.work.processor if isinstance(internal.work, DeviceEvaluation) else internal.work
    assert isinstance(work, KernelEvaluation)
    n = internal.sampling.table.shape[1]
    d = (len(internal.sampling.pattern.indptr) - 1) // n
    cells = importlib.import_module("softway.kernels.device.device_cells").DeviceCells
    placed = cells.of(cell_groups(internal, np.arange(n)), (n, d), 1, device)
    return replace(internal, work=DeviceEvaluation(processor=work, cells=placed))
