"""Division of a body into parts: equal shares, and few shared nodes."""

import numpy as np
import pytest

from softway.kernels.assembly.cell_order import halved, not_first, own_rows, parts
from softway.meshes.generators.shapes import box


@pytest.mark.parametrize("count", [1, 3, 8, 27, 64])
def test_parts_have_equal_shares(count: int) -> None:
    points = np.random.default_rng(0).random((2000, 3))
    sizes = np.bincount(halved(points, count), minlength=count)
    assert len(sizes) == count
    assert sizes.max() - sizes.min() <= np.ceil(np.log2(count)) + 1


@pytest.mark.parametrize("cells", [16, 24])
def test_few_nodes_are_shared(cells: int) -> None:
    """Cubes of p parts have cuts of (p^(1/3) - 1) planes along each axis; slabs would have p - 1 of them."""
    mesh = box((1.0, 1.0, 1.0), cells=(cells,) * 3, cell="hex8")
    nodes = mesh.blocks["hex8"]
    it = parts(nodes, mesh.points[nodes].mean(axis=1), 8)
    count = len(it.starts) - 1
    assert count == cells**3 * 8 // 4096
    extra = own_rows(it.part, nodes, not_first(it.part, nodes), mesh.n_nodes)[1]
    planes = 3.0 * (np.cbrt(count) - 1.0)
    assert len(extra) <= 1.5 * planes * (cells + 1) ** 2
    assert len(extra) < (count - 1) * (cells + 1) ** 2


def test_the_division_serves_many_threads() -> None:
    """A body of a million points has two parts for each of 32 threads."""
    nodes = np.arange(131_072)[:, None]
    it = parts(nodes, np.random.default_rng(1).random((len(nodes), 3)), 8)
    assert len(it.starts) - 1 == 64
