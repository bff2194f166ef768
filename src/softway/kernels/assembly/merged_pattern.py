"""Common pattern of two sparse matrices on some of their rows and columns."""

import numpy as np

from softway.kernels.jit.compilation import kernel


@kernel
def merged_pattern(first_starts, first_rows, first_values, starts, rows, number):
    """Union of the patterns of two matrices in compressed columns with rising rows.

    Parameters
    ----------
    first_starts, first_rows, first_values
        The first matrix.
    starts, rows
        Pattern of the second one.
    number
        (m,) new number of each row and column, rising; -1 for those that are left out.

    Returns
    -------
    values
        (z,) values of the first matrix on the union.
    picked, place
        Stored entries of the second one that are kept, and their places in the union.
    indices, indptr
        The union in compressed columns.  All but ``indptr`` are the beginnings of longer arrays.
    """
    room = len(first_rows) + len(rows)
    values, indices = np.empty(room), np.empty(room, np.int32)
    picked, place = np.empty(len(rows), np.int32), np.empty(len(rows), np.int32)
    columns = 0
    for column in range(len(number)):
        columns = max(columns, number[column] + 1)
    indptr = np.empty(columns + 1, np.int32)
    indptr[0], end, kept = 0, 0, 0
    for column in range(len(number)):
        if number[column] < 0:
            continue
        i, j = first_starts[column], starts[column]
        while i < first_starts[column + 1] or j < starts[column + 1]:
            one = first_rows[i] if i < first_starts[column + 1] else len(number)
            two = rows[j] if j < starts[column + 1] else len(number)
            row = min(one, two)
            if number[row] >= 0:
                indices[end] = number[row]
                values[end] = first_values[i] if one == row else 0.0
                if two == row:
                    picked[kept], place[kept] = j, end
                    kept += 1
                end += 1
            i += one == row
            j += two == row
        indptr[number[column] + 1] = end
    return values[:end], picked[:kept], place[:kept], indices[:end], indptr
