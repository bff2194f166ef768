"""Sums of dense rows that are zero but for a range of their places."""

from softway.kernels.jit.compilation import uncounted_kernel


@uncounted_kernel
def find_extents(rows, extent):
    """Write the places (k, 2) of the first entry of each row (k, m) that is not zero, and after the last one."""
    m = rows.shape[1]
    for i in range(len(rows)):
        first, end = 0, m
        while first < m and rows[i, first] == 0.0:
            first += 1
        while end > first and rows[i, end - 1] == 0.0:
            end -= 1
        extent[i, 0], extent[i, 1] = first, end


@uncounted_kernel
def add_rows(stored, which, amounts, extent, out):
    """Add the rows ``which`` (k,) times the amounts (k,), within their extents (k, 2), to ``out`` (m,)."""
    i, count = 0, len(which)
    while i < count:
        first, end, alike = extent[i, 0], min(extent[i, 1], len(out)), 1
        while (
            alike < 4 and i + alike < count and extent[i + alike, 0] == first and extent[i + alike, 1] == extent[i, 1]
        ):
            alike += 1
        if alike == 4:
            a, b, c, d = which[i], which[i + 1], which[i + 2], which[i + 3]
            p, q, r, s = amounts[i], amounts[i + 1], amounts[i + 2], amounts[i + 3]
            for j in range(first, end):
                one = p * stored[a, j] + q * stored[b, j]
                out[j] += one + (r * stored[c, j] + s * stored[d, j])
            i += 4
        else:
            for j in range(first, end):
                out[j] += amounts[i] * stored[which[i], j]
            i += 1
