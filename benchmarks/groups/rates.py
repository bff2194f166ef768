"""Slabs a second in contact, against what bounds them and against other codes; dense contact against free slabs."""

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
from processes.apart import HERE, Absent, Failed, environment, line
from record.figures import Figure

from groups import peers
from groups.asked import Asked

SIZES = {"3k": (9, 150.0), "10k": (14, 40.0), "30k": (20, 12.0), "100k": (31, 2.5), "400k": (50, 0.3)}
"""Cells along the edge of the cube and slabs a second that are aimed at, by the number of unknowns."""
SLABS = {"3k": 50, "10k": 40, "30k": 30, "100k": 8, "400k": 4}
LAWS = ("linear", "neo-Hookean")
LONG = {"3k": 1100, "10k": 1100}
"""Slabs of long marches, which are compiled."""
TWO = ("30k", "100k")
"""Sizes that are measured by the clock with two threads, too."""
PLATES = {"3k": (16, 1), "30k": (56, 1), "100k": (104, 1)}
"""Cells along the sides of a plate, and plates."""
PILES = {"3k": (8, 4), "30k": (17, 10)}
PENALTIES = {"NGSolve expert": 5e6, "Akantu": 2e6, "MuJoCo": 5e5}
"""Penalty of each peer per unit of area [N/m^3]: stiffer ones take the explicit peers shorter steps.

With 5e5, fifty times Young's modulus of the cube over its edge, the plane yields 4 % as much as the cube, and the error
of NGSolve is .046 in place of .012.
"""


def told(*words: object, threads: int = 1) -> dict[str, Any]:
    """What ``contact_rates.py`` prints."""
    command = [sys.executable, str(HERE / "large" / "contact_rates.py"), *map(str, words)]
    try:
        return line(command, environment(threads))
    except Absent as why:
        raise Failed(f"rates {words}: {why}") from why


def rates(asked: Asked) -> Iterator[Figure]:
    """Slabs a second of processor time (one thread) of a cube whose weight holds it on a floor.

    All slabs are 5e-4 s long, in contact, with certificate and a tolerance of 1e-8.  *Bandwidth* compares with the
    slabs for which the memory has time: the bytes that matrices, factors, vectors and tables have to move, counted,
    over the bandwidth of reading measured in the same process.  *Elsewhere* is the part of the time that is not spent
    in solutions and internal forces, most of it serial Python and NumPy: by Amdahl's law no number of threads makes a
    slab more than its inverse faster.  *Long marches* have slabs that are compiled; of their traffic the factors and
    the answers to closed rows are counted.  *Peers* march the neo-Hookean cube for 0.03 s.  All errors are those of the
    momentum, root mean square over the march relative to its greatest value, from ours with slabs of a quarter on cells
    half as wide; a stiff penalty in NGSolve comes to within .012 of that reference.
    """
    sizes = ["3k"] if asked.smoke else asked.pick(["3k", "30k"], ["3k", "10k", "30k", "100k"], list(SIZES))
    for size in sizes:
        yield from _cube(asked, size)
    yield from _peers(asked, "rates/3k peers", asked.size(SIZES["3k"][0], 3))


def _cube(asked: Asked, size: str) -> Iterator[Figure]:
    """The figures of one size."""
    cells, aim = asked.size(SIZES[size][0], 3), SIZES[size][1]
    for law in LAWS:
        found = told("held", "--cells", cells, "--law", law, "--slabs", asked.size(SLABS[size], 3))
        yield from _rate(f"rates/{size}, {law}", found, aim)
    held = ("held", "--cells", cells, "--law", LAWS[1])
    if size in LONG:
        found = told(*held, "--slabs", asked.size(LONG[size], 3))
        yield from _rate(f"rates/{size}, {LAWS[1]}, long march", found, aim)
    if size in TWO:
        found = told(*held, "--slabs", asked.size(SLABS[size], 3), threads=2)
        unit = f"slabs a second by the clock, {found['operator']}"
        yield Figure(name=f"rates/{size}, {LAWS[1]}, two threads", value=1.0 / found["clock"], unit=unit,
                     target=f">= {aim:g}")  # fmt: skip


def _rate(name: str, found: dict[str, Any], aim: float) -> Iterator[Figure]:
    """The figures of one cube."""
    each = 1.0 / found["used"]
    words = f"slabs a second; {found['operator']}, {found['iterations']:.0f} iterations, {found['active']} active nodes"
    yield Figure(name=name, value=each, unit=words, target=f">= {aim:g}")
    if found["bytes"]:
        yield from _limits(name, found)
    if found["compiled"]:
        yield Figure(name=f"{name}, compiled", value=found["compiled"], unit="of the slabs", target="higher")
    yield Figure(name=f"{name}, energy", value=found["drift"], unit="of the strain energy", target="<= 1e-6")
    yield Figure(name=f"{name}, certificate", value=found["gap"], unit="m, least gap of a slab", target=">= -1e-12")
    yield Figure(name=f"{name}, peak memory", value=found["peak"], unit="MB")


