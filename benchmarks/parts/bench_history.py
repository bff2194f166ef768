"""What laws with a history cost: cells per second of their internal force and memory, beside the neo-Hookean law.

``python benchmarks/parts/bench_history.py [--out FILE.json] [--cells 100000]`` prints a table and may write the same
numbers.  The bodies are given noise of 1 % of an edge, then another slab of as much; with a low yield stress all their
points flow, with a high one none.  Rates are the best of many calls, the laws taking turns, by the time of the
processor for one thread and of the clock for more, so that they compare even on a busy machine.
"""

import argparse
import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter, thread_time

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.quadrature import Dilating
from softway.bodies.elements.section import PlaneStrain, Section, Volume
from softway.bodies.internal_force.elastic.elastic_force import elastic_force
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce, inelastic_force
from softway.kernels.jit.threads import use
from softway.laws.bulk import J2, Hypoelastic, NeoHookean
from softway.laws.law import RateLaw
from softway.laws.plasticity.hardening import LinearHardening, Voce
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

METAL = {"E": 1.0, "nu": 0.3}
LINEAR, VOCE = LinearHardening(modulus=0.01), Voce(saturation=0.002, exponent=16.0, modulus=0.01)
LAWS: dict[str, RateLaw] = {
    "hypoelastic": Hypoelastic(**METAL),
    "J2 elastic": J2(**METAL, yield_stress=100.0, hardening=LINEAR),
    "J2 flowing": J2(**METAL, yield_stress=0.001, hardening=LINEAR),
    "J2 of Voce flowing": J2(**METAL, yield_stress=0.001, hardening=VOCE),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Rate:
    """One line of the table: millions of cells per second, and the time against that of the neo-Hookean force."""

    cell: str
    cells: int
    dilatation: str
    law: str
    work: str
    threads: int
    rate: float
    against: float


def measured(cell: str, cells: int, dilatation: Dilating = "point", repeats: int = 15) -> Iterator[Rate]:
    """Rates for about so many cells of one kind."""
    mesh, section = shape(cell, cells)
    u = 0.01 * mesh.edge() * np.random.default_rng(0).standard_normal(mesh.points.shape)
    elastic = elastic_force(mesh, NeoHookean(**METAL), section)
    calls = {("neo-Hookean", "force"): (lambda: elastic.energy_and_force(2.0 * u))}
    for name, law in LAWS.items():
        body = inelastic_force(mesh, law, section, dilatation)
        calls |= _calls(name, body.during(body.committed(u), 1.0), 2.0 * u)
    for threads in (1, 2):
        with use(threads):
            times = best(calls, repeats, thread_time if threads == 1 else perf_counter)
        base, count = times["neo-Hookean", "force"], len(mesh.blocks[cell])
        for (law, work), seconds in times.items():
            yield Rate(
                cell=cell, cells=count, dilatation=dilatation, law=law, work=work, threads=threads,
                rate=1e-6 * count / seconds, against=seconds / base,
            )  # fmt: skip


def shape(cell: str, cells: int) -> tuple[Mesh, Section]:
    """A square or a cube of about so many cells."""
    if cell == "quad4":
        edge = round(cells**0.5)
        return rectangle((1.0, 1.0), cells=(edge, edge)), PlaneStrain()
    edge = round((cells / {"tet4": 6, "hex8": 1}[cell]) ** (1.0 / 3.0))
    return box((1.0, 1.0, 1.0), cells=(edge, edge, edge), cell=cell), Volume()


def _calls(name: str, body: InelasticForce, u: Array) -> dict[tuple[str, str], Callable[[], object]]:
    return {(name, "force"): lambda: body.energy_and_force(u), (name, "memory"): lambda: body.committed(u)}


def best(
    calls: dict[tuple[str, str], Callable[[], object]], repeats: int, clock: Callable[[], float]
) -> dict[tuple[str, str], float]:
    """Least time of each call [s]."""
    times = dict.fromkeys(calls, np.inf)
    for _ in range(repeats):
        for name, call in calls.items():
            start = clock()
            call()
            times[name] = min(times[name], clock() - start)
    return times


def main() -> None:
    """Print the table, and write it where asked."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, help="JSON file for the numbers")
    options.add_argument("--cells", type=int, default=100_000)
    chosen = options.parse_args()
    rows = []
    print(f"{'cell':6} {'dilatation':10} {'law':20} {'work':7} {'threads':>7} {'Mcells/s':>9} {'neo-Hookean':>12}")
    cases: list[tuple[str, Dilating]] = [("hex8", "point"), ("hex8", "mean"), ("tet4", "point"), ("quad4", "point")]
    for cell, dilatation in cases:
        for r in measured(cell, chosen.cells, dilatation):
            rows.append(asdict(r))
            words = f"{r.cell:6} {r.dilatation:10} {r.law:20} {r.work:7}"
            print(f"{words} {r.threads:7d} {r.rate:9.3f} {r.against:12.2f}", flush=True)
    if chosen.out:
        chosen.out.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
