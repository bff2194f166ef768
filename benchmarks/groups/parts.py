"""Parts of a slab: kernels, factors and solves, contact, slabs of the three rules."""

from collections.abc import Iterator

from processes.apart import alone
from record.figures import Figure, speedup

from groups.asked import Asked

CELLS = 100_000
POINTS = {"tet4": 1, "hex8": 1, "tet10": 4, "hex27": 40}
"""Parts of so many cells that are measured, by kind."""


def kernels(asked: Asked) -> Iterator[Figure]:
    """The fused internal force against NumPy and against a plain loop in C++."""
    for cell in asked.pick(("tet4", "hex8"), tuple(POINTS)):
        rows = alone(
            "kernels", threads=2, cell=cell, cells=asked.size(CELLS // POINTS[cell], 64), repeats=asked.size(15, 2)
        )["result"]
        rates = {(r["work"], r["by"], r["threads"]): r["rate"] for r in rows}
        for (work, by, threads), rate in rates.items():
            if by == "fused":
                of = f"kernels/{cell}, {work}, {threads} thread{'s' * (threads > 1)}"
                rivals = [b for b in ("NumPy", "C++") if (work, b, threads) in rates]
                for rival in rivals:
                    base = rates[work, rival, threads]
                    yield Figure(
                        name=f"{of}, against {rival}", value=rate, unit="Mcells/s", baseline=base, ratio=rate / base,
                        target=_asked(cell, work, rival, threads),
                    )  # fmt: skip
                if not rivals:
                    yield Figure(name=of, value=rate, unit="Mcells/s")


def _asked(cell: str, work: str, rival: str, threads: int) -> str:
    """What is asked of a rate: nine tenths of C++ for the force of the two commonest cells."""
    plain = cell in ("tet4", "hex8") and work == "force" and rival == "C++" and threads == 2
    return ">= 0.9" if plain else "higher"


def history(asked: Asked) -> Iterator[Figure]:
    """The force and the memory of laws with a history, as times of the neo-Hookean force of the same cells."""
    for cell, dilatation in asked.pick(
        (("hex8", "point"),), (("hex8", "point"), ("hex8", "mean"), ("tet4", "point"), ("quad4", "point"))
    ):
        rows = alone(
            "history",
            threads=2,
            cell=cell,
            cells=asked.size(CELLS, 400),
            dilatation=dilatation,
            repeats=asked.size(15, 2),
        )["result"]
        base = {r["threads"]: r["rate"] for r in rows if r["law"] == "neo-Hookean"}
        for r in rows:
            if r["law"] != "neo-Hookean":
                words = (
                    f"{cell}, {dilatation}, {r['law']}, {r['work']}, {r['threads']} thread{'s' * (r['threads'] > 1)}"
                )
                asked_for = "<= 2" if r["work"] == "force" and dilatation == "point" else "lower"
                yield Figure(
                    name=f"history/{words}", value=r["rate"], unit="Mcells/s; neo-Hookean", baseline=base[r["threads"]],
                    ratio=r["against"], target=asked_for,
                )  # fmt: skip


def factors(asked: Asked) -> Iterator[Figure]:
    """Factors and solves of PARDISO, and the share that a solve has of the bandwidth of reading."""
    cases = [["pardiso", "double", 1], ["pardiso", "single", 1]]
    cases += asked.pick([], [["pardiso", "double", 2], ["pardiso", "single", 2]])
    for size in asked.pick(("3k", "30k"), ("3k", "30k", "100k")):
        more = [["superlu", "double", 1]] if size == "3k" else []
        rows = {(r["backend"], r["precision"], r["threads"]): r
                for r in alone("factor", threads=2, cells=asked.cells(size), cases=cases + more)["result"]}  # fmt: skip
        for (backend, precision, threads), row in rows.items():
            if backend == "superlu":
                continue
            of = f"factor/{size}, {precision}, {threads} thread{'s' * (threads > 1)}"
            yield Figure(name=f"{of}, factor again", value=row["refactor"], unit="ms")
            if precision == "single":
                yield speedup(f"{of}, solve", row["solve"], rows[backend, "double", threads]["solve"], "ms")
            elif more and threads == 1:
                yield speedup(f"{of}, solve", row["solve"], rows["superlu", "double", 1]["solve"], "ms, SuperLU")
            else:
                yield Figure(name=f"{of}, solve", value=row["solve"], unit="ms")
            if size != "3k":
                yield Figure(
                    name=f"{of}, bandwidth of a solve", value=row["bandwidth"], unit="GB/s", baseline=row["stream"],
                    ratio=row["share"], target=">= 0.6",
                )  # fmt: skip


def contact(asked: Asked) -> Iterator[Figure]:
    """Slabs in contact against slabs of the flight afterwards."""
    for cells in asked.pick((6, 12), (6, 12, 20)):
        row = alone("contact", cells=asked.size(cells, 4))["result"]
        of = f"contact/{cells}^3 cells"
        yield Figure(
            name=f"{of}, slab in contact", value=row["contact"], unit="ms, flight", baseline=row["flight"],
            ratio=row["median"], target="lower",
        )  # fmt: skip
        yield Figure(name=f"{of}, search", value=100.0 * row["search"], unit="% of the contact slabs")


def slabs(asked: Asked) -> Iterator[Figure]:
    """Time of a slab of the three rules."""
    for row in alone("slabs", largest=asked.size(asked.pick(8, 12), 4))["result"]:
        of = f"slab/{row['case']}, {row['rule']}"
        yield Figure(name=of, value=row["median"], unit=f"ms, {row['iterations']:.1f} iterations")


def small(asked: Asked) -> Iterator[Figure]:
    """Slabs of small problems that are compiled, with their history, beside the solver for all models."""
    for row in alone("small", slabs=asked.size(asked.pick(4000, 8000), 100), repeats=asked.size(5, 1))["result"]:
        of, aims = f"small/{row['case']}", {"2 bars": "<= 30", "200 bars": "<= 60"}
        yield speedup(f"{of}, march", row["march"], row["python"], "us a slab; solver for all models")
        yield Figure(name=f"{of}, run", value=row["run"], unit="us a slab", target=aims.get(row["case"]))