def _limits(name: str, found: dict[str, Any]) -> Iterator[Figure]:
    """What the time of a slab is compared with."""
    each, bound = 1.0 / found["used"], found["stream"] * 1e9 / found["bytes"]
    unit = f"slabs a second; {found['bytes'] / 1e6:.0f} MB a slab at {found['stream']:.0f} GB/s"
    yield Figure(name=f"{name}, bandwidth", value=each, unit=unit, baseline=bound, ratio=each / bound, target="higher")
    if found["compiled"]:
        return
    rest = 1.0 - (found["solving"] + found["forcing"]) / found["used"]
    yield Figure(name=f"{name}, elsewhere", value=rest, unit="of the processor time", target="lower")


def _peers(asked: Asked, name: str, cells: int) -> Iterator[Figure]:
    """Time of a march and its error, ours and those of the peers that are installed."""
    until = asked.size(60, 8) * peers.STEP
    ours = told("march", "--cells", cells, "--until", until)
    exact = told("march", "--cells", 2 * cells, "--until", until, "--divide", 4)
    for words, found in (("ours", ours), ("ours, half cells, slabs of a quarter", exact)):
        unit = f"s of the processor, {len(found['time'])} slabs"
        yield Figure(name=f"{name}/{words}", value=found["cpu"], unit=unit)
    yield Figure(name=f"{name}/ours, error", value=_error(ours, exact), unit="of the momentum")
    for peer, penalty in PENALTIES.items():
        options: dict[str, float | str] = {"gap": 1e-6, "load": 100.0, "speed": 0.0, "end": until, "cells": cells}
        options["penalty"] = penalty
        for _, found in peers.tried(asked, peer, (1,), **options):
            unit = f"s of the processor, {len(found['seconds'])} steps, version {found['version']}; ours"
            yield Figure(name=f"{name}/{peer}", value=found["cpu"], unit=unit, baseline=ours["cpu"],
                         ratio=found["cpu"] / ours["cpu"], target="higher")  # fmt: skip
            yield Figure(name=f"{name}/{peer}, error", value=_error(found, exact), unit="of the momentum")
            if found.get("depth") is not None:
                yield Figure(name=f"{name}/{peer}, penetration", value=found["depth"], unit="m")


def _error(found: dict[str, Any], exact: dict[str, Any]) -> float:
    """Root mean square difference of momenta along z, relative to the greatest one."""
    at = [t for t in found["time"] if t <= exact["time"][-1] * (1.0 + 1e-9)]
    known = np.interp(at, [0.0, *exact["time"]], [0.0, *exact["momentum"]])
    missed = np.asarray(found["momentum"][: len(at)]) - known
    return float(np.sqrt(np.mean(missed**2)) / np.abs(exact["momentum"]).max())


def dense(asked: Asked) -> Iterator[Figure]:
    """Dense contact, more than one active row for three nodes of the surface, against slabs without contact.

    A plate, two cells thick, that its weight holds on a floor; and piles of such plates, whose meshes do not match.
    The same bodies march from the same state with contact and, all contacts taken away, without any.
    """
    sizes = ["3k"] if asked.smoke else asked.pick(["3k"], ["3k", "30k"], ["3k", "30k", "100k"])
    for words, cases in (("plate", PLATES), ("pile", PILES)):
        for size in (s for s in sizes if s in cases):
            cells, layers = cases[size]
            slabs = asked.size(10 if size == "3k" else 4, 2)
            found = told("plates", "--cells", asked.size(cells, 3), "--layers", layers, "--slabs", slabs)
            share = found["active"] / found["surface"]
            unit = (
                f"ms of the processor, {found['unknowns']} unknowns, {share:.2f} active rows for a node of the surface"
            )
            name = f"dense/{words}, {size}"
            yield Figure(name=name, value=1e3 * found["contact"], unit=f"{unit}, {found['operator']}; without contact",
                         baseline=1e3 * found["free"], ratio=found["contact"] / found["free"],
                         target="<= 1.5")  # fmt: skip
            unit = f"a slab; without contact {found['iterations_free']:.0f}"
            yield Figure(name=f"{name}, iterations", value=found["iterations"], unit=unit)
            yield Figure(name=f"{name}, energy", value=found["drift"], unit="of the strain energy", target="<= 1e-6")
