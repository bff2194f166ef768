"""The fixed point against Newton's method, nearly incompressible blocks, and the first result of a fresh process."""

import tempfile
from collections.abc import Iterator
from statistics import mean
from typing import Any

from processes.apart import alone
from record.figures import Figure, speedup

from groups.asked import Asked

RUN = 100
"""Slabs over which the first one, with its factor, is spread."""


def newton(asked: Asked) -> Iterator[Figure]:
    """The same slabs by the fixed point and by Newton's method, to the same tolerance of 1e-8."""
    sizes = {"3k": (12, 40, 3.0), "30k": (26, 6, 5.0), "100k": (38, 2, 12.0)}
    for size in asked.pick(("3k",), ("3k", "30k"), tuple(sizes)):
        cells, slabs, target = sizes[size]
        yield from _raced(f"newton/ball, {size}", "impact", asked.size(cells, 4), asked.size(slabs, 3), target)
    if asked.depth != "quick":
        cells = asked.size(9, 2)
        yield from _raced("newton/clamped beam, 30k", "bent", cells, asked.size(12, 3), 4.0)
        facts = alone("bent", cells=cells, method="fixed", most=asked.size(62, 6))["result"]
        name = "newton/clamped beam, 30k"
        yield Figure(name=f"{name}, rejected slabs of 62", value=float(facts["rejected"]), target="<= 0")
        yield Figure(name=f"{name}, slab of 62", value=1e3 * mean(facts["seconds"]), unit="ms")


def _raced(name: str, problem: str, cells: int, slabs: int, target: float) -> Iterator[Figure]:
    fixed, other = ([], [])
    for _ in range(2 if slabs > 20 else 1):
        for runs, method in ((fixed, "fixed"), (other, "Newton")):
            runs.append(alone(problem, cells=cells, method=method, most=slabs)["result"])
    fixed, other = (min(runs, key=spread) for runs in (fixed, other))
    yield speedup(f"{name}, processor", 1e3 * spread(fixed, "used"), 1e3 * spread(other, "used"), "ms a slab; Newton")
    words = f"ms a slab of {fixed['unknowns']} unknowns; Newton"
    yield speedup(name, 1e3 * spread(fixed), 1e3 * spread(other), words, f">= {target:g}")
    for method, facts in (("fixed point", fixed), ("Newton", other)):
        yield Figure(name=f"{name}, iterations, {method}", value=facts["iterations"], unit="a slab")


def spread(facts: dict[str, Any], by: str = "seconds") -> float:
    """Time of a slab [s]; what the first one takes more is spread over the slabs of a run."""
    first, *rest = facts[by]
    return mean(rest) + max(0.0, first - mean(rest)) / RUN


def incompressible(asked: Asked) -> Iterator[Figure]:
    """Blocks of nearly incompressible rubber: every slab is found at the length asked for."""
    for nu in (0.49, 0.499):
        facts = alone("block", nu=nu, cells=asked.size(9, 3))["result"]
        name = f"incompressible/nu = {nu:g}"
        shortest = facts["span"] / 0.3
        yield Figure(name=f"{name}, shortest slab", value=shortest, unit="of the length asked for", target=">= 0.99")
        yield Figure(name=f"{name}, slabs repeated with a new factor", value=float(facts["rejected"]), unit="of 20")
        yield Figure(name=f"{name}, iterations", value=facts["iterations"], unit="a slab")
        yield Figure(name=f"{name}, factors", value=float(facts["factors"]))
        yield Figure(name=f"{name}, energy", value=facts["drift"], unit="of the energy at the start", target="<= 1e-6")


def start(asked: Asked) -> Iterator[Figure]:
    """The first slab of the 3k cube from a fresh process, imports included, with kernels to compile and without."""
    with tempfile.TemporaryDirectory() as folder:
        cold = alone("cube", cells=asked.cells("3k"), most=1, variables={"NUMBA_CACHE_DIR": folder})["elapsed"]
        warm = [
            alone("cube", cells=asked.cells("3k"), most=1, variables={"NUMBA_CACHE_DIR": folder})["elapsed"]
            for _ in range(asked.size(3, 1))
        ]
    yield Figure(name="start/no kernel compiled", value=cold, unit="s", target="<= 20")
    yield Figure(name="start/kernels on disk", value=min(warm), unit="s", target="<= 5")
