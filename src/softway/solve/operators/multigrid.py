"""Conjugate gradients with smoothed aggregation (pyamg), for bodies whose factor would not fit into memory."""

import importlib
import importlib.util
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator

from softway.bodies.rigid_motions import motion_names, rigid_motions
from softway.errors import InputError
from softway.solve.linear import Analysis
from softway.solve.operators.matrix_free import Gradients, nodal
from softway.solve.operators.operator import Made
from softway.solve.settings import check_products
from softway.solve.stiffness import Stiffness
from softway.typing import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Multigrid:
    """Conjugate gradients preconditioned by smoothed aggregation that knows the rigid motions of every body.

    Needs pyamg (``pip install 'softway[multigrid]'``).

    Parameters
    ----------
    tolerance
        Residual at which a solution ends, relative to the right side; the fixed point makes up for what is left.
    limit
        Products after which it ends in any case.

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

    def make(self, slab: Stiffness, u: Array, analysis: Analysis | None) -> Made:
        """The operator of a slab at the displacement ``u`` (n, d)."""
        if not available():
            raise InputError("solver.operator", "Multigrid without pyamg", "pip install 'softway[multigrid]'")
        pyamg = importlib.import_module("pyamg")
        matrix = sp.csr_array(slab.operator(u))
        motions = _motions(slab, u)
        levels = pyamg.smoothed_aggregation_solver(
            sp.csr_matrix(matrix), B=motions, smooth=LOCAL, presmoother=SMOOTHER, postsmoother=SMOOTHER
        )
        gradients = Gradients(matrix.dot, _Cycle(levels.aspreconditioner()), self.tolerance, self.limit)
        return Made(factor=gradients, local=nodal(slab, u), analysis=None, price=10.0)


LOCAL = ("jacobi", {"weighting": "local"})
"""Smoother of the aggregates, weighted by the sums of rows: an estimate of the spectrum would begin with random numbers
that all of a process shares."""
SMOOTHER = ("block_gauss_seidel", {"sweep": "symmetric"})
"""Smoother on every level: symmetric, so that conjugate gradients stay what they are."""


def available() -> bool:
    """Whether pyamg is there."""
    return importlib.util.find_spec("pyamg") is not None


@dataclass(frozen=True, slots=True, eq=False)
class _Cycle:
    """One multigrid cycle as a solver."""

    operator: LinearOperator
    bytes: int = 0

    def solve(self, b: Array) -> Array:
        """What a cycle makes of b (f,)."""
        return np.asarray(self.operator @ b)


def _motions(slab: Stiffness, u: Array) -> Array:
    """Rigid motions (f, k) of the bodies at the displacement ``u`` (n, d), each body for itself."""
    model = slab.model
    d = model.shape[1]
    names = motion_names(d, axisymmetric=False)
    out = np.zeros((*model.shape, len(names)))
    x = model.points + u
    for part in model.parts:
        here = x[part.rows]
        out[part.rows] = rigid_motions(here, names, here.mean(axis=0))[0].reshape(len(here), d, -1)
    return np.ascontiguousarray(out[model.free])
