"""Sums of the matrices of cells in stored rows of blocks, in the order of the cells."""

from softway.kernels.jit.compilation import kernel


@kernel
def row_sums(entries, pairs, places, data):
    """Add blocks of the matrices of cells to the blocks ``data`` (z, d, d).

    Parameters
    ----------
    entries
        (e, a, d, a, d) entries of the matrices of the cells, column before row.
    pairs
        (k,) pairs of nodes, ``(cell a + row) a + column``, in the order of their sum.
    places
        (k,) block to which each pair is added.
    data
        (z, d, d) the sums.
    """
    a, d = entries.shape[1], entries.shape[2]
    for k in range(len(pairs)):
        pair, place = pairs[k], places[k]
        column, first = pair % a, pair // a
        row, cell = first % a, first // a
        for j in range(d):
            for i in range(d):
                data[place, i, j] += entries[cell, column, j, row, i]
