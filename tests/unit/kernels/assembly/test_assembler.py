"""Sparse tables of the assembly against plain loops."""

import numpy as np

from softway.kernels.assembly.assembler import assembler, gather_table

CELLS = np.array([[0, 1, 4], [1, 3, 4], [4, 3, 2]])


def test_table_gathers_and_its_transpose_scatters() -> None:
    rng = np.random.default_rng(5)
    rows, u = rng.standard_normal((3, 2, 3, 4)), rng.standard_normal((6, 2))
    table = gather_table(CELLS, rows, 6)
    expected = np.einsum("eqak,ead->eqkd", rows, u[CELLS])
    assert np.allclose((table @ u).reshape(expected.shape), expected, atol=1e-14)
    flux = rng.standard_normal(expected.shape)
    nodal = np.zeros((6, 2))
    np.add.at(nodal, CELLS, np.einsum("eqak,eqkd->ead", rows, flux))
    assert np.allclose(table.T @ flux.reshape(-1, 2), nodal, atol=1e-14)


def test_cell_matrices_of_several_blocks_are_summed() -> None:
    rng, nodes, d = np.random.default_rng(6), 6, 2
    others = np.array([[4, 5]])
    blocks, expected = [], np.zeros((nodes, d, nodes, d))
    for cells in (CELLS, others):
        a = cells.shape[1]
        K = rng.standard_normal((len(cells), a, a, d, d))
        K = K + K.transpose(0, 2, 1, 4, 3)
        for cell, matrix in zip(cells, K, strict=True):
            for i, row in enumerate(cell):
                for j, column in enumerate(cell):
                    expected[row, :, column, :] += matrix[i, j]
        blocks.append(K)
    made = assembler([CELLS, others], nodes, d).assemble(blocks)
    assert made.format == "csc"
    assert made.has_sorted_indices
    assert np.allclose(made.toarray(), expected.reshape(nodes * d, nodes * d), atol=1e-14)


def test_nodes_without_a_cell_have_empty_rows_and_columns() -> None:
    pattern = assembler([np.array([[0, 1]])], 4, 1)
    found = pattern.nodal([np.array([[[2.0, -1.0], [-1.0, 2.0]]])], 1).toarray()
    assert found.shape == (4, 4)
    assert found[:2, :2].tolist() == [[2.0, -1.0], [-1.0, 2.0]]
    assert not found[2:].any() and not found[:, 2:].any()
