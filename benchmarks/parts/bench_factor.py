"""What a direct solver costs: cubes of growing size, every backend, precision and number of threads.

``python benchmarks/parts/bench_factor.py [--cells N ...] [--backends NAME ...] [--threads N ...] [--out FILE.json]``
prints a table and may write the same numbers.  The matrix is the operator M + h^2/4 K of a neo-Hookean cube at the
first slab length of its flight towards a floor.  A solve reads the factor twice, so ``GB/s`` is twice its size over the
time, and ``share`` that over the bandwidth of reading a long array.  The last lines compare the Schur complement of the
unknowns that may touch the floor with the columns of the compliance that replace it.
"""

import argparse
import json
import platform
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import scipy.sparse as sp
from bench_contact import thrown

from softway.model.build import build
from softway.solve.linear.backends import Mumps, solver_named
from softway.solve.linear.interface import LinearSolver

PATIENCE = 0.5
"""Time for which a short measurement is repeated [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """One line of the table: times in milliseconds, ``column`` that of one of 64 right-hand sides."""

    backend: str
    precision: str
    threads: int
    unknowns: int
    analyse: float
    factor: float
    refactor: float
    solve: float
    column: float
    megabytes: float
    bandwidth: float
    share: float
    error: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Condensation:
    """Schur complement of ``contact`` unknowns against as many columns of the compliance; times in milliseconds."""

    unknowns: int
    contact: int
    schur: float
    factor_and_columns: float
    schur_solve: float
    solve: float
    difference: float


def operator(cells: int) -> tuple[sp.csc_array, np.ndarray]:
    """M + h^2/4 K (f, f) of a thrown cube, and the numbers (k,) of its unknowns that may touch the floor."""
    model = build(thrown(cells, 0.1))
    h = 2.0 / cells
    full = sp.kron(model.mass, sp.eye_array(3)) + 0.25 * h**2 * model.tangent(np.zeros(model.shape))
    free = np.flatnonzero(model.free.ravel())
    matrix = sp.csc_array(sp.csr_array(full)[free][:, free])
    matrix.sort_indices()
    flat = np.zeros(model.shape, bool)
    flat[model.touchable] = True
    return matrix, np.flatnonzero(flat.ravel()[free])


def timed(action: Callable[[], Any]) -> tuple[float, Any]:
    """Time of an action [ms], and its result."""
    start = perf_counter()
    result = action()
    return 1e3 * (perf_counter() - start), result


def least(action: Callable[[], Any]) -> float:
    """Least time of an action [ms]: what else the machine does only adds to it."""
    times: list[float] = []
    start = perf_counter()
    while len(times) < 3 or (len(times) < 300 and perf_counter() - start < PATIENCE):
        times.append(timed(action)[0])
    return min(times)


def streaming(threads: int, size: int = 2**28) -> float:
    """Bandwidth of reading an array of ``size`` bytes [GB/s]."""
    parts = np.array_split(np.ones(size // 8), threads)
    with ThreadPoolExecutor(threads) as pool:
        return size / 1e6 / least(lambda: list(pool.map(np.sum, parts)))


def measured(backend: str, precision: str, threads: int, matrix: sp.csc_array, stream: float) -> Cost:
    """The cost of one backend on one matrix (f, f); ``stream`` is the bandwidth to compare with [GB/s]."""
    solver: LinearSolver = solver_named(backend, precision, threads)
    f = matrix.shape[0]
    b = np.random.default_rng(0).normal(size=(f, 64))
    analyse, analysis = timed(lambda: solver.analyse(matrix))
    first, factor = timed(lambda: analysis.factor(matrix))
    del factor
    again, factor = timed(lambda: analysis.factor(matrix))
    one = b[:, 0].copy()
    solve, size = least(lambda: factor.solve(one)), factor.bytes
    return Cost(
        backend=backend,
        precision=precision,
        threads=threads,
        unknowns=f,
        analyse=analyse,
        factor=first,
        refactor=again,
        solve=solve,
        column=least(lambda: factor.solve(b)) / 64,
        megabytes=size / 1e6,
        bandwidth=2.0 * size / solve / 1e6,
        share=2.0 * size / solve / 1e6 / stream,
        error=float(np.abs(matrix @ factor.solve(one) - one).max()),
    )


def condensed(matrix: sp.csc_array, last: np.ndarray) -> Condensation:
    """The Schur complement of the unknowns ``last`` (k,) by MUMPS against the compliance by the same solver."""
    solver = Mumps(threads=1)
    f, k = matrix.shape[0], len(last)
    unit = np.zeros((f, k))
    unit[last, np.arange(k)] = 1.0
    b = np.random.default_rng(0).normal(size=f)
    schur, held = timed(lambda: solver.schur(matrix, last))
    columns, (factor, compliance) = timed(lambda: ((a := solver.factor(matrix)), a.solve(unit)[last]))
    return Condensation(
        unknowns=f,
        contact=k,
        schur=schur,
        factor_and_columns=columns,
        schur_solve=least(lambda: held.solve(b)),
        solve=least(lambda: factor.solve(b)),
        difference=float(np.abs(held.complement @ compliance - np.eye(k)).max()),
    )


def cases(backends: list[str], threads: list[int]) -> Iterator[tuple[str, str, int]]:
    """Backend, precision and threads of every line for one matrix."""
    for backend in backends:
        for precision in ("double", "single"):
            if (backend, precision) != ("cholmod", "single"):
                yield from ((backend, precision, t) for t in threads if t == 1 or backend in ("pardiso", "mumps"))


def shown(rows: list[dict[str, Any]]) -> None:
    """Print the last of some rows, with heads above the first."""
    if len(rows) == 1:
        print(*(f"{name:>10}" for name in rows[0]))
    print(*(f"{v:10.3g}" if isinstance(v, float) else f"{v:>10}" for v in rows[-1].values()), flush=True)


def main() -> None:
    """Print the tables, and write them where asked."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--cells", type=int, nargs="+", default=[9, 20, 31], help="cells along the edge of each cube")
    options.add_argument("--backends", nargs="+", default=["pardiso", "cholmod", "mumps", "superlu"])
    options.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    options.add_argument("--schur", type=int, nargs="*", default=[9, 20], help="cells of cubes for the complement")
    options.add_argument("--out", type=Path, help="JSON file for the numbers")
    chosen = options.parse_args()
    print(f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}, NumPy {np.__version__}")
    stream = {t: streaming(t) for t in chosen.threads}
    print("reading a long array:", ", ".join(f"{s:.1f} GB/s by {t} thread(s)" for t, s in stream.items()))
    rows: list[dict[str, Any]] = []
    schur: list[dict[str, Any]] = []
    for cells in chosen.cells:
        matrix, _ = operator(cells)
        for backend, precision, threads in cases(chosen.backends, chosen.threads):
            if backend != "superlu" or cells <= 20:
                rows.append(asdict(measured(backend, precision, threads, matrix, stream[threads])))
                shown(rows)
    for cells in chosen.schur:
        schur.append(asdict(condensed(*operator(cells))))
        shown(schur)
    if chosen.out:
        found = {"streaming": stream, "factors": rows, "condensation": schur}
        chosen.out.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
