"""Choice of the operator, by the number of unknowns, the slab length, the shape of the bodies and the memory."""

import os
from dataclasses import dataclass

import numpy as np

from softway.model.model import Model
from softway.solve.elimination.friction_sweeps import served
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.operators.conjugate_gradients import ConjugateGradients
from softway.solve.operators.factored import Factored
from softway.solve.operators.interface import Operator
from softway.solve.operators.matrix_free import MatrixFree
from softway.solve.operators.multigrid import Multigrid, available

FILL = {1: (3.0, 1.0), 2: (12.0, 1.15), 3: (19.0, 4.0 / 3.0)}
"""Coefficients (c, p) of the number of factor entries ``c f^p`` of f unknowns, by the dimension of the cells: measured
with nested dissection."""
STREAM = 0.02
"""Time per factor entry in a solution, relative to the time per unknown in a product with the stored matrix: measured
in contact slabs of cubes (docs/theory/solver/elimination.md)."""
STORED = 1000.0
"""Bytes of the stored matrix for each unknown."""
DIGITS = 5.0
"""Solutions of two digits that a linear law needs, where one with a factor serves."""
MANY = 60
"""Number of products above which multigrid is faster than diagonal preconditioning."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OperatorChoice:
    """Operator with the reason of its choice."""

    operator: Operator
    reason: str


def choose_operator(system: SlabEquations, memory: float | None = None) -> OperatorChoice:
    """Choose the operator for slabs like this one; ``memory`` [bytes] is by default that of the machine."""
    model = system.model
    unknowns = model.dofs.size
    cells = max(p.mesh.cell_dim for p in model.parts)
    factor, power = FILL[cells]
    numbers = factor * unknowns**power
    products = _products(system)
    room = 0.5 * (_memory() if memory is None else memory)
    facts = f"{unknowns} unknowns, waves cross {courant(system):.2g} cells in a slab, slenderness {slender(system):.2g}"
    gradients = ConjugateGradients() if STORED * unknowns <= room else MatrixFree()
    if 4.0 * numbers > room:
        why = f"{facts}: a factor of {4e-9 * numbers:.2g} GB would take more than half of the memory"
        iterative = Multigrid() if products > MANY and available() else gradients
        return OperatorChoice(operator=iterative, reason=why)
    work = products * unknowns * (DIGITS if model.linear else 1.0)
    if cells == 3 and work < STREAM * numbers and _eliminated(system):
        why = f"{facts}: about {products:.0f} products cost less than a solution with the factor"
        return OperatorChoice(operator=gradients, reason=why)
    return OperatorChoice(operator=Factored(), reason=f"{facts}: a factor of {4e-6 * numbers:.2g} MB serves many slabs")


def _eliminated(system: SlabEquations) -> bool:
    """True if conjugate gradients eliminate the closed rows of the slab."""
    law = system.contact.conditions.slipping
    pressed = np.ones(len(law.sliding))
    return not system.model.contacts.crossing_edges and (law.frictionless or served(law, pressed))


def factor_operations(model: Model) -> float:
    """Estimate of the floating-point operations that factor the operator of a model."""
    factor, power = FILL[max(p.mesh.cell_dim for p in model.parts)]
    unknowns = max(model.dofs.size, 1)
    return (factor * unknowns**power) ** 2 / unknowns


def courant(system: SlabEquations) -> float:
    """Number of cells that the fastest wave crosses in a slab."""
    h = system.path.span
    return max(h * system.model.wave_speed(p) / p.mesh.edge() for p in system.model.parts)


def slender(system: SlabEquations) -> float:
    """Longest over shortest extent of the most slender body."""
    extents = [np.ptp(p.mesh.points, axis=0) for p in system.model.parts]
    return max(float(e.max() / max(e.min(), 1e-12 * e.max())) for e in extents)


def _products(system: SlabEquations) -> float:
    """Number of products that diagonal preconditioning needs for an accuracy of two digits."""
    return 5.0 + 1.8 * courant(system) * float(np.sqrt(slender(system)))


def _memory() -> float:
    """Memory of the machine [bytes]; 8 GiB if it is unknown."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return 8.0 * 2**30
