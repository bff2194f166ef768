"""What a slab costs: time per slab and iterations, with and without contact, for bars and solids of growing size.

``python benchmarks/parts/bench_slab.py [--out FILE.json]`` prints a table and may write the same numbers.  Times are
the median over the slabs of one march; the first slab, which builds the tables and the factor, is given apart.  They
compare two states of the code on one machine.
"""

import argparse
import json
import platform
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

import softway as sw


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """One line of the table; times in milliseconds."""

    case: str
    rule: str
    unknowns: int
    slabs: int
    first: float
    median: float
    iterations: float
    factorisations: int


def bar(cells: int, timing: sw.contact.Energy | sw.contact.Impulse | sw.contact.Paper) -> tuple[str, sw.Scene, float]:
    """The bar of the first example, thrown at the wall, and a time in its contact."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + 2.0 / cells, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), timing=timing)
    return f"bar, {cells} bar2", sw.Scene(bodies={"bar": solid, "wall": wall}, contacts=(contact,)), 40.0 / cells


def block(cells: int, timing: sw.contact.Energy | sw.contact.Impulse | sw.contact.Paper) -> tuple[str, sw.Scene, float]:
    """A neo-Hookean cube thrown at a floor, and a time in its contact."""
    solid = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells), cell="hex8"),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -0.05)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.001), normal=(0.0, 0.0, 1.0)))
    contact = sw.Contact(between=("cube.bottom", "floor"), timing=timing)
    return f"cube, {cells}^3 hex8", sw.Scene(bodies={"cube": solid, "floor": floor}, contacts=(contact,)), 20.0 / cells


def measured(case: str, scene: sw.Scene, until: float) -> Cost:
    """March the scene and time its slabs."""
    times, iterations = [], []
    start = perf_counter()
    step = None
    for step in sw.march(scene, until=until):
        end = perf_counter()
        times.append(1e3 * (end - start))
        iterations.append(step.report.iterations)
        start = perf_counter()
    assert step is not None
    unknowns = sum(v.size for v in step.after.velocity.values())
    return Cost(
        case=case,
        rule=type(scene.contacts[0].timing).__name__,
        unknowns=unknowns,
        slabs=len(times),
        first=times[0],
        median=float(np.median(times[1:])),
        iterations=float(np.mean(iterations)),
        factorisations=step.report.factorisations,
    )


def costs(largest: int) -> Iterator[Cost]:
    """Every case, the smaller ones first."""
    for timing in (sw.contact.Energy(), sw.contact.Impulse(), sw.contact.Paper()):
        for cells in (20, 200):
            yield measured(*bar(cells, timing))
        for cells in (4, 8, 12):
            if cells <= largest:
                yield measured(*block(cells, timing))


def main() -> None:
    """Print the table, and write it where asked."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, help="JSON file for the numbers")
    options.add_argument("--largest", type=int, default=8, help="cells along the edge of the largest cube (4, 8 or 12)")
    chosen = options.parse_args()
    print(f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}, NumPy {np.__version__}")
    heads = ("unknowns", 8), ("slabs", 6), ("first ms", 9), ("slab ms", 8), ("iterations", 10), ("factors", 7)
    print(f"{'case':18} {'rule':8}", *(f"{head:>{width}}" for head, width in heads))
    rows = []
    for cost in costs(chosen.largest):
        rows.append(asdict(cost))
        print(
            f"{cost.case:18} {cost.rule:8} {cost.unknowns:8d} {cost.slabs:6d} {cost.first:9.1f} {cost.median:8.2f} "
            f"{cost.iterations:10.1f} {cost.factorisations:7d}",
            flush=True,
        )
    if chosen.out:
        chosen.out.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
