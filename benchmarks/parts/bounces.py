"""Hundreds of bounces of a cube and a ball between two planes: the energy they keep, and what they cost.

``python benchmarks/parts/bounces.py [--bounces N] [--cells N ...] [--out FILE.json]`` prints a table and may write the
same numbers.  ``dE`` is the greatest departure of the energy from that at the start, relative to it; ``TV`` the total
variation of the force of the first bounce over twice its maximum; ``a`` the greatest scalar of the Energy rule.
"""

import argparse
import json
import platform
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "verification" / "tools"))

from bouncing import ball, between_planes, bounced, cube, step_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """One line of the table: what bounced, the slab in crossings of the shortest edge, and what came of it."""

    body: str
    elements: int
    speed: float
    courant: float
    slabs: int
    energy: float
    penetration: float
    variation: float
    scalar: float
    iterations: float
    most: int
    rejected: int
    factors: int
    seconds: float


def lines(cells: list[int], speeds: list[float], courants: list[float], bounces: int) -> Iterator[Line]:
    """Every case, the smaller ones first."""
    for count in cells:
        for body, mesh in (("cube", cube(count)), ("ball", ball(count))):
            for speed in speeds:
                for courant in courants:
                    start = perf_counter()
                    march = bounced(between_planes(mesh, speed), step_of(mesh, courant), bounces)
                    yield Line(
                        body=f"{body}, {count} across",
                        elements=mesh.n_cells,
                        speed=speed,
                        courant=courant,
                        slabs=len(march.time),
                        energy=float(np.abs(march.energy - 1.0).max()),
                        penetration=float(max(0.0, -march.gap.min())),
                        variation=march.variation,
                        scalar=float(march.scalar.max()),
                        iterations=float(march.iterations.mean()),
                        most=int(march.iterations.max()),
                        rejected=march.rejections,
                        factors=march.factorisations,
                        seconds=perf_counter() - start,
                    )


def main() -> None:
    """Print the table, and write it where asked."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--bounces", type=int, default=300)
    options.add_argument("--cells", type=int, nargs="+", default=[4], help="elements across the bodies")
    options.add_argument("--speeds", type=float, nargs="+", default=[0.1, 0.2])
    options.add_argument("--courants", type=float, nargs="+", default=[0.5, 1.0, 2.0])
    options.add_argument("--out", type=Path, help="JSON file for the numbers")
    chosen = options.parse_args()
    print(f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}, {chosen.bounces} bounces")
    print(
        f"{'body':16} {'v':>4} {'hc/e':>4} {'slabs':>6} {'dE':>8} {'depth':>8} {'TV':>5} {'a':>5} {'iterations':>10}",
        end="",
    )
    print(f" {'rejected':>8} {'factors':>7} {'wall s':>7} {'ms/slab':>7}")
    rows = []
    for line in lines(chosen.cells, chosen.speeds, chosen.courants, chosen.bounces):
        rows.append(asdict(line))
        print(
            f"{line.body:16} {line.speed:4.2f} {line.courant:4.1f} {line.slabs:6d} {line.energy:8.1e} "
            f"{line.penetration:8.1e} {line.variation:5.3f} {line.scalar:5.3f} {line.iterations:6.1f} {line.most:3d} "
            f"{line.rejected:8d} {line.factors:7d} {line.seconds:7.1f} {1e3 * line.seconds / line.slabs:7.1f}",
            flush=True,
        )
    if chosen.out:
        chosen.out.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
