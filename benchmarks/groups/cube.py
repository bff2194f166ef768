"""The peers' problem: time, energy, memory, scaling; the same by several threads; explicit; a large one."""

import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from apart import alone
from figures import Figure

from groups import peers
from groups.asked import CELLS, Asked

BUDGET = 16 * 1024.0
"""Memory for the large cube [MB]."""


def drop(asked: Asked) -> Iterator[Figure]:
    """The thrown cube at growing size, against the peers."""
    ours: dict[str, dict[str, Any]] = {}
    best: dict[str, int] = {}
    for size in asked.pick(("3k",), ("3k", "30k", "100k")):
        yield from _sized(asked, size, ours, best)
    if len(ours) > 1:
        yield from _scaling(ours)


def _sized(asked: Asked, size: str, ours: dict[str, dict[str, Any]], best: dict[str, int]) -> Iterator[Figure]:
    """One size; ``ours`` gets the run, and ``best`` the number of threads that is the best for each peer."""
    name, runs = f"drop/{size}", {1: [], 2: []}
    for _ in range(3 if size == "3k" else 1):
        for threads in runs if size != "100k" else (1,):
            runs[threads].append(alone("cube", threads=threads, cells=CELLS[size]))
    first = ours[size] = min(runs[1], key=lambda r: r["result"]["wall"])
    facts = first["result"]
    rivals = []
    if size == "3k":
        rivals = [peers.whole(asked, p, name, CELLS[size]) for p in peers.IMPLICIT]
        best |= {t.peer: t.threads for t in rivals if t is not None and t.threads}
    elif size == "30k":
        touching = sum(facts["touching"])
        slabs = len(facts["touching"]) - touching, touching
        rivals = [peers.sampled(asked, p, name, CELLS[size], slabs, best.get(p, 2)) for p in peers.IMPLICIT]
    yield from peers.figures(rivals, name)
    for threads, found in runs.items():
        if found:
            seconds = median(r["result"]["wall"] for r in found)
            words = f"{name}/ours, {threads} thread{'s' * (threads > 1)}"
            yield peers.against(rivals, words, seconds, "s", ">= 10")
    yield Figure(name=f"{name}/energy", value=facts["drift"], unit="of the energy at the start", target="<= 1e-6")
    yield Figure(name=f"{name}/iterations", value=facts["iterations"], unit="a slab")
    yield Figure(name=f"{name}/rejected slabs", value=float(facts["rejected"]), target="<= 0")
    yield Figure(name=f"{name}/peak memory", value=first["peak"], unit="MB")


def _scaling(ours: dict[str, dict[str, Any]]) -> Iterator[Figure]:
    """Exponents of the cost of a slab, all of the run spread over its slabs, and of the memory."""
    unknowns = np.log([r["result"]["unknowns"] for r in ours.values()])
    slabs = [r["result"]["wall"] / len(r["result"]["seconds"]) for r in ours.values()]
    for what, values, target in (
        ("cost of a slab", slabs, "<= 1.35"),
        ("peak memory", [r["peak"] for r in ours.values()], "lower"),
    ):
        slope = float(np.polyfit(unknowns, np.log(values), 1)[0])
        yield Figure(name=f"scaling/{what}", value=slope, unit="exponent of the unknowns", ratio=slope, target=target)


def threads(asked: Asked) -> Iterator[Figure]:
    """One thread and two on the 3k cube: the same motion, and the same bits whenever the number is the same."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / f"{k}.npy" for k in range(3)]
        runs = [alone("cube", threads=n, cells=9, keep=str(f)) for n, f in zip((1, 2, 2), files, strict=True)]
        one, two, _ = (np.load(f) for f in files)
    bits = [r["result"]["bits"] for r in runs]
    again = alone("cube", threads=1, cells=9)["result"]["bits"]
    difference = float(np.abs(one - two).max() / np.abs(one).max())
    yield Figure(name="threads/difference of 1 and 2", value=difference, unit="of the displacement", target="<= 1e-6")
    same = {"1 thread": bits[0] == again, "2 threads": bits[1] == bits[2]}
    for words, equal in same.items():
        yield Figure(name=f"threads/same bits twice, {words}", value=float(equal), unit="1 is yes", target=">= 1")


def explicit(asked: Asked) -> Iterator[Figure]:
    """Central differences on tetrahedra: the whole run against Akantu, a step against MuJoCo."""
    for size, cells in asked.pick({"3k": 9}, {"3k": 9, "30k tetrahedra": 17}).items():
        facts = min((alone("explicit", cells=cells)["result"] for _ in range(3)), key=lambda r: r["wall"])
        name = f"explicit/{size}"
        rival = [peers.whole(asked, "Akantu", name, cells)]
        yield from peers.figures(rival, name)
        yield peers.against(rival, f"{name}/ours", facts["wall"], "s", ">= 1")
        yield Figure(name=f"{name}/energy", value=facts["drift"], unit="of the energy at the start", target="<= 0.01")
    if asked.depth == "quick":
        return
    name, step = "explicit/30k tetrahedra", 1e3 * median(facts["seconds"][1:])
    try:
        told = peers.found(asked, "MuJoCo", 1, cells=17, step=facts["span"])
    except peers.Absent as why:
        print(f"  MuJoCo: {why}", flush=True)
        yield Figure(name=f"{name}/slab", value=step, unit="ms; no peer")
        return
    base = 1e3 * median(told["seconds"])
    yield Figure(name=f"{name}/slab", value=step, unit="ms; MuJoCo", baseline=base, ratio=step / base, target="<= 1.5")


def large(asked: Asked) -> Iterator[Figure]:
    """300k unknowns through the touch: memory and time of a slab."""
    found = alone("cube", threads=2, cells=CELLS["300k"], most=26)
    facts = found["result"]
    closed = [s for s, t in zip(facts["seconds"], facts["touching"], strict=True) if t]
    yield Figure(name="large/peak memory, 300k", value=found["peak"], unit="MB", target=f"<= {BUDGET:g}")
    yield Figure(name="large/first slab", value=facts["seconds"][0], unit="s")
    yield Figure(name="large/slab in contact", value=median(closed), unit=f"s, {facts['iterations']:.1f} iterations")
    yield Figure(name="large/energy", value=facts["drift"], unit="of the energy at the start", target="<= 1e-6")
