"""Sparse products, sums in a fixed order, and the steps of conjugate gradients."""

from softway.kernels.device.door import wp

FIRST, LAST, ALPHA, BETA, RHO, STOP, STEPS = (wp.constant(k) for k in range(7))
"""Numbers of conjugate gradients: preconditioned norms (squares) of the first residual, of the one before and of the
present one, factors of the step, whether it ends (1 after this step, 2 without it), and the number of steps."""
NUMBERS = 7
WIDTH, NARROW = 4096, 64
"""Numbers of partial sums of the two levels of a reduction."""


@wp.kernel
def times(start: wp.array(dtype=wp.int32), columns: wp.array(dtype=wp.int32), values: wp.array(dtype=wp.float64),
          x: wp.array(dtype=wp.float64), scale: wp.float64, before: wp.float64,
          out: wp.array(dtype=wp.float64)):  # fmt: skip
    """``out = scale A x + before out`` with the sparse rows of A."""
    row = wp.tid()
    total = wp.float64(0.0)
    for k in range(start[row], start[row + 1]):
        total = total + values[k] * x[columns[k]]
    if before == wp.float64(0.0):
        out[row] = scale * total
    else:
        out[row] = scale * total + before * out[row]


@wp.kernel
def times_nodes(start: wp.array(dtype=wp.int32), columns: wp.array(dtype=wp.int32),
                values: wp.array(dtype=wp.float64), x: wp.array2d(dtype=wp.float64), scale: wp.float64,
                before: wp.float64, out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """``out = scale A x + before out`` for each component of nodal fields (n, d)."""
    node, i = wp.tid()
    total = wp.float64(0.0)
    for k in range(start[node], start[node + 1]):
        total = total + values[k] * x[columns[k], i]
    out[node, i] = scale * total + before * out[node, i]


@wp.kernel
def partial(a: wp.array(dtype=wp.float64), b: wp.array(dtype=wp.float64), c: wp.array(dtype=wp.float64),
            sums: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Partial sums of a.c and b.c: thread t adds the entries t, t + threads, ..."""
    t = wp.tid()
    one, two = wp.float64(0.0), wp.float64(0.0)
    for k in range(t, c.shape[0], sums.shape[1]):
        one = one + a[k] * c[k]
        two = two + b[k] * c[k]
    sums[0, t] = one
    sums[1, t] = two


@wp.kernel
def fold(sums: wp.array2d(dtype=wp.float64), out: wp.array2d(dtype=wp.float64)):
    """Fewer partial sums of each row: thread t adds the columns t, t + threads, ..."""
    row, t = wp.tid()
    total = wp.float64(0.0)
    for k in range(t, sums.shape[1], out.shape[1]):
        total = total + sums[row, k]
    out[row, t] = total


@wp.kernel
def decide(sums: wp.array2d(dtype=wp.float64), tolerance: wp.float64, reference: wp.float64,
           numbers: wp.array(dtype=wp.float64)):  # fmt: skip
    """Factors of the next step from the sums r.z and z.Az (Chronopoulos and Gear), by one thread."""
    rho, curvature = sums[0, 0], sums[1, 0]
    none, one = wp.float64(0.0), wp.float64(1.0)
    begins = numbers[STEPS] == none
    if begins:
        numbers[FIRST] = rho
    beta = wp.float64(0.0)
    bent = sums[1, 0]
    if not begins:
        beta = rho / numbers[LAST]
        bent = curvature - beta * rho / numbers[ALPHA]
    numbers[RHO] = rho
    numbers[STOP] = none
    if not (rho > none and bent > none):
        numbers[STOP] = wp.float64(2.0)
    else:
        numbers[ALPHA] = rho / bent
        numbers[BETA] = beta
        numbers[LAST] = rho
        numbers[STEPS] = numbers[STEPS] + one
        if rho <= tolerance * tolerance * wp.max(numbers[FIRST], reference):
            numbers[STOP] = one


@wp.kernel
def advance(numbers: wp.array(dtype=wp.float64), z: wp.array(dtype=wp.float64), w: wp.array(dtype=wp.float64),
            p: wp.array(dtype=wp.float64), Ap: wp.array(dtype=wp.float64), x: wp.array(dtype=wp.float64),
            Ax: wp.array(dtype=wp.float64), r: wp.array(dtype=wp.float64)):  # fmt: skip
    """Step of conjugate gradients along ``p = z + beta p``, with ``Ap`` by the same recurrence."""
    k = wp.tid()
    if numbers[STOP] == wp.float64(2.0):
        return
    alpha, beta = numbers[ALPHA], numbers[BETA]
    along = z[k] + beta * p[k]
    changed = w[k] + beta * Ap[k]
    p[k] = along
    Ap[k] = changed
    x[k] = x[k] + alpha * along
    Ax[k] = Ax[k] + alpha * changed
    r[k] = r[k] - alpha * changed
