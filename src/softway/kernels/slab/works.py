"""Works of the forces of a slab (time step) in its energy balance, in one loop over the components of each solid."""

from softway.kernels.jit.compilation import called, uncounted_kernel

MOVING, SIZE, SLOPE, STILL, STILL_SLOPE, LOADED, ENDS, ENDS_SLOPE = range(8)
"""Columns of the works of a solid: of the mean force along components with inertia, the sum of its magnitudes, and of
the change of the force; of the mean load along components without inertia, and of its change; the magnitudes of the
works of the load; of the mean of the end forces along components without inertia, and of their change along all."""
WORKS = 8
TOGETHER = 256
"""Components that are summed together: rounding errors grow with the number of such sums."""


@called
def part_works(first, d, heavy, loads, u0, u1, forces, mean, out):
    """Set the works ``out`` (parts, WORKS) of solids with the ``first`` nodes (parts + 1,), from flat fields (N,).

    ``heavy`` (N,) are components with inertia, ``loads`` and ``forces`` pairs of fields at the start and at the end.
    """
    (l0, l1), (f0, f1) = loads, forces
    for part in range(len(first) - 1):
        out[part, :] = 0.0
        for begin in range(first[part] * d, first[part + 1] * d, TOGETHER):
            moving = size = slope = still = still_slope = loaded = ends = ends_slope = 0.0
            for c in range(begin, min(begin + TOGETHER, first[part + 1] * d)):
                moved, change = u1[c] - u0[c], f1[c] - f0[c]
                loaded += abs(l1[c] * moved)
                ends_slope += change * moved
                if heavy[c]:
                    work = mean[c] * moved
                    moving += work
                    size += abs(work)
                    slope += change * moved
                else:
                    still += 0.5 * (l0[c] + l1[c]) * moved
                    still_slope += (l1[c] - l0[c]) * moved
                    ends += 0.5 * (f0[c] + f1[c]) * moved
            out[part, MOVING] += moving
            out[part, SIZE] += size
            out[part, SLOPE] += slope
            out[part, STILL] += still
            out[part, STILL_SLOPE] += still_slope
            out[part, LOADED] += loaded
            out[part, ENDS] += ends
            out[part, ENDS_SLOPE] += ends_slope


@uncounted_kernel
def works(first, d, heavy, loads, u0, u1, forces, mean, out):
    """:func:`part_works` for calls from Python."""
    part_works(first, d, heavy, loads, u0, u1, forces, mean, out)
