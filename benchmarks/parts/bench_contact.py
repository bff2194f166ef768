"""What contact costs: slabs of a thrown cube while it touches a floor against slabs of its flight afterwards.

``python benchmarks/parts/bench_contact.py [--cells N ...] [--out FILE.json]`` marches each cube through its impact and
for as long again in flight, in which it vibrates as strongly.  ``median`` and ``mean`` are ratios of times per slab,
contact over flight, iterations included; the mean also holds factors and compliance columns.  ``search`` is the share
of the time of the contact slabs spent on who may touch whom.
"""

import argparse
import json
import platform
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

import softway as sw
from softway.contact.contact_set import ContactSet


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """One line of the table; times in milliseconds per slab."""

    cells: int
    unknowns: int
    slabs: int
    flight: float
    contact: float
    iterations_flight: float
    iterations_contact: float
    median: float
    mean: float
    search: float
    factors: int


class Clock:
    """Time spent in a method of a class."""

    def __init__(self, owner: type, name: str) -> None:
        self.spent = 0.0
        plain = getattr(owner, name)

        def timed(*args: object, **given: object) -> object:
            start = perf_counter()
            try:
                return plain(*args, **given)
            finally:
                self.spent += perf_counter() - start

        setattr(owner, name, timed)


def thrown(cells: int, speed: float) -> sw.Scene:
    """A neo-Hookean cube just above a floor, its lower face first."""
    cube = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -speed)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -1e-4), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))


def measured(cells: int, speed: float, search: Clock) -> Cost:
    """March the cube through its impact and for as long again."""
    times: list[float] = []
    touching, iterations, sought = [], [], []
    start, before = perf_counter(), search.spent
    unknowns = factors = 0
    for step in sw.march(thrown(cells, speed), until=10.0):
        now = perf_counter()
        times.append(1e3 * (now - start))
        sought.append(1e3 * (search.spent - before))
        touching.append(any(c.count or c.force_n for c in step.ledger.contacts.values()))
        iterations.append(step.report.iterations)
        unknowns = sum(v.size for v in step.after.velocity.values())
        factors = step.report.factorisations
        met = np.flatnonzero(touching)
        if len(met) and not touching[-1] and len(times) - met[-1] > len(met):
            break
        start, before = perf_counter(), search.spent
    time, count, touch = np.array(times), np.array(iterations), np.array(touching)
    flight = ~touch & (np.arange(len(time)) > np.flatnonzero(touch)[-1])
    return Cost(
        cells=cells,
        unknowns=unknowns,
        slabs=len(time),
        flight=float(np.median(time[flight])),
        contact=float(np.median(time[touch])),
        iterations_flight=float(count[flight].mean()),
        iterations_contact=float(count[touch].mean()),
        median=float(np.median(time[touch]) / np.median(time[flight])),
        mean=float(time[touch].mean() / time[flight].mean()),
        search=float(np.array(sought)[touch].sum() / time[touch].sum()),
        factors=factors,
    )


def main() -> None:
    """Print the table, and write it where asked."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--cells", type=int, nargs="+", default=[6, 12, 20], help="cells along the edge of each cube")
    options.add_argument("--speed", type=float, default=0.1, help="speed over that of waves in a bar")
    options.add_argument("--out", type=Path, help="JSON file for the numbers")
    chosen = options.parse_args()
    print(f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}, NumPy {np.__version__}")
    search, rows = Clock(ContactSet, "meet"), []
    for cells in chosen.cells:
        cost = asdict(measured(cells, chosen.speed, search))
        rows.append(cost)
        if len(rows) == 1:
            print(*(f"{name:>18}" for name in cost))
        print(*(f"{v:18.3g}" if isinstance(v, float) else f"{v:18d}" for v in cost.values()), flush=True)
    if chosen.out:
        chosen.out.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
