"""What the kernels of the internal force cost: cells per second for NumPy, the fused kernels and a plain loop in C++.

``python benchmarks/parts/bench_kernels.py [--out FILE.json] [--cells 100000]`` prints a table and may write the same
numbers.  The law is neo-Hookean.  The loop in C++ (``fused.cpp``) is compiled here by ``g++ -O3 -march=native
-fopenmp``, and left out where there is no such compiler; it computes the force alone, without the care for small
strains.  Rates are the best of many calls, the rivals taking turns, so that they compare even on a busy machine.
"""

import argparse
import ctypes
import json
import platform
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.section import Volume
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce, elastic_force
from softway.kernels.jit.threads import use
from softway.laws.bulk import NeoHookean
from softway.laws.elasticity.elastic_constants import lame
from softway.meshes.generators.shapes import box
from softway.meshes.mesh import Mesh

LAW = NeoHookean(E=1.0, nu=0.3)
CUBES = {"tet4": 6, "tet10": 6, "hex8": 1, "hex27": 1}  # cells in a cube of the lattice


@dataclass(frozen=True, slots=True, kw_only=True)
class Rate:
    """One line of the table: millions of cells per second."""

    cell: str
    cells: int
    work: str
    by: str
    threads: int
    rate: float


def measured(cell: str, cells: int, repeats: int = 15) -> Iterator[Rate]:
    """Rates for a cube of about so many cells of one kind."""
    edge = max(1, round((cells / CUBES[cell]) ** (1.0 / 3.0)))
    mesh = box((1.0, 1.0, 1.0), cells=(edge, edge, edge), cell=cell)
    body = elastic_force(mesh, LAW, Volume())
    u = 0.02 * mesh.edge() * np.random.default_rng(0).standard_normal(mesh.points.shape)
    count = len(mesh.blocks[cell])
    library = compiled_loop()
    for threads in (1, 2):
        rivals = {"fused": body.work, "NumPy": body.plain} if threads == 1 else {"fused": body.work}
        calls = {("force", by): _call(work.energy_and_force, u) for by, work in rivals.items()}
        if library is not None:
            calls["force", "C++"] = loop(library, mesh, body, u, threads)
        calls |= {("tangent", by): _call(work.tangent, u) for by, work in rivals.items()}
        calls["product", "fused"] = _call(body.tangent_product, u, u)
        with use(threads):
            times = best(calls, repeats)
        for (work, by), seconds in times.items():
            yield Rate(cell=cell, cells=count, work=work, by=by, threads=threads, rate=1e-6 * count / seconds)


def _call(function: Callable[..., object], *arguments: Array) -> Callable[[], object]:
    return lambda: function(*arguments)


def best(calls: dict[tuple[str, str], Callable[[], object]], repeats: int) -> dict[tuple[str, str], float]:
    """Least time of each call [s]; slow ones are repeated less often."""
    times = {}
    for name, call in calls.items():
        call()
        start = perf_counter()
        call()
        times[name] = perf_counter() - start
    for k in range(repeats):
        for name, call in calls.items():
            if k < 3 or times[name] * repeats < 10.0:
                start = perf_counter()
                call()
                times[name] = min(times[name], perf_counter() - start)
    return times


def compiled_loop() -> ctypes.CDLL | None:
    """The loop in C++, if it can be compiled."""
    compiler = shutil.which("g++")
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "fused.so"
        source = Path(__file__).with_name("fused.cpp")
        options = ["-O3", "-march=native", "-fopenmp", "-shared", "-fPIC"]
        subprocess.run([compiler, *options, str(source), "-o", str(library)], check=True)
        return ctypes.CDLL(str(library))


def loop(library: ctypes.CDLL, mesh: Mesh, body: ElasticForce, u: Array, threads: int) -> Callable[[], Array]:
    """The internal force by the loop, compared once with that of the body."""
    nodes = np.ascontiguousarray(next(iter(mesh.blocks.values())), np.int32)
    gradients, law = np.ascontiguousarray(body.sampling.rows[0]), lame(LAW.E, LAW.nu)
    (e, q, a, _), n = gradients.shape, len(u)

    def call() -> Array:
        out = np.zeros_like(u)
        pointers = (ctypes.c_void_p(array.ctypes.data) for array in (gradients, body.sampling.volume, nodes))
        big = ctypes.c_int64
        library.neo_hookean(
            a, *pointers, big(e), q, ctypes.c_void_p(u.ctypes.data), big(n), *map(ctypes.c_double, law), threads,
            ctypes.c_void_p(out.ctypes.data),
        )  # fmt: skip
        return out

    force = body.force(u)
    assert np.abs(call() - force).max() < 1e-10 * np.abs(force).max()
    return call


def main() -> None:
    """Print the table, and write it where asked."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, help="JSON file for the numbers")
    options.add_argument("--cells", type=int, default=100_000, help="cells with one point; others have fewer")
    chosen = options.parse_args()
    print(f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}, NumPy {np.__version__}")
    print(f"{'cell':6} {'cells':>7} {'work':8} {'by':6} {'threads':>7} {'Mcells/s':>9}")
    rows = []
    for cell, share in {"tet4": 1, "hex8": 1, "tet10": 2, "hex27": 20}.items():
        for row in measured(cell, chosen.cells // share):
            rows.append(asdict(row))
            print(
                f"{row.cell:6} {row.cells:7d} {row.work:8} {row.by:6} {row.threads:7d} {row.rate:9.3f}",
                flush=True,
            )
    if chosen.out:
        chosen.out.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
