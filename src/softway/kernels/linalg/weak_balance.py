"""Balance of the heats of nodes between which hardly any heat flows in a stage: Newton's method with conjugate
gradients.

    C (x - x0) + mean b + h (K m + J^T w (J m - a)) = q,    m = (1 - t) x0 + t x

with the ``mean`` of x0 and x, the logarithmic one or the arithmetic one.  The sums of the rows of K are zero.
"""

import numpy as np

from softway.kernels.jit.compilation import inlined, unfused_kernel

CORRECTIONS, ITERATIONS = 30, 60
"""Greatest numbers of corrections, and of iterations of conjugate gradients in one."""
REDUCED = 1e-9
"""Residual of a correction, relative to the unbalanced heats."""
POLISHED, STALLED = 0.1, 0.5
"""Parts of what is allowed, and of what was unbalanced before, at which the iteration ends: what is left is lost."""


@unfused_kernel
def balanced(x, x0, capacity, strain, logarithmic, conduction, links, given, span, theta, free, goal, floor):
    """Correct the temperatures ``x`` (n,) of the ``free`` nodes.

    Parameters
    ----------
    x0, capacity, strain
        (n,) temperatures at the start [K], capacities C and factors b of the mean temperature [J/K].
    logarithmic
        True for the logarithmic mean, False for the arithmetic one.
    conduction
        Pointers of the rows, columns and values of K [W/K].
    links
        The same of J (p, n), then of its transpose, weights w (p,) [W/K] and opposite temperatures a (p,) [K].
    given
        (n,) heats q [J].
    span, theta
        Length h [s] and weight t of the end.
    goal, floor
        Sum of the magnitudes of what is not balanced that is allowed, relative to the heats that take part, and the
        part of it that does not depend on them [J].

    Returns
    -------
    corrections, moved
        Number of corrections, or -1 without a solution; sum of the magnitudes of the heats that take part [J].
    values, mean, flow, middle
        (n,) what is not balanced [J], ``mean`` and m [K], and heat that flows out of the nodes [W].
    """
    n = len(x)
    diagonal, slope = capacity.copy(), 0.5 * strain
    _add_diagonal(conduction, links, theta * span, diagonal)
    r, values, flow, middle, mean = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    closest = np.inf
    for correction in range(CORRECTIONS + 1):
        size, moved = 0.0, 0.0
        for i in range(n):
            middle[i] = (1.0 - theta) * x0[i] + theta * x[i]
        through = _flow(conduction, links, middle, flow)
        for i in range(n):
            mean[i] = _mean(x0[i], x[i], logarithmic)
            taken, gained = strain[i] * mean[i], capacity[i] * (x[i] - x0[i])
            values[i] = gained + taken + span * flow[i] - given[i]
            r[i] = -values[i] if free[i] else 0.0
            size += abs(r[i])
            moved += abs(gained) + abs(taken) + abs(given[i]) + span * abs(flow[i])
        moved += span * through
        if not np.isfinite(size):
            break
        if correction > 0 and (size <= POLISHED * (goal * moved + floor) or size >= STALLED * closest):
            return correction, moved, values, mean, flow, middle
        closest = size
        _corrected(x, r, slope, diagonal, capacity, conduction, links, theta * span, free)
    return -1, moved, values, mean, flow, middle


@inlined
def _mean(one, other, logarithmic):
    middle = 0.5 * (one + other)
    if not logarithmic:
        return middle
    x = 0.5 * (other - one) / middle
    square = x * x
    if abs(x) < 1e-2:
        ratio = 1.0 + square * (1.0 / 3.0 + square * (1.0 / 5.0 + square * (1.0 / 7.0 + square / 9.0)))
    else:
        ratio = np.arctanh(x) / x
    return middle / ratio if one > 0.0 and other > 0.0 else np.nan


@inlined
def _add_diagonal(conduction, links, span, out):
    """Add the diagonal of the matrix of the heat flow, times ``span``, to ``out``."""
    pointers, columns, values = conduction
    back, rows, entries, weights = links[3], links[4], links[5], links[6]
    for i in range(len(out)):
        for k in range(pointers[i], pointers[i + 1]):
            if columns[k] == i:
                out[i] += span * values[k]
        for k in range(back[i], back[i + 1]):
            out[i] += span * weights[rows[k]] * entries[k] * entries[k]


@inlined
def _flow(conduction, links, m, out):
    """Heat [W] that flows out of the nodes at temperatures m, and the sum of the magnitudes through the links."""
    pointers, columns, values = conduction
    ahead, nodes, shares, back, rows, entries, weights, ambient = links
    heat, through = np.empty(len(weights)), 0.0
    for j in range(len(weights)):
        jump = -ambient[j]
        for k in range(ahead[j], ahead[j + 1]):
            jump += shares[k] * m[nodes[k]]
        heat[j] = weights[j] * jump
        through += abs(heat[j])
    for i in range(len(m)):
        total = 0.0
        for k in range(pointers[i], pointers[i + 1]):
            total += values[k] * (m[columns[k]] - m[i])
        for k in range(back[i], back[i + 1]):
            total += entries[k] * heat[rows[k]]
        out[i] = total
    return through


@inlined
def _product(conduction, links, p, capacity, slope, span, out):
    """Product of the matrix ``C + slope + span (K + J^T w J)`` with p."""
    pointers, columns, values = conduction
    ahead, nodes, shares, back, rows, entries, weights, _ = links
    heat = np.empty(len(weights))
    for j in range(len(weights)):
        jump = 0.0
        for k in range(ahead[j], ahead[j + 1]):
            jump += shares[k] * p[nodes[k]]
        heat[j] = weights[j] * jump
    for i in range(len(p)):
        total = 0.0
        for k in range(pointers[i], pointers[i + 1]):
            total += values[k] * p[columns[k]]
        for k in range(back[i], back[i + 1]):
            total += entries[k] * heat[rows[k]]
        out[i] = (capacity[i] + slope[i]) * p[i] + span * total


@inlined
def _corrected(x, r, slope, diagonal, capacity, conduction, links, span, free):
    """Add a correction for the residual r, which is overwritten, to the free entries of x."""
    n = len(x)
    p, q, rho, norm = np.empty(n), np.empty(n), 0.0, 0.0
    for i in range(n):
        p[i] = r[i] / (diagonal[i] + slope[i])
        rho += r[i] * p[i]
        norm += r[i] * r[i]
    goal = REDUCED * REDUCED * norm
    for _ in range(ITERATIONS):
        if norm <= goal:
            break
        _product(conduction, links, p, capacity, slope, span, q)
        curvature = 0.0
        for i in range(n):
            curvature += p[i] * q[i]
        alpha, last, rho, norm = rho / curvature, rho, 0.0, 0.0
        for i in range(n):
            x[i] += alpha * p[i]
            r[i] = r[i] - alpha * q[i] if free[i] else 0.0
            rho += r[i] * r[i] / (diagonal[i] + slope[i])
            norm += r[i] * r[i]
        for i in range(n):
            p[i] = r[i] / (diagonal[i] + slope[i]) + rho / last * p[i]
