"""The peers' problem: time, energy, memory, scaling; the same by several threads; explicit; a large one."""

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from processes.apart import HERE, Absent, Failed, alone, environment, line
from record.figures import Figure

from groups import peers
from groups.asked import Asked

BUDGET = 16 * 1024.0
"""Memory for the large cube [MB]."""


def drop(asked: Asked) -> Iterator[Figure]:
    """The thrown cube at growing size, against the peers."""
    ours: dict[str, dict[str, Any]] = {}
    for size in asked.pick(("3k",), ("3k", "30k", "100k")):
        cells, name = asked.cells(size), f"drop/{size}"
        repeats, counts = (asked.size(2, 1) if size == "3k" else 1), ((1,) if size == "100k" else (1, 2))
        runs = {n: [alone("cube", threads=n, cells=cells) for _ in range(repeats)] for n in counts}
        ours[size] = min(runs[1], key=lambda r: r["result"]["wall"])
        touching = sum(ours[size]["result"]["touching"])
        slabs = len(ours[size]["result"]["touching"]) - touching, touching
        rivals = []
        if size == "3k":
            for peer in peers.IMPLICIT:
                rivals += peers.whole(asked, peer, name, cells)
                runs[1] += [] if asked.smoke else [alone("cube", cells=cells)]
        elif size == "30k":
            rivals = [t for p in peers.IMPLICIT for t in peers.sampled(asked, p, name, cells, slabs)]
        yield from peers.figures(rivals, name)
        if size != "100k":
            run = alone("cube", cells=cells, tolerance=1e-11)["result"]
            yield peers.against(
                rivals, f"{name}/ours, default tolerance 1e-11", run["cpu"], "s of the processor", ">= 3", "cpu"
            )
        yield from _raced(name, {n: [r["result"] for r in found] for n, found in runs.items()}, rivals)
        yield from _kept(name, ours[size])
    if len(ours) > 1:
        yield from _scaling(ours)


def _raced(name: str, runs: dict[int, list[dict[str, Any]]], rivals: list[peers.Time]) -> Iterator[Figure]:
    """Our times against those of the peers."""
    for threads, found in runs.items():
        words = f"{name}/ours, {threads} thread{'s' * (threads > 1)}"
        yield peers.against(rivals, words, median(r["wall"] for r in found), "s", ">= 3")
    used = median(r["cpu"] for r in runs[1])
    yield peers.against(rivals, f"{name}/ours, processor", used, "s, 1 thread", ">= 3", "cpu")


def _kept(name: str, run: dict[str, Any]) -> Iterator[Figure]:
    """What else is known of a run."""
    facts = run["result"]
    yield Figure(name=f"{name}/energy", value=facts["drift"], unit="of the energy at the start", target="<= 1e-6")
    yield Figure(name=f"{name}/iterations", value=facts["iterations"], unit="a slab")
    yield Figure(name=f"{name}/rejected slabs", value=float(facts["rejected"]), target="<= 0")
    yield Figure(name=f"{name}/peak memory", value=run["peak"], unit="MB")


def _scaling(ours: dict[str, dict[str, Any]]) -> Iterator[Figure]:
    """Exponents of the cost of a slab, all of the run spread over its slabs, and of the memory."""
    unknowns = np.log([r["result"]["unknowns"] for r in ours.values()])
    slabs = [r["result"]["cpu"] / len(r["result"]["seconds"]) for r in ours.values()]
    for what, values, target in (
        ("processor time of a slab", slabs, "<= 1.35"),
        ("peak memory", [r["peak"] for r in ours.values()], "lower"),
    ):
        slope = float(np.polyfit(unknowns, np.log(values), 1)[0])
        yield Figure(name=f"scaling/{what}", value=slope, unit="exponent of the unknowns", ratio=slope, target=target)


