"""Steps of conjugate gradients against NumPy and SciPy: the same bits, for any number of threads."""

import numpy as np
import pytest
import scipy.sparse as sp

from softway.kernels.jit.threads import use
from softway.kernels.linalg.gradient_steps import shared_product, shared_step


@pytest.mark.parametrize("size", [1, 40, 30_000])
def test_products_have_the_bits_of_scipy(size: int) -> None:
    rng = np.random.default_rng(size)
    matrix = sp.csr_array(sp.random_array((size, size), density=min(1.0, 9.0 / size), rng=rng))
    x = rng.standard_normal(size)
    for threads in (1, 2, 3):
        with use(threads):
            assert np.array_equal(shared_product(matrix.indptr, matrix.indices, matrix.data, x), matrix @ x)


@pytest.mark.parametrize("size", [1, 40, 200_000])
def test_steps_have_the_bits_of_numpy(size: int) -> None:
    z, w, p, Ap, x, Ax, r = np.random.default_rng(size).standard_normal((7, size))
    moved, pulled = z + 0.3 * p, w + 0.3 * Ap
    wanted = moved, pulled, x + 0.1 * moved, Ax + 0.1 * pulled, r - 0.1 * pulled
    for threads in (1, 2, 3):
        found = [v.copy() for v in (p, Ap, x, Ax, r)]
        with use(threads):
            shared_step(0.1, 0.3, z, w, *found)
        assert all(np.array_equal(a, b) for a, b in zip(found, wanted, strict=True))
