"""A frozen operator of another scale answers like one that was factored so."""

import numpy as np
import scipy.sparse as sp

from softway.solve.constraints.compliance import FrozenOperator, RowBasis
from softway.solve.linear.backends.superlu import SuperLU

SIZE, SCALE = 6, 2.5


def test_a_scaled_operator_answers_like_one_factored_so() -> None:
    rng = np.random.default_rng(3)
    root = rng.normal(size=(SIZE, SIZE + 2))
    matrix = root @ root.T + np.eye(SIZE)
    directions = RowBasis(directions=sp.csc_array(np.eye(SIZE)[:, :3]), component=None)
    one, other = (FrozenOperator(SuperLU().factor(sp.csc_array(m)), directions) for m in (matrix, matrix / SCALE))
    b, push = rng.normal(size=SIZE), np.array([1.0, 0.0, -2.0])
    one.square(np.array([0, 2]))
    scaled = one.scaled(SCALE)
    assert scaled.factor is one.factor and scaled.table is one.table
    np.testing.assert_allclose(scaled.solve(b), other.solve(b), rtol=1e-12)
    np.testing.assert_allclose(scaled.solve_push(push), other.solve_push(push), rtol=1e-12)
    np.testing.assert_allclose(scaled.compliance_times(push), other.compliance_times(push), rtol=1e-12)
    np.testing.assert_allclose(scaled.square(np.arange(3)), other.square(np.arange(3)), rtol=1e-12)
