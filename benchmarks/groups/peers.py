"""Other codes on the thrown cube: each is a script under ``peers/`` that prints a line of JSON."""

from collections.abc import Iterator
from dataclasses import dataclass
from statistics import median

from apart import HERE, Absent, environment, line
from figures import STORED, Figure

from groups.asked import Asked

IMPLICIT = ("NGSolve", "GetFEM", "CalculiX")
SAMPLE, NEAR = 5, 0.005
"""Steps of a sample, and the distance of the plane in it: two steps of flight, then contact."""
STEP = 5e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Time:
    """What a peer takes for a run [s], and in what words."""

    peer: str
    seconds: float
    unit: str
    threads: int = 0
    version: str = ""
    stored: bool = False


def found(asked: Asked, peer: str, threads: int, **options: float) -> dict:
    """What the script of a peer tells."""
    if peer not in asked.peers:
        raise Absent(f"no interpreter for {peer}")
    words = [word for k, v in options.items() for word in (f"--{k}", f"{v:.12g}")]
    script = str(HERE / "peers" / f"{peer.lower()}_cube.py")
    return line([asked.peers[peer], script, "--threads", str(threads), *words], environment(threads))


def whole(asked: Asked, peer: str, name: str, cells: int) -> Time | None:
    """A run to the end; the fastest number of threads counts."""
    times = []
    for threads in asked.peers_threads:
        try:
            told = found(asked, peer, threads, cells=cells)
        except Absent as why:
            print(f"  {peer}: {why}", flush=True)
            break
        times.append(_time(peer, told, told["wall"], threads, "s"))
    return min(times, key=lambda t: t.seconds) if times else _stored(asked, peer, name)


def sampled(asked: Asked, peer: str, name: str, cells: int, slabs: tuple[int, int], threads: int = 2) -> Time | None:
    """A run of so many ``slabs`` of flight and of contact, from a few steps that begin just before the touch.

    The flight before the touch, rigid, stands for all flight: peers take fewer iterations in it than afterwards.
    """
    try:
        told = found(asked, peer, threads, cells=cells, gap=NEAR, end=SAMPLE * STEP)
    except Absent as why:
        print(f"  {peer}: {why}", flush=True)
        return _stored(asked, peer, name)
    pairs = list(zip(told["seconds"], told["touching"], strict=True))
    kinds = ([s for s, t in pairs if t is kind] for kind in (False, True))
    setup = told["wall"] - sum(told["seconds"])
    seconds = setup + sum(n * median(kind) for n, kind in zip(slabs, kinds, strict=True))
    return _time(peer, told, seconds, threads, f"s, extrapolated from {SAMPLE} steps")


def figures(times: list[Time | None], name: str) -> Iterator[Figure]:
    """The times of the peers."""
    for t in (t for t in times if t is not None):
        yield Figure(name=f"{name}/{t.peer}", value=t.seconds, unit=t.unit)
        if t.version:
            yield Figure(name=f"machine/{t.peer}", value=t.version)


def against(times: list[Time | None], name: str, seconds: float, unit: str, target: str) -> Figure:
    """Our time against that of the fastest peer."""
    known = [t for t in times if t is not None]
    if not known:
        return Figure(name=name, value=seconds, unit=f"{unit}; no peer")
    best = min(known, key=lambda t: t.seconds)
    unit = f"{unit}; {best.peer}" + (f", {STORED}" * best.stored)
    return Figure(
        name=name, value=seconds, unit=unit, baseline=best.seconds, ratio=best.seconds / seconds, target=target
    )


def _time(peer: str, told: dict, seconds: float, threads: int, unit: str) -> Time:
    words = f"{unit}, {threads} thread{'s' * (threads > 1)}"
    return Time(peer=peer, seconds=seconds, unit=words, threads=threads, version=told["version"])


def _stored(asked: Asked, peer: str, name: str) -> Time | None:
    stored = asked.stored.get(f"{name}/{peer}")
    if stored is None or isinstance(stored.value, str):
        return None
    words = stored.unit if STORED in stored.unit else f"{stored.unit}, {STORED}"
    return Time(peer=peer, seconds=stored.value, unit=words, stored=True)
