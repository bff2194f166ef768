"""Everything that is measured: ``python benchmarks/run.py [--quick | --full | --smoke] [--only GROUP ...] [--check]``.

The figures go to ``benchmarks/results/latest.json`` and ``docs/verification/benchmarks.md``, with the date and the
commit of the measured code.  ``--only`` replaces those of some groups.  ``--check`` writes nothing: it compares with
the stored figures, and fails where a ratio got worse by more than a fifth, twice in a row.  ``--smoke`` computes every
figure with the smallest meshes, two groups at a time, and writes nothing.  ``--page`` measures nothing: it writes the
page again, without the figures of code that has changed since.  Peers are named with their interpreters, ``--peer
NGSolve=python3``, or in the environment, ``SOFTWAY_PEERS="NGSolve=python3 GetFEM=python3"``; without one, the stored
time stands in, marked.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import perf_counter

from groups import accuracy, adapted, blocks, cube, heated, methods, parts, piles, rates
from groups.asked import Asked
from processes.apart import Failed
from record.figures import Figure, read, regressions, unmatched, written
from record.fingerprint import Origin, origin, prints
from record.machine import described
from record.picture import drawn
from record.table import page

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "results" / "latest.json"
PAGE = ROOT / "docs" / "verification" / "benchmarks.md"
PICTURE = ROOT / "docs" / "pictures" / "time_against_error.png"

Group = Callable[[Asked], Iterator[Figure]]
GROUPS: dict[str, Group] = {
    "start": methods.start,
    "drop": cube.drop,
    "accuracy": accuracy.accuracy,
    "threads": cube.threads,
    "explicit": cube.explicit,
    "newton": methods.newton,
    "incompressible": methods.incompressible,
    "kernels": parts.kernels,
    "history": parts.history,
    "factor": parts.factors,
    "contact": parts.contact,
    "unmet": blocks.unmet,
    "rates": rates.rates,
    "dense": rates.dense,
    "pressed": blocks.pressed,
    "blocks": blocks.blocks,
    "slab": parts.slabs,
    "small": parts.small,
    "heated": heated.heated,
    "adapted": adapted.adapted,
    "pile": piles.pile,
    "large": cube.large,
}
LONG = ("large",)
BELONGS = {"scaling": "drop"}
"""Groups of names that another group measures."""
NOTES = {name: " ".join((group.__doc__ or "").split()) for name, group in GROUPS.items()} | {
    "drop": "A neo-Hookean cube of hex8 is thrown at a plane: 100 slabs of 5e-4 s to 0.05 s, wall time with everything "
    "but the imports, equal mesh and equal step. Each peer is there as its tutorials write it, and as an expert sets "
    "it. At 3k all run to the end; at 30k, where the unit says so, a few steps of the peers on both sides of the touch "
    "are counted up to our numbers of slabs in flight and in contact. The fastest peer counts, with the number of "
    "threads that suits it. `processor` is the time of the processor by one thread, which other work on the machine "
    "changes less than the wall time.",
    "scaling": "Slope of logarithms over the cubes of the drop; their factors are spread over the 100 slabs.",
}


def groups(depth: str, only: list[str] | None) -> list[str]:
    """Names of the groups to measure."""
    return only or [name for name in GROUPS if depth in ("full", "smoke") or name not in LONG]


def measured(asked: Asked, name: str) -> tuple[dict[str, Figure], str]:
    """The figures of a group, each printed as it comes; none and the reason where it failed."""
    figures: dict[str, Figure] = {}
    start, why = perf_counter(), ""
    try:
        for f in GROUPS[name](asked):
            figures[f.name] = f
            ratio = "" if f.ratio is None else f"  ratio {f.ratio:.3g}"
            met = {None: "", True: f"  {f.target} met", False: f"  {f.target} MISSED"}[f.passed]
            value = f.value if isinstance(f.value, str) else f"{f.value:.4g}"
            print(f"{f.name:60} {value:>10} {f.unit}{ratio}{met}", flush=True)
            if not f.finite:
                why = f"{f.name} is not finite"
        if not figures:
            why = "no figures"
    except Failed as problem:
        why = str(problem)
    print(f"# {name}: {perf_counter() - start:.0f} s{', FAILED: ' * bool(why)}{why}", flush=True)
    return ({} if why else figures), why


def group_of(name: str) -> str:
    """The group that measures a figure."""
    first = name.split("/")[0]
    return BELONGS.get(first, first)


def changed(origins: Mapping[str, Origin], names: Iterable[str], bench_only: bool = False) -> dict[str, str]:
    """Groups whose figures are not those of the code as it is now, with the reason.

    With ``bench_only`` a change of what is measured does not count: a comparison is there to find its effect.
    """
    reasons = {}
    for name in names:
        known = origins.get(group_of(name))
        code, bench = prints(group_of(name))
        if known is None:
            reasons[name] = "it is not known of which code these figures are"
        elif known.bench != bench:
            reasons[name] = "what measures them has changed since"
        elif known.code != code and not bench_only:
            reasons[name] = "the measured code has changed since"
    return reasons


def checked(asked: Asked, names: list[str], origins: Mapping[str, Origin]) -> int:
    """Compare with the stored figures; groups with a worse ratio are measured once more."""
    refused = changed(origins, names, bench_only=True)
    for name, why in refused.items():
        print(f"{name}: not compared, {why}")
    new, failed = collected(asked, [name for name in names if name not in refused])
    worse = regressions(new, asked.stored)
    if worse:
        print(f"once more: {', '.join(worse)}", flush=True)
        again, more = collected(asked, sorted({group_of(name) for name in worse}))
        failed |= more
        worse = {name: change for name, change in regressions(again, asked.stored).items() if name in worse}
    fresh, left = unmatched(new, asked.stored)
    print(f"no stored ratio: {', '.join(fresh) or 'none'}")
    print(f"stored but not measured here: {len(left)} ratios")
    for name, change in worse.items():
        print(f"worse: {name}: {change}")
    print(f"{len(worse)} ratios got worse by more than a fifth; not compared: {', '.join(refused) or 'none'}")
    return 1 if worse or failed or refused else 0


def collected(asked: Asked, names: Iterable[str], at_once: int = 1) -> tuple[dict[str, Figure], dict[str, str]]:
    """The figures of some groups, so many ``at_once``, and of those that failed the reason."""
    figures, failed, names = {}, {}, list(names)
    with ThreadPoolExecutor(at_once) as pool:
        results = list(pool.map(lambda name: measured(asked, name), names))
    for name, (found, why) in zip(names, results, strict=True):
        figures |= found
        failed |= {name: why} if why else {}
    return figures, failed


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
    depth.add_argument("--smoke", dest="depth", action="store_const", const="smoke")
    options.add_argument("--only", nargs="+", choices=GROUPS, help="groups to measure")
    options.add_argument("--check", action="store_true", help="compare with the stored figures")
    options.add_argument("--page", action="store_true", help="write the page from the stored figures")
    options.add_argument("--peer", nargs="+", default=[], metavar="NAME=PYTHON", help="interpreters of peers")
    options.add_argument("--peer-threads", type=int, nargs="+", default=[1, 2])
    chosen = options.parse_args()
    stored, origins = read(RESULTS)
    if chosen.page:
        PAGE.write_text(rendered(stored, origins), encoding="utf-8")
        return 0
    peers, threads = peers_of(chosen.peer), tuple(chosen.peer_threads)
    asked = Asked(depth=chosen.depth, peers=peers, peers_threads=threads, stored=stored)
    names = groups(chosen.depth, chosen.only)
    if chosen.check:
        return checked(asked, names, origins)
    if chosen.depth == "smoke":
        _, failed = collected(asked, names, at_once=2)
    else:
        failed = measured_and_kept(asked, names, stored if chosen.only else {}, origins if chosen.only else {})
    for name, why in failed.items():
        print(f"failed: {name}: {why}")
    return 1 if failed else 0


def measured_and_kept(
    asked: Asked, names: list[str], figures: dict[str, Figure], origins: dict[str, Origin]
) -> dict[str, str]:
    """Measure, and write the file and the page after every group; of the groups that failed the reason."""
    failed: dict[str, str] = {}
    figures |= {f.name: f for f in described()}
    for name in names:
        start = perf_counter()
        found, why = measured(asked, name)
        if why:
            failed[name] = why
            continue
        figures = {n: f for n, f in figures.items() if group_of(n) != name} | found
        origins = origins | {name: origin(name, perf_counter() - start)}
        written(RESULTS, in_order(figures), origins)
        if name == "adapted":
            drawn(found.values(), PICTURE)
        PAGE.write_text(rendered(*read(RESULTS)), encoding="utf-8")
    return failed


def in_order(figures: Mapping[str, Figure]) -> list[Figure]:
    """The figures in the order of the groups."""
    order = ["machine", *GROUPS, *BELONGS]
    return sorted(figures.values(), key=lambda f: order.index(f.name.split("/")[0]))


def rendered(figures: Mapping[str, Figure], origins: Mapping[str, Origin]) -> str:
    """The page, without the figures of code that has changed since."""
    shown = dict.fromkeys(name.split("/")[0] for name in figures if not name.startswith("machine/"))
    known = {name: origins[group_of(name)] for name in shown if group_of(name) in origins}
    return page(in_order(figures), NOTES, known, changed(origins, shown))


if __name__ == "__main__":
    sys.exit(main())
