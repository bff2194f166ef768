"""What a slab of a pile costs: spheres that fall into a box, of growing floor and equal height.

``python benchmarks/parts/bench_pile.py [--across N ...] [--until S]`` prints a table.  Ten layers of spheres of radius
.05 m with friction .3 fall from a loose lattice, in slabs of 1 ms.
"""

import argparse
from dataclasses import dataclass
from time import process_time

from softway.piles import Pile, box, lattice, march

RADIUS, APART, STEP = 0.05, 0.11, 1e-3
WARM = 10
"""Slabs before the clock starts: kernels are compiled, and no spheres touch yet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What the slabs of a pile cost.

    Parameters
    ----------
    balls
        Number of spheres.
    slab
        Processor time of a slab [ms].
    sweeps
        Sweeps in a slab.
    overlap
        Greatest overlap at the end of a slab, relative to the radius.
    slip
        Mean of the greatest velocity by which friction misses its law in ten slabs [m/s].
    energy
        Greatest error of the energy balance, relative to the energy at the start.
    """

    balls: int
    slab: float
    sweeps: float
    overlap: float
    slip: float
    energy: float


def poured(count: tuple[int, int, int]) -> Pile:
    """Spheres above the floor of a box."""
    balls = lattice(
        count=count, radius=RADIUS, density=2500.0, lowest=(0.5 * APART,) * 3, spacing=APART, jitter=0.4 * (APART - 0.1)
    )
    walls = box(lower=(0.0, 0.0, 0.0), upper=(APART * count[0], APART * count[1], None))
    return Pile(balls=balls, walls=walls, gravity=(0.0, 0.0, -9.81), friction=0.3)


def measured(count: tuple[int, int, int], until: float) -> Cost:
    """Cost of a slab, the mean over a march."""
    pile = poured(count)
    states = march(pile, until=until, step=STEP, every=WARM)
    first, _ = next(states), next(states)
    start = process_time()
    steps = list(states)
    used, slabs = process_time() - start, sum(one.slabs for one in steps)
    return Cost(
        balls=pile.balls.count,
        slab=1e3 * used / slabs,
        sweeps=sum(one.sweeps for one in steps) / slabs,
        overlap=max(one.overlap for one in steps) / RADIUS,
        slip=sum(one.slip_error for one in steps) / len(steps),
        energy=max(abs(one.energy_error) for one in steps) / first.energy_potential,
    )


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--across", type=int, nargs="+", default=[5, 10, 20], help="spheres along one side")
    options.add_argument("--until", type=float, default=1.0)
    chosen = options.parse_args()
    print(f"{'spheres':>8} {'ms/slab':>8} {'sweeps':>7} {'overlap/r':>10} {'slip m/s':>9} {'energy':>8}")
    for across in chosen.across:
        c = measured((across, 10, 10), chosen.until)
        print(f"{c.balls:8d} {c.slab:8.2f} {c.sweeps:7.0f} {c.overlap:10.1e} {c.slip:9.1e} {c.energy:8.1e}", flush=True)


if __name__ == "__main__":
    main()
