"""Everything that is measured: ``python benchmarks/run.py [--quick | --full] [--only GROUP ...] [--check]``.

The figures go to ``benchmarks/results/latest.json`` and ``docs/benchmarks.md``.  ``--only`` replaces those of some
groups.  ``--check`` writes nothing: it compares with the stored figures, and fails where a ratio got worse by more than
a fifth, twice in a row.  Peers are named with their interpreters, ``--peer NGSolve=python3``, or in the environment,
``SOFTWAY_PEERS="NGSolve=python3 GetFEM=python3"``; without one, the stored time stands in, marked.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from time import perf_counter

from apart import Absent
from figures import Figure, read, regressions, unmatched, written
from groups import cube, methods, parts
from groups.asked import Asked
from machine import described
from table import page

ROOT = Path(__file__).parents[1]
RESULTS, PAGE = ROOT / "benchmarks" / "results" / "latest.json", ROOT / "docs" / "benchmarks.md"

Group = Callable[[Asked], Iterator[Figure]]
GROUPS: dict[str, Group] = {
    "start": methods.start,
    "drop": cube.drop,
    "threads": cube.threads,
    "explicit": cube.explicit,
    "newton": methods.newton,
    "incompressible": methods.incompressible,
    "kernels": parts.kernels,
    "history": parts.history,
    "factor": parts.factors,
    "contact": parts.contact,
    "slab": parts.slabs,
    "large": cube.large,
}
LONG = ("large",)
BELONGS = {"scaling": "drop"}
"""Groups of names that another group measures."""
NOTES = {name: " ".join((group.__doc__ or "").split()) for name, group in GROUPS.items()} | {
    "drop": "A neo-Hookean cube of hex8 is thrown at a plane: 100 slabs of 5e-4 s to 0.05 s, tolerance 1e-8, wall time "
    "with everything but the imports. At 3k the peers run to the end; at 30k, where the unit says so, a few of their "
    "steps on both sides of the touch are counted up to our numbers of slabs in flight and in contact. The fastest "
    "peer counts, with the number of threads that suits it. `processor` is the time of the processor by one thread, "
    "which other work on the machine changes less than the wall time.",
    "scaling": "Slope of logarithms over the cubes of the drop; their factors are spread over the 100 slabs.",
}


def groups(depth: str, only: list[str] | None) -> list[str]:
    """Names of the groups to measure."""
    return only or [name for name in GROUPS if depth == "full" or name not in LONG]


def measured(asked: Asked, names: list[str]) -> dict[str, Figure]:
    """The figures of some groups, each printed as it comes."""
    figures: dict[str, Figure] = {}
    for name in names:
        start = perf_counter()
        try:
            for f in GROUPS[name](asked):
                figures[f.name] = f
                ratio = "" if f.ratio is None else f"  ratio {f.ratio:.3g}"
                met = {None: "", True: f"  {f.target} met", False: f"  {f.target} MISSED"}[f.passed]
                value = f.value if isinstance(f.value, str) else f"{f.value:.4g}"
                print(f"{f.name:60} {value:>10} {f.unit}{ratio}{met}", flush=True)
        except Absent as why:
            print(f"{name}: failed, {why}", flush=True)
        print(f"# {name}: {perf_counter() - start:.0f} s", flush=True)
    return figures


def group_of(name: str) -> str:
    """The group that measures a figure."""
    first = name.split("/")[0]
    return BELONGS.get(first, first)


def checked(asked: Asked, names: list[str]) -> int:
    """Compare with the stored figures; groups with a worse ratio are measured once more."""
    new = measured(asked, names)
    worse = regressions(new, asked.stored)
    if worse:
        print(f"once more: {', '.join(worse)}", flush=True)
        again = measured(asked, sorted({group_of(name) for name in worse}))
        worse = {name: change for name, change in regressions(again, asked.stored).items() if name in worse}
    fresh, left = unmatched(new, asked.stored)
    print(f"no stored ratio: {', '.join(fresh) or 'none'}")
    print(f"stored but not measured here: {len(left)} ratios")
    for name, change in worse.items():
        print(f"worse: {name}: {change}")
    print(f"{len(worse)} ratios got worse by more than a fifth")
    return 1 if worse else 0


def peers_of(words: list[str]) -> dict[str, str]:
    """Interpreters by peer, from words like ``NGSolve=python3``."""
    pairs = [word.split("=", 1) for word in [*os.environ.get("SOFTWAY_PEERS", "").split(), *words]]
    return {peer: str(Path(interpreter).expanduser()) for peer, interpreter in pairs}


def main() -> int:
    """Measure, and write or compare."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    depth = options.add_mutually_exclusive_group()
    depth.add_argument("--quick", dest="depth", action="store_const", const="quick", default="default")
    depth.add_argument("--full", dest="depth", action="store_const", const="full")
    options.add_argument("--only", nargs="+", choices=GROUPS, help="groups to measure")
    options.add_argument("--check", action="store_true", help="compare with the stored figures")
    options.add_argument("--peer", nargs="+", default=[], metavar="NAME=PYTHON", help="interpreters of peers")
    options.add_argument("--peer-threads", type=int, nargs="+", default=[1, 2])
    options.add_argument("--out", type=Path, default=RESULTS)
    options.add_argument("--page", type=Path, default=PAGE)
    chosen = options.parse_args()
    stored = read(RESULTS)
    peers, threads = peers_of(chosen.peer), tuple(chosen.peer_threads)
    asked = Asked(depth=chosen.depth, peers=peers, peers_threads=threads, stored=stored)
    names = groups(chosen.depth, chosen.only)
    if chosen.check:
        return checked(asked, names)
    figures = (stored if chosen.only else {}) | {f.name: f for f in described()}
    for name in names:
        figures |= measured(asked, [name])
        kept(figures, chosen.out, chosen.page)
    return 0


def kept(figures: dict[str, Figure], file: Path, text: Path) -> None:
    """Write the file and the page, in the order of the groups."""
    order = ["machine", *GROUPS, *BELONGS]
    rows = sorted(figures.values(), key=lambda f: order.index(f.name.split("/")[0]))
    written(file, rows)
    text.write_text(page(rows, NOTES), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
