"""Conjugate gradients over ranks with the stored rows of the own nodes, and with multigrid of PETSc."""

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.dof_map import NodalDofs
from softway.cluster.cells.rank_force import stored_rows
from softway.cluster.own_rows import OwnRows
from softway.marching.rules.slab_rule import Method
from softway.model.model import Model
from softway.ranks.petsc import REMEDY, Cycle, available, multigrid
from softway.ranks.space import RankSpace
from softway.solve.checks import check_products
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.conjugate_gradients import Gradients
from softway.solve.linear.interface import Analysis
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.operators import ConjugateGradients, Multigrid, Operator
from softway.solve.operators.conjugate_gradients import PRICE
from softway.solve.operators.interface import BuiltOperator
from softway.solve.operators.matrix_free import nodal

LOG = logging.getLogger(__name__)
MISSING = (
    "petsc4py is not installed: conjugate gradients with the blocks of the nodes in place of multigrid, slower for "
    f"long slabs; {REMEDY}"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnGradients:
    """:class:`~softway.solve.ConjugateGradients` on a model of a rank, with the same parameters.

    Examples
    --------
    >>> OwnGradients().limit
    500
    """

    tolerance: float = 1e-2
    limit: int = 500

    def __post_init__(self) -> None:
        check_products(self.tolerance, self.limit)

    def require(self, model: Model) -> None:
        """Accept every model."""

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        rows = stored_rows(slab.model.parts, u, slab.stiffness_factor, slab.viscous_factor)
        local = nodal(slab, u)
        times = _product(slab.model, rows)
        gradients = Gradients(times, local, self.tolerance, self.limit, slab.model.space.of_unknowns)
        return BuiltOperator(factor=gradients, local=local, analysis=None, price=PRICE)


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnMultigrid:
    """:class:`~softway.solve.Multigrid` on a model of a rank, by PETSc, with the same parameters.

    Examples
    --------
    >>> OwnMultigrid().limit
    200
    """

    tolerance: float = 1e-3
    limit: int = 200

    def __post_init__(self) -> None:
        check_products(self.tolerance, self.limit)

    def require(self, model: Model) -> None:
        """Accept every model."""

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        model = slab.model
        rows = stored_rows(model.parts, u, slab.stiffness_factor, slab.viscous_factor)
        outer = _Multigrid(model, _cycle(model, u, rows))
        times = _product(model, rows)
        gradients = Gradients(times, outer, self.tolerance, self.limit, model.space.of_unknowns)
        return BuiltOperator(factor=gradients, local=nodal(slab, u), analysis=None, price=10.0)


@dataclass(frozen=True, slots=True, eq=False)
class _Multigrid:
    """One cycle of multigrid as a solver; copies get the values of their owners."""

    model: Model
    cycle: Cycle
    bytes: int = 0
    indefinite: bool = False

    def solve(self, b: Array) -> Array:
        """Result (f,) of one cycle for the right side b (f,)."""
        space, dofs = _space(self.model), self.model.dofs
        field = dofs.nodes(b)
        field[space.shares.own] = self.cycle.applied(field[space.shares.own])
        return dofs.unknowns(space.filled(field))


def _product(model: Model, rows: Sequence[sp.bsr_array]) -> Callable[[Array], Array]:
    """Product of the matrix of a slab with unknowns (f,), from the mass and the rows of each solid."""
    dofs = model.dofs

    def times(x: Array) -> Array:
        field = dofs.nodes(x)
        force = model.mass @ field
        for part, own in zip(model.parts, rows, strict=True):
            force[part.nodes] += np.asarray(own @ field[part.nodes].ravel()).reshape(-1, field.shape[1])
        return dofs.forces(model.space.filled(force))

    return times


def _cycle(model: Model, u: Array, rows: Sequence[sp.bsr_array]) -> Cycle:
    """Multigrid of all components of own nodes; those that supports hold have no neighbours."""
    space, dofs = _space(model), model.dofs
    assert isinstance(dofs, NodalDofs) and space.exchange is not None
    ranks, own, d = space.ranks, space.shares.own, u.shape[1]
    counts = [int(count[0]) for count in ranks.gathered(np.array([len(own)]))]
    numbers = np.zeros(len(u))
    numbers[own] = sum(counts[: ranks.rank]) + np.arange(len(own))
    whole = sp.csr_array(sp.csr_array(sp.block_diag(rows)) + sp.kron(cast(OwnRows, model.mass).rows, sp.eye_array(d)))
    free = sp.diags_array(dofs.free.ravel().astype(float))
    held = sp.diags_array(np.where(dofs.free.ravel(), 0.0, whole.diagonal()))
    matrix = sp.csr_array(free @ whole @ free + held)
    mine = (own[:, None] * d + np.arange(d)).ravel()
    everywhere = np.rint(ranks.exchanged(space.exchange, numbers.astype(float))).astype(np.int64)
    return multigrid(ranks, sp.csr_array(matrix[mine]), everywhere, (model.points + u)[own])


def _space(model: Model) -> RankSpace:
    assert isinstance(model.space, RankSpace)
    return model.space


def owned(operator: Operator, tell: bool = True) -> Operator:
    """Operator of a rank in place of a declared one; conjugate gradients for multigrid without PETSc, which one rank
    has to ``tell``.
    """
    match operator:
        case ConjugateGradients(tolerance=tolerance, limit=limit):
            return OwnGradients(tolerance=tolerance, limit=limit)
        case Multigrid(tolerance=tolerance, limit=limit) if available():
            return OwnMultigrid(tolerance=tolerance, limit=limit)
        case Multigrid():
            LOG.log(logging.WARNING if tell else logging.DEBUG, "%s", MISSING)
            return OwnGradients()
    return operator


def declared(operator: Operator) -> Operator:
    """Operator that a rank has replaced by its own."""
    match operator:
        case OwnGradients(tolerance=tolerance, limit=limit):
            return ConjugateGradients(tolerance=tolerance, limit=limit)
        case OwnMultigrid(tolerance=tolerance, limit=limit):
            return Multigrid(tolerance=tolerance, limit=limit)
    return operator


def method_of_ranks(method: Method, tell: bool = True) -> FixedPoint:
    """Method over ranks: conjugate gradients, and no other method takes over."""
    assert isinstance(method, FixedPoint)
    given = ConjugateGradients() if method.operator == "auto" else method.operator
    return replace(method, operator=cast(Any, owned(given, tell)), handover=False)


def method_of_whole(method: Method) -> Method:
    """Method with which every rank prepares the whole model: its multigrid would be that of one process."""
    if isinstance(method, FixedPoint) and isinstance(method.operator, Multigrid):
        return replace(method, operator=ConjugateGradients())
    return method
