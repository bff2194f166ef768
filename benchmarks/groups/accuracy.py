"""Time against accuracy: the contact force of the thrown cube, ours and that of the peers, step by step."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from processes.apart import Absent, alone
from record.figures import Figure, speedup

from groups import peers
from groups.asked import Asked
from groups.force import WIDE, WINDOW, apart

ENOUGH = 5.0
"""Error of the force that counts as the same accuracy [%]."""
E, STEP = 1e4, peers.STEP
FINE, FINER, UNTIL = 27, 18, 0.035
"""Cells along the edge of the refined cube and of one in between, and the end of their runs, after the contact."""
OWN: tuple[tuple[str, dict[str, float]], ...] = (
    ("NGSolve", {}),
    ("GetFEM", {}),
    ("CalculiX", {}),
    ("CalculiX", {"step": STEP / 2}),
    ("NGSolve expert", {}),
    ("NGSolve expert", {"radius": 0.5}),
    ("NGSolve expert", {"step": STEP / 2, "radius": 0.5}),
    ("NGSolve expert", {"step": STEP / 4, "radius": 0.8}),
    ("NGSolve expert", {"step": STEP / 4, "penalty": 500.0 * E, "radius": 0.8}),
    ("GetFEM expert", {"radius": 0.5}),
)
"""Settings of peers with their own inertia."""
MASSLESS: tuple[tuple[str, dict[str, float]], ...] = (
    ("NGSolve expert", {"penalty": 50.0 * E}),
    ("NGSolve expert", {"penalty": 500.0 * E}),
    ("NGSolve expert", {"step": STEP / 2, "penalty": 500.0 * E}),
    ("NGSolve expert", {"step": STEP / 4, "penalty": 500.0 * E, "radius": 0.8}),
    ("GetFEM expert", {"penalty": 500.0 * E}),
    ("GetFEM expert", {"step": STEP / 2, "penalty": 500.0 * E}),
)
"""Settings of experts who are given our mass matrix, in which the nodes of the contact have none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A run: whose, its time of the processor by one thread [s], and its error on the same cells [%]."""

    who: str
    cpu: float
    error: float


def accuracy(asked: Asked) -> Iterator[Figure]:
    """What a contact force of given accuracy costs: each code with its step and its penalty refined.

    Errors are those of mean forces over windows of 5e-4 s (in brackets: 2e-3 s), root mean square over the contact,
    of that of the reference.  There are two references.  *The same cells*: our force with the slab refined; its cells
    and its inertia, which the contact nodes do not have, are those of the run.  Other codes that are given this
    inertia (`massless`) tend to the same force, which is what makes it a reference; with inertia on the contact nodes
    (the peers' own) the force of a penalty tends to none, it chatters.  *Refined cells*: ours on 27 cells.  On
    nine cells no code is near it, since the front of the wave is as wide as a cell; a damped penalty is nearer than
    we are, since five of the nine cells carry the inertia of our contact nodes.

    At 30k the experts have the settings that were enough at 3k, with steps and penalties for the smaller cells; their
    time is counted up from a few steps, and their error is not measured.
    """
    yield from _small(asked)
    if asked.depth != "quick":
        yield from _large(asked)


def _small(asked: Asked) -> Iterator[Figure]:
    cells, finest = asked.cells("3k"), asked.size(8, 2)
    runs = {n: alone("cube", cells=cells, divide=n)["result"] for n in (1, 2, 4, finest)}
    reference = runs[finest]
    fine = alone("cube", cells=asked.size(FINE, 4), divide=asked.size(4, 1), end=UNTIL)["result"]
    trials = []
    for n, run in runs.items():
        words = _words("ours", {"step": STEP / n})
        yield from _shown(f"accuracy/3k/{words}", run, None if n == finest else reference, fine)
        trials += [] if n == finest else [Trial(who=words, cpu=run["cpu"], error=apart(run, reference))]
    theirs = []
    with tempfile.TemporaryDirectory() as folder:
        mass = str(Path(folder) / "mass.npz")
        alone("inertia", cells=cells, keep=mass)
        for given, settings in (("", OWN), (", massless", MASSLESS)):
            for peer, options in settings:
                more = {"mass": mass} if given else {}
                try:
                    run = peers.found(asked, peer, 1, cells=cells, **options, **more)
                except Absent as why:
                    print(f"  {peer}: {why}", flush=True)
                    continue
                words = _words(peer + given, options)
                yield from _shown(f"accuracy/3k/{words}", run, reference, fine)
                theirs.append(Trial(who=words, cpu=run["cpu"], error=apart(run, reference)))
    yield from _agreed(theirs)
    yield _equal("accuracy/3k", trials, theirs)
    yield from _finer(asked, fine)


def _finer(asked: Asked, fine: dict[str, Any]) -> Iterator[Figure]:
    """Twice as many cells along an edge: ours and the damped penalty that is nearest to the refined cells at 3k."""
    cells = asked.size(FINER, 3)
    run = alone("cube", cells=cells, divide=2, end=UNTIL)["result"]
    yield from _shown(f"accuracy/20k/{_words('ours', {'step': STEP / 2})}", run, None, fine)
    options = {"step": STEP / 2, "radius": 0.5}
    try:
        run = peers.found(asked, "NGSolve expert", 1, cells=cells, end=UNTIL, **options)
    except Absent as why:
        print(f"  NGSolve expert: {why}", flush=True)
        return
    yield from _shown(f"accuracy/20k/{_words('NGSolve expert', options)}", run, None, fine)


def _large(asked: Asked) -> Iterator[Figure]:
    """The same at 30k: ours whole, the peers by the settings that were enough at 3k, steps as long for their cells."""
    cells, finest = asked.cells("30k"), 8
    runs = {n: alone("cube", cells=cells, divide=n, end=UNTIL)["result"] for n in (1, 2, 4, finest)}
    trials = []
    for n, run in runs.items():
        words = _words("ours", {"step": STEP / n})
        yield from _shown(f"accuracy/30k/{words}", run, None if n == finest else runs[finest], None)
        trials.append(Trial(who=words, cpu=run["cpu"], error=apart(run, runs[finest])))
    touching = sum(runs[4]["touching"])
    theirs = []
    with tempfile.TemporaryDirectory() as folder:
        mass = str(Path(folder) / "mass.npz")
        alone("inertia", cells=cells, keep=mass)
        for peer in ("NGSolve expert", "GetFEM expert"):
            options = {"step": STEP / 4, "penalty": 500.0 * E * cells / asked.cells("3k"), "mass": mass}
            slabs = len(runs[4]["touching"]) - touching, touching
            for time in peers.sampled(asked, peer, "accuracy/30k", cells, slabs, counts=(1,), **options):
                words = _words(f"{peer}, massless", {k: v for k, v in options.items() if k != "mass"})
                yield Figure(
                    name=f"accuracy/30k/{words}", value=time.cpu or time.seconds, unit=f"{time.unit}, processor"
                )
                theirs.append(Trial(who=words, cpu=time.cpu or time.seconds, error=0.0))
    yield _equal("accuracy/30k", trials[:-1], theirs)


def _shown(
    name: str, run: dict[str, Any], same: dict[str, Any] | None, fine: dict[str, Any] | None
) -> Iterator[Figure]:
    """Time and errors of a run."""
    yield Figure(name=name, value=run["cpu"], unit="s of the processor, 1 thread")
    for reference, words in ((same, "the same cells"), (fine, "refined cells")):
        if reference is not None:
            near, wide = (apart(run, reference, window) for window in (WINDOW, WIDE))
            yield Figure(name=f"{name}, from {words}", value=near, unit=f"% rms of the force ({wide:.3g} %)")


def _agreed(theirs: list[Trial]) -> Iterator[Figure]:
    """How near other codes come to our reference: with its inertia, what makes it one, and with their own."""
    for peer in ("NGSolve", "GetFEM"):
        known = [t.error for t in theirs if t.who.startswith(f"{peer} expert, massless")]
        if known:
            name = f"accuracy/3k/the reference by {peer}, with the same inertia"
            yield Figure(name=name, value=min(known), unit="% rms of the force", target="<= 2.5")
    own = min((t for t in theirs if "massless" not in t.who), key=lambda t: t.error, default=None)
    if own is not None:
        name = "accuracy/3k/the nearest with inertia of its own"
        yield Figure(name=name, value=own.error, unit=f"% rms of the force; {own.who}")


def _equal(name: str, ours: list[Trial], theirs: list[Trial]) -> Figure:
    """The cheapest of ours against the cheapest of theirs, among those that are near enough."""
    name = f"{name}/equal accuracy"
    mine, other = (min((t for t in g if t.error <= ENOUGH), key=lambda t: t.cpu, default=None) for g in (ours, theirs))
    if mine is None:
        return Figure(name=name, value=f"none of ours within {ENOUGH:g} %")
    if other is None:
        return Figure(name=name, value=mine.cpu, unit=f"s, {mine.who}; no peer")
    return speedup(name, mine.cpu, other.cpu, f"s, {mine.who}; {other.who}", ">= 10")


def _words(who: str, options: dict[str, float]) -> str:
    """A setting in words."""
    told = [f"step {options.get('step', STEP):.3g}"]
    told += [f"penalty {options['penalty'] / E:g} E"] if "penalty" in options else []
    told += [f"radius {options['radius']:g}"] if "radius" in options else []
    return ", ".join([who, *told])
