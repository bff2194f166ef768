"""What mortar contact costs: slabs of two blocks that are thrown at each other against slabs of the blocks alone.

``python benchmarks/parts/bench_mortar.py [--facets N] [--slabs N]`` marches two blocks whose meshes do not match, in
the plane and in space, with contact and without it, slab by slab in turn.  It prints the processor times of a slab,
their ratio, and the time of one evaluation of the contact rows.  The blocks bend as they fly, so that free slabs
iterate too.
"""

import argparse
from time import process_time

import numpy as np

import softway as sw
from softway.contact.mortar.mortar import MortarContact

WARM = 3
"""Slabs before the clock counts: they compile, and factor the operator."""
DEEP = 2
"""Cells through the thickness of a block."""


class Clock:
    """Processor time and number of the evaluations of mortar rows."""

    def __init__(self) -> None:
        self.spent, self.calls = 0.0, 0
        plain = MortarContact.at

        def timed(rows: MortarContact, x: np.ndarray) -> object:
            start = process_time()
            try:
                return plain(rows, x)
            finally:
                self.spent += process_time() - start
                self.calls += 1

        MortarContact.at = timed


def scene(dim: int, facets: int, touching: bool) -> sw.Scene:
    """The blocks, with as many facets along each edge of their faces; the upper one is smaller and falls."""
    law, side = sw.NeoHookean(E=1e4, nu=0.3), (facets,) * (dim - 1)
    shape = sw.meshes.Box if dim == 3 else sw.meshes.Rectangle
    below = shape(size=(*(1.0,) * (dim - 1), 0.3), cells=(*side, DEEP))
    above = shape(size=(*(0.96, 0.9)[: dim - 1], 0.3), cells=(*side, DEEP), origin=(*(0.03, 0.041)[: dim - 1], 0.3))
    rest, fall = (0.0,) * (dim - 1), -2.0
    bent = sw.bodies.Profile(axis="x", at=(0.0, 0.5, 1.0), values=tuple((*rest, fall + v) for v in (0.1, -0.1, 0.1)))
    bodies = {
        "below": sw.Solid(mesh=below, material=law, density=1.0),
        "above": sw.Solid(mesh=above, material=law, density=1.0, velocity=bent),
    }
    contact = sw.Contact(between=("below.top", "above.bottom"), method=sw.contact.DualMortar())
    return sw.Scene(bodies=bodies, contacts=(contact,) if touching else ())


def measured(dim: int, facets: int, slabs: int, clock: Clock) -> tuple[float, float, float]:
    """Median processor times of a slab in contact and of a free one, and the mean of an evaluation of the rows [ms]."""
    step = 3e-4
    until = (WARM + slabs) * step
    marches = {touching: sw.march(scene(dim, facets, touching), until=until, step=step) for touching in (True, False)}
    times: dict[bool, list[float]] = {touching: [] for touching in marches}
    for slab in range(WARM + slabs):
        if slab == WARM:
            clock.spent, clock.calls = 0.0, 0
        for touching, steps in marches.items():
            start = process_time()
            next(steps)
            times[touching].append(process_time() - start)
    contact, free = (1e3 * float(np.median(times[touching][WARM:])) for touching in (True, False))
    return contact, free, 1e3 * clock.spent / max(clock.calls, 1)


def main() -> None:
    """Print a line for the plane and one for space."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--facets", type=int, default=11, help="facets along an edge; five times as many in the plane")
    options.add_argument("--slabs", type=int, default=20)
    chosen, clock = options.parse_args(), Clock()
    for dim, facets in ((2, 5 * chosen.facets), (3, chosen.facets)):
        contact, free, rows = measured(dim, facets, chosen.slabs, clock)
        count = facets ** (dim - 1)
        print(
            f"{dim}D, {count} facets a side: {contact:.1f} ms in contact, {free:.1f} ms free ({contact / free:.2f}), "
            f"{rows:.2f} ms an evaluation of the rows",
            flush=True,
        )


if __name__ == "__main__":
    main()
