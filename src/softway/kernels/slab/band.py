"""Solution with a factor in a band, four columns at a time: each of them is a loop over contiguous numbers."""

from softway.kernels.jit.compilation import called, uncounted_kernel


@uncounted_kernel
def spread_factor(lower, down, up):
    """Copy a factor ``lower`` (f, w + 1) of :func:`~softway.kernels.multibody.band.factor_band` for solutions.

    L_ij is in ``down[j, i - j]`` and in ``up[i, w + 3 + j - i]``, both (f, w + 4); their other entries are zero.
    """
    w = lower.shape[1] - 1
    down[:], up[:] = 0.0, 0.0
    for i in range(len(lower)):
        for k in range(min(i, w) + 1):
            down[i - k, k] = lower[i, k]
            up[i, w + 3 - k] = lower[i, k]


@called
def solve_spread(down, up, pivot, x):
    """Solve in place with a factor of :func:`spread_factor` and its pivots (f,), x (f,)."""
    n, w = len(pivot), down.shape[1] - 4
    for j in range(0, n, 4):
        for k in range(1, min(4, n - j)):
            for i in range(k):
                x[j + k] -= down[j + i, k - i] * x[j + i]
        count = min(w, n - j - 4)
        if count > 0:
            _subtract(
                x[j + 4 : j + 4 + count], down[j, 4:], down[j + 1, 3:], down[j + 2, 2:], down[j + 3, 1:], x[j : j + 4]
            )
    for i in range(n):
        x[i] = x[i] / pivot[i]
    for j in range(n - 1, -1, -4):
        for k in range(1, min(4, j + 1)):
            for i in range(k):
                x[j - k] -= up[j - i, w + 3 - (k - i)] * x[j - i]
        first = max(0, j - 3 - w)
        if j - 3 > first:
            k = first - j + w + 3
            _subtract(
                x[first : j - 3],
                up[j - 3, k + 3 :],
                up[j - 2, k + 2 :],
                up[j - 1, k + 1 :],
                up[j, k:],
                x[j - 3 : j + 1],
            )


@called
def _subtract(x, one, two, three, four, by):
    """Subtract four columns, times the four numbers ``by``, from x (k,)."""
    a, b, c, d = by[0], by[1], by[2], by[3]
    for i in range(len(x)):
        x[i] -= one[i] * a + two[i] * b + three[i] * c + four[i] * d