def threads(asked: Asked) -> Iterator[Figure]:
    """One thread and two on the 3k cube: the same motion, and the same bits whenever the number is the same."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / f"{k}.npy" for k in range(3)]
        runs = [
            alone("cube", threads=n, cells=asked.cells("3k"), keep=str(f))
            for n, f in zip((1, 2, 2), files, strict=True)
        ]
        one, two, _ = (np.load(f) for f in files)
    bits = [r["result"]["bits"] for r in runs]
    again = alone("cube", threads=1, cells=asked.cells("3k"))["result"]["bits"]
    difference = float(np.abs(one - two).max() / np.abs(one).max())
    yield Figure(name="threads/difference of 1 and 2", value=difference, unit="of the displacement", target="<= 1e-6")
    same = {"1 thread": bits[0] == again, "2 threads": bits[1] == bits[2]}
    for words, equal in same.items():
        yield Figure(name=f"threads/same bits twice, {words}", value=float(equal), unit="1 is yes", target=">= 1")


def explicit(asked: Asked) -> Iterator[Figure]:
    """Central differences on tetrahedra: the whole run against Akantu, a step against MuJoCo."""
    fine = asked.size(17, 4)
    for size, cells in asked.pick({"3k": 9}, {"3k": asked.size(9, 3), "30k tetrahedra": fine}).items():
        found = [alone("explicit", cells=cells)["result"] for _ in range(asked.size(3, 1))]
        facts = min(found, key=lambda r: r["wall"])
        name = f"explicit/{size}"
        rival = peers.whole(asked, "Akantu", name, cells)
        yield from peers.figures(rival, name)
        yield peers.against(rival, f"{name}/ours, 1 thread", facts["wall"], "s", ">= 4")
        yield peers.against(rival, f"{name}/ours, processor", facts["cpu"], "s, 1 thread", ">= 4", "cpu")
        yield Figure(name=f"{name}/energy", value=facts["drift"], unit="of the energy at the start", target="<= 0.01")
    yield from compact(asked)
    if asked.depth == "quick":
        return
    name, step = "explicit/30k tetrahedra", 1e3 * median(facts["seconds"][1:])
    try:
        told = peers.found(asked, "MuJoCo", 1, cells=fine, step=facts["span"])
    except peers.Absent as why:
        print(f"  MuJoCo: {why}", flush=True)
        yield Figure(name=f"{name}/slab", value=step, unit="ms; no peer")
        return
    base = 1e3 * median(told["seconds"])
    yield Figure(name=f"{name}/slab", value=step, unit="ms; MuJoCo", baseline=base, ratio=step / base, target="<= 1.5")


def compact(asked: Asked) -> Iterator[Figure]:
    """A ball of quadratic tetrahedra all of whose surface may touch a floor, against bare central differences."""
    for cells in asked.pick((8,), (asked.size(8, 2), asked.size(18, 4))):
        facts, name = alone("compact", cells=cells)["result"], f"explicit/ball, {cells} cells"
        plain, slab = facts["bare"], float(np.mean(facts["used"][1:]))
        for what, ours, base in (("slab", 1e3 * slab, 1e3 * plain["slab"]), ("run", facts["cpu"], plain["run"])):
            unit = f"{'ms' if what == 'slab' else 's'}, processor; the bare scheme"
            yield Figure(name=f"{name}/{what}", value=ours, unit=unit, baseline=base, ratio=ours / base, target="<= 4")
        yield Figure(name=f"{name}/energy", value=facts["drift"], unit="of the energy at the start", target="<= 1e-3")


def large(asked: Asked) -> Iterator[Figure]:
    """300k unknowns through the touch, and a million: memory and time of a slab."""
    found = alone("cube", threads=2, cells=asked.cells("300k"), most=26)
    facts = found["result"]
    closed = [s for s, t in zip(facts["seconds"], facts["touching"], strict=True) if t]
    yield Figure(name="large/peak memory, 300k", value=found["peak"], unit="MB", target=f"<= {BUDGET:g}")
    yield Figure(name="large/first slab", value=facts["seconds"][0], unit="s")
    yield Figure(name="large/slab in contact", value=median(closed), unit=f"s, {facts['iterations']:.1f} iterations")
    yield Figure(name="large/energy", value=facts["drift"], unit="of the energy at the start", target="<= 1e-6")
    yield from _million(asked)


def _million(asked: Asked) -> Iterator[Figure]:
    """A million unknowns into the touch."""
    told = [sys.executable, str(HERE / "large" / "million.py"), "--cells", str(asked.size(69, 4)), "--slabs", "6"]
    try:
        found = line(told, environment(2))
    except Absent as why:
        raise Failed(f"million: {why}") from why
    yield Figure(name="large/peak memory, 1M tet4", value=found["peak"], unit="MB", target=f"<= {20 * 1024}")
    yield Figure(name="large/built, 1M tet4", value=found["built"], unit="s of the processor")
    yield Figure(name="large/slab in contact, 1M tet4", value=found["slab"], unit="s of the processor")
    yield Figure(
        name="large/energy, 1M tet4", value=found["drift"], unit="of the energy at the start", target="<= 1e-9"
    )
