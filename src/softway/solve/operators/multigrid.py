"""Conjugate gradients with smoothed aggregation (pyamg), for bodies with a factor that would not fit into memory."""

import importlib
import importlib.util
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator

from softway.arrays import Array
from softway.bodies.assembled.rigid_body_modes import motion_names, rigid_motions
from softway.errors import InputError
from softway.model.model import Model
from softway.solve.checks import check_products
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.conjugate_gradients import Gradients
from softway.solve.linear.interface import Analysis
from softway.solve.operators.interface import BuiltOperator
from softway.solve.operators.matrix_free import nodal


@dataclass(frozen=True, slots=True, kw_only=True)
class Multigrid:
    """Conjugate gradients preconditioned by smoothed aggregation with the rigid motions of every body.

    Needs pyamg (``pip install 'softway[multigrid]'``).

    Parameters
    ----------
    tolerance
        Residual at which a solution ends, relative to the right side; the fixed point corrects the rest.
    limit
        Greatest number of products of a solution.

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation for second and fourth order elliptic
    problems, Computing 56, 179-196; Bell, Olson, Schroder (2022), PyAMG: Algebraic Multigrid Solvers in Python,
    J. Open Source Softw. 7, 4142.

    Examples
    --------
    >>> Multigrid().limit
    200
    """

    tolerance: float = 1e-3
    limit: int = 200

    def __post_init__(self) -> None:
        check_products(self.tolerance, self.limit)

    def require(self, model: Model) -> None:
        """Refuse every model without pyamg."""
        if not available():
            remedy = "pip install 'softway[multigrid]', or the operator MatrixFree"
            raise InputError("", "Multigrid without pyamg", remedy)

    def make(self, slab: SlabMatrix, u: Array, analysis: Analysis | None) -> BuiltOperator:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        pyamg = importlib.import_module("pyamg")
        matrix = sp.csr_array(slab.operator(u))
        motions = _motions(slab, u)
        levels = pyamg.smoothed_aggregation_solver(
            sp.csr_matrix(matrix), B=motions, smooth=LOCAL, presmoother=SMOOTHER, postsmoother=SMOOTHER
        )
        gradients = Gradients(
            matrix.dot, _Cycle(levels.aspreconditioner()), self.tolerance, self.limit, slab.model.space.of_unknowns
        )
        return BuiltOperator(factor=gradients, local=nodal(slab, u), analysis=None, price=10.0)


LOCAL = ("jacobi", {"weighting": "local"})
"""Smoother of the aggregates, weighted by the row sums: an estimate of the spectrum would use the random numbers of the
process."""
SMOOTHER = ("block_gauss_seidel", {"sweep": "symmetric"})
"""Smoother on every level: symmetric, as conjugate gradients require."""


def available() -> bool:
    """True if pyamg is installed."""
    return importlib.util.find_spec("pyamg") is not None


@dataclass(frozen=True, slots=True, eq=False)
class _Cycle:
    """One multigrid cycle as a solver."""

    operator: LinearOperator
    bytes: int = 0
    indefinite: bool = False

    def solve(self, b: Array) -> Array:
        """Result (f,) of one cycle for the right side b (f,)."""
        return np.asarray(self.operator @ b)


def _motions(slab: SlabMatrix, u: Array) -> Array:
    """Rigid motions (f, k) of each body at the displacement ``u`` (n, d)."""
    model = slab.model
    d = model.shape[1]
    names = motion_names(d, axisymmetric=False)
    out = np.zeros((*model.shape, len(names)))
    x = model.points + u
    for part in model.parts:
        here = x[part.nodes]
        out[part.nodes] = rigid_motions(here, names, here.mean(axis=0))[0].reshape(len(here), d, -1)
    return np.stack([model.dofs.unknowns(out[..., k]) for k in range(len(names))], axis=1)
