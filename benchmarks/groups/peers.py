"""Other codes on the thrown cube: each is a script under ``peers/`` that prints a line of JSON."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, median

from processes.apart import Absent, environment, line
from record.figures import STORED, Figure, speedup

from groups.asked import Asked

PEERS = Path(__file__).resolve().parents[1] / "peers"
IMPLICIT = ("NGSolve", "GetFEM", "CalculiX", "NGSolve expert", "GetFEM expert")
"""Peers as their tutorials write them, and as experts set them."""
SAMPLE, NEAR = 5, 0.005
"""Steps of a sample, and the distance of the plane in it: two steps of flight, then contact."""
LONG = 12
"""Steps of the sample of an expert, whose factor serves several of them."""
STEP = 5e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Time:
    """What a peer takes for a run: time by the clock and of the processors [s], and in what words."""

    peer: str
    seconds: float
    cpu: float | None
    unit: str
    stored: bool = False


def found(asked: Asked, peer: str, threads: int, **options: float | str) -> dict:
    """What the script of a peer tells."""
    code, _, form = peer.partition(" ")
    if code not in asked.peers:
        raise Absent(f"no interpreter for {code}")
    words = [w for k, v in options.items() for w in (f"--{k}", v if isinstance(v, str) else f"{v:.12g}")]
    script = str(PEERS / f"{code.lower()}_{form or 'cube'}.py")
    return line([asked.peers[code], script, "--threads", str(threads), *words], environment(threads))


def tried(asked: Asked, peer: str, counts: tuple[int, ...], **options: float | str) -> Iterator[tuple[int, dict]]:
    """What a peer tells with each number of threads; nothing where it is missing."""
    for threads in counts:
        try:
            yield threads, found(asked, peer, threads, **options)
        except Absent as why:
            print(f"  {peer}: {why}", flush=True)
            return


def whole(asked: Asked, peer: str, name: str, cells: int) -> list[Time]:
    """Runs to the end."""
    times = [
        _time(peer, told, told["wall"], threads, "s")
        for threads, told in tried(asked, peer, _counts(asked, peer), cells=cells)
    ]
    return times or _stored(asked, peer, name)


def sampled(
    asked: Asked,
    peer: str,
    name: str,
    cells: int,
    slabs: tuple[int, int],
    counts: tuple[int, ...] = (),
    **options: float | str,
) -> list[Time]:
    """Runs of so many ``slabs`` of flight and of contact, from a few steps that begin just before the touch.

    The flight before the touch, rigid, stands for all flight: peers take fewer iterations in it than afterwards.
    """
    times, count = [], LONG if "expert" in peer else SAMPLE
    end = count * float(options.get("step", STEP))
    typical = mean if "expert" in peer else median
    gap = NEAR * float(options.get("step", STEP)) / STEP
    for threads, told in tried(asked, peer, counts or _counts(asked, peer), cells=cells, gap=gap, end=end, **options):
        pairs = list(zip(told["seconds"], told["touching"], strict=True))
        kinds = ([s for s, t in pairs if t is kind] for kind in (False, True))
        setup = told["wall"] - sum(told["seconds"])
        seconds = setup + sum(n * typical(kind) for n, kind in zip(slabs, kinds, strict=True))
        times.append(_time(peer, told, seconds, threads, f"s, extrapolated from {count} steps"))
    return times or _stored(asked, peer, name)


def _counts(asked: Asked, peer: str) -> tuple[int, ...]:
    """Numbers of threads that are tried: SuperLU, which the expert of GetFEM takes, has one."""
    return (1,) if peer == "GetFEM expert" else asked.peers_threads


def figures(times: list[Time], name: str) -> Iterator[Figure]:
    """The times of the peers: the faster number of threads, and the processors' time by one thread."""
    for peer in dict.fromkeys(t.peer for t in times):
        best = min((t for t in times if t.peer == peer), key=lambda t: t.seconds)
        yield Figure(name=f"{name}/{peer}", value=best.seconds, unit=best.unit)
        for t in times:
            if t.peer == peer and t.cpu is not None:
                yield Figure(name=f"{name}/{peer}, processor", value=t.cpu, unit=t.unit)


def against(times: list[Time], name: str, seconds: float, unit: str, target: str, by: str = "seconds") -> Figure:
    """Our time against that of the fastest peer, ``by`` the clock (``seconds``) or the processor (``cpu``)."""
    known = [t for t in times if getattr(t, by) is not None]
    if not known:
        return Figure(name=name, value=seconds, unit=f"{unit}; no peer")
    best = min(known, key=lambda t: getattr(t, by))
    unit = f"{unit}; {best.peer}" + f", {STORED}" * best.stored
    return speedup(name, seconds, getattr(best, by), unit, target)


def _time(peer: str, told: dict, seconds: float, threads: int, unit: str) -> Time:
    cpu = told["cpu"] / told["wall"] * seconds if threads == 1 else None
    words = f"{unit}, {threads} thread{'s' * (threads > 1)}, version {told['version']}"
    return Time(peer=peer, seconds=seconds, cpu=cpu, unit=words)


def _stored(asked: Asked, peer: str, name: str) -> list[Time]:
    stored, cpu = (asked.stored.get(f"{name}/{peer}{more}") for more in ("", ", processor"))
    if stored is None or isinstance(stored.value, str):
        return []
    words = stored.unit if STORED in stored.unit else f"{stored.unit}, {STORED}"
    used = None if cpu is None or isinstance(cpu.value, str) else cpu.value
    return [Time(peer=peer, seconds=stored.value, cpu=used, unit=words, stored=True)]
