"""What contact of two solids costs: slabs of two blocks pressed together by their impact against slabs without contact.

``python benchmarks/parts/bench_two_bodies.py [--cells N ...] [--slabs N]`` lets two neo-Hookean cubes collide, whose
meshes do not match, and marches on from the slab in which all of their faces touch: with contact, and without any from
the same state.  So both have the same bodies, strains and motion, and both iterate.  It prints the processor times of a
slab, with and without friction, the iterations of both, and what the first slab of the touch takes.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from time import process_time

import numpy as np

import softway as sw
from softway.marching.results.step import Step
from softway.model.model import Model

SPEED, STEP = 4.0, 2.5e-4
"""Speed of the upper block [m/s] and length of a slab at nine cells [s]; a wave of pressure takes 8.6e-3 s to cross."""
GAP = 1e-4
WARM = 2
"""Slabs after the first touch before the clock counts: they factor the operator and compute columns."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """Costs at one size; times are medians of the processor [ms]."""

    unknowns: int
    facets: int
    contact: float
    free: float
    iterations_contact: float
    iterations_free: float
    first: float


def scene(cells: int, friction: float | None, touching: bool = True) -> sw.Scene:
    """A cube of ``cells`` + 1 cells an edge at rest, and a smaller one of ``cells`` that falls and slides on it."""
    law = sw.NeoHookean(E=1e4, nu=0.3)
    size, start = (0.96, 0.9, 0.96), (0.03, 0.041, 1.0 + GAP)
    below = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells + 1,) * 3)
    above = sw.meshes.Box(size=size, cells=(cells,) * 3, origin=start)
    aside = 0.0 if friction is None else 0.5 * SPEED
    bodies = {
        "below": sw.Solid(mesh=below, material=law, density=1.0),
        "above": sw.Solid(
            mesh=above, material=law, density=1.0, velocity=sw.bodies.Uniform(value=(aside, 0.0, -SPEED))
        ),
    }
    coulomb = {} if friction is None else {"friction": sw.Coulomb(mu=friction)}
    contact = sw.Contact(between=("below.top", "above.bottom"), **coulomb)
    return sw.Scene(bodies=bodies, contacts=(contact,) if touching else ())


def parted(cells: int, step: Step) -> Model:
    """The blocks without contact, with the places and velocities after a slab."""
    now = step.after
    places, velocities = (np.concatenate(list(of.values())) for of in (now.displacement, now.velocity))
    return replace(sw.build(scene(cells, None, touching=False)), displacement=places, velocity=velocities)


def timed(steps: Iterator[Step]) -> tuple[Step, float]:
    """The next slab and its processor time [ms]."""
    start = process_time()
    step = next(steps)
    return step, 1e3 * (process_time() - start)


def touches(step: Step) -> bool:
    """Whether a contact has force in the slab."""
    return any(c.force_n for c in step.ledger.contacts.values())


def measured(cells: int, slabs: int, friction: float | None = None) -> Cost:
    """Costs of the slabs after the touch."""
    length = STEP * 9 / cells
    steps = sw.march(scene(cells, friction), until=500 * length, step=length)
    step, first = timed(steps)
    while not touches(step):
        step, first = timed(steps)
    for _ in range(WARM):
        step = next(steps)
    plain = sw.march(parted(cells, step), until=(WARM + slabs) * length, step=length)
    for _ in range(WARM):
        next(plain)
    rows = []
    for _ in range(slabs):
        (step, closed), (free, opened) = timed(steps), timed(plain)
        rows.append((closed, opened, step.report.iterations, free.report.iterations))
    typical = np.median(rows, axis=0)
    mean = np.mean(rows, axis=0)
    return Cost(
        unknowns=sum(v.size for v in step.after.velocity.values()),
        facets=cells**2,
        contact=float(typical[0]),
        free=float(typical[1]),
        iterations_contact=float(mean[2]),
        iterations_free=float(mean[3]),
        first=first,
    )


def main() -> None:
    """Print a line for each size, without friction and with it."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--cells", type=int, nargs="+", default=[7], help="cells along an edge of the upper block")
    options.add_argument("--slabs", type=int, default=12)
    chosen = options.parse_args()
    for cells in chosen.cells:
        for friction in (None, 0.3):
            c = measured(cells, chosen.slabs, friction)
            print(
                f"{c.unknowns} unknowns, {'no friction' if friction is None else f'friction {friction:g}'}: "
                f"{c.contact:.1f} ms in contact ({c.iterations_contact:.1f} iterations), {c.free:.1f} ms free "
                f"({c.iterations_free:.1f}), ratio {c.contact / c.free:.2f}, first {c.first:.0f} ms",
                flush=True,
            )


if __name__ == "__main__":
    main()
