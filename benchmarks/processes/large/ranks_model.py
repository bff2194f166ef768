"""Time and memory of an inner step and of a slab over ranks, from counted traffic.

``python benchmarks/processes/large/ranks_model.py --cells 64 --ranks 64`` partitions a cube of hexahedra as a run does,
counts what each rank holds and sends, and prints the model of docs/theory/solver/ranks.md.  ``--check`` marches a small
cube on eight ranks as threads, counts its exchanges, bytes and sums, and prints them beside those of the model.
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

import softway as sw
from softway.cluster.march import march_on
from softway.cluster.rank_model import held_by
from softway.kernels.linalg.exact_sum import PLACES
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import StepControl
from softway.meshes.generators.shapes import box
from softway.model.time_weight import EndPeaks
from softway.ranks.interface import Exchange
from softway.ranks.partition import bisected, owners
from softway.ranks.threads import Threads, in_threads
from softway.solve.linear.conjugate_gradients import Gradients

BYTES = {"row": 27 * 76.0, "node": 20 * 24.0 + 108.0, "sum": 21e-9}
"""Bytes of the stored row of a node, of vectors and diagonal block of a node in an inner step; time of an exact sum of
a node, measured on one core [s]."""
LATENCY, NETWORK, MEMORY = 2e-6, 8e9, 8e9
"""Assumed: time of a message [s], bandwidths of the network and of the memory for each rank [B/s]."""
INNER, ITERATIONS = 6, 8
"""Inner steps of an iteration and iterations of a slab in short slabs: measured, whatever the size."""
EXCHANGES, SUMS = (2, 2), (12, 15)
"""Exchanges and sums of an iteration in contact and of a slab, besides one of each in an inner step: counted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What a rank holds: own nodes, copies of neighbours and of the surface, its cells, and the ranks that send."""

    own: int
    copies: int
    surface: int
    cells: int
    neighbours: int


def parts(cells: int, size: int, most: int = 48) -> Iterator[Part]:
    """Parts of at most ``most`` ranks, evenly chosen, of a cube whose lower face may touch."""
    mesh = box((1.0, 1.0, 1.0), cells=(cells,) * 3)
    ((_, corners),) = mesh.blocks.items()
    owner = owners([corners], [bisected(mesh.points[corners].mean(axis=1), size)], len(mesh.points))
    touching = np.flatnonzero(mesh.points[:, 2] < 1e-9)
    for rank in np.unique(np.linspace(0, size - 1, min(size, most)).astype(int)):
        mine = owner == rank
        here = corners[mine[corners].any(axis=1)]
        near = np.unique(here)
        near = near[~mine[near]]
        everywhere = np.setdiff1d(touching[~mine[touching]], near)
        yield Part(
            own=int(mine.sum()),
            copies=len(near),
            surface=len(everywhere),
            cells=len(here),
            neighbours=len(np.unique(owner[np.concatenate([near, everywhere])])),
        )


def modelled(cells: int, size: int) -> dict[str, Any]:
    """Times [s] of an inner step of the slowest rank, memory [B] of a rank, and the efficiency."""
    found = list(parts(cells, size))
    rank = max(found, key=lambda p: p.own * BYTES["row"] + (p.own + p.copies + p.surface) * BYTES["node"])
    held = rank.own + rank.copies + rank.surface
    compute = (rank.own * BYTES["row"] + held * BYTES["node"]) / MEMORY + rank.own * BYTES["sum"]
    exchange = rank.neighbours * LATENCY + 24.0 * (rank.copies + rank.surface) / NETWORK
    reduction = 2.0 * (LATENCY * np.log2(size) + 2 * PLACES * 8.0 / NETWORK) if size > 1 else 0.0
    alone = (cells + 1) ** 3 / size * (BYTES["row"] + BYTES["node"]) / MEMORY
    step = compute + exchange + reduction
    return asdict(rank) | {
        "mean own": float(np.mean([p.own for p in found])),
        "compute": compute,
        "exchange": exchange,
        "reduction": reduction,
        "efficiency": alone / step,
        "slab": ITERATIONS * (INNER * step + EXCHANGES[0] * exchange + SUMS[0] * reduction),
        "memory": rank.own * BYTES["row"] + held * 40 * 24.0 + rank.cells * (1664.0 + 24 * 24 * 8.0),
    }


@dataclass(frozen=True)
class Counted:
    """Ranks that count their exchanges, the bytes that come with them, and their sums."""

    ranks: Threads
    seen: dict[str, int] = field(default_factory=lambda: {"exchanges": 0, "bytes": 0, "sums": 0})

    def __getattr__(self, name: str) -> Any:
        return getattr(self.ranks, name)

    def exchanged(self, exchange: Exchange, values: np.ndarray) -> np.ndarray:
        """Count an exchange."""
        self.seen["exchanges"] += 1
        self.seen["bytes"] += sum(values[nodes].nbytes for nodes in exchange.receive.values())
        return self.ranks.exchanged(exchange, values)

    def added(self, numbers: np.ndarray) -> np.ndarray:
        """Count a sum."""
        self.seen["sums"] += 1
        return self.ranks.added(numbers)


def law(inner: int, iterations: int, slabs: int, copies: int) -> dict[str, int]:
    """Exchanges, bytes that come with them and sums of a rank in a march."""
    exchanges, sums = (inner + a * iterations + b * slabs for a, b in (EXCHANGES, SUMS))
    return {"exchanges": exchanges, "bytes": 24 * copies * exchanges, "sums": sums}


def checked(cells: int = 8, size: int = 8, slabs: int = 8) -> list[dict[str, Any]]:
    """Counts of each rank of a march, and those of the model for as many iterations and inner steps."""
    cube = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0,) * 3, cells=(cells,) * 3),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -5.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -1e-3), normal=(0.0, 0.0, 1.0)))
    contact = sw.Contact(between=("cube.bottom", "floor"))
    model = sw.build(sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(contact,)))
    settings = Settings(
        until=slabs * 5e-4, step=5e-4, weight=EndPeaks(), method=sw.FixedPoint(tolerance=1e-8), control=StepControl()
    )
    steps: list[int] = []
    plain = Gradients.descend

    def descend(self: Gradients, *given: Any, **named: Any) -> Any:
        found = plain(self, *given, **named)
        steps.append(found.steps)
        return found

    Gradients.descend = descend  # type: ignore[method-assign]

    def march(ranks: Threads) -> tuple[Counted, int, int]:
        counted = Counted(ranks)
        held = held_by(model, ranks)
        done = [s.report.iterations for s in march_on(counted, model, settings) if s is not None]  # type: ignore[arg-type]
        return counted, sum(done), len(held.nodes) - len(held.own)

    results = in_threads(size, march)
    iterations, inner = results[0][1], sum(steps) // size
    return [
        counted.seen
        | {"iterations": iterations, "inner": inner, "copies": copies}
        | {f"modelled {name}": number for name, number in law(inner, iterations, slabs, copies).items()}
        for counted, _, copies in results
    ]


def main() -> None:
    """Print lines of JSON."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--cells", type=int, default=64)
    options.add_argument("--ranks", type=int, default=64)
    options.add_argument("--check", action="store_true")
    options.add_argument("--slabs", type=int, default=8, help="slabs of the check")
    ask = options.parse_args()
    for line in checked(min(ask.cells, 8), 8, ask.slabs) if ask.check else [modelled(ask.cells, ask.ranks)]:
        print(json.dumps(line))


if __name__ == "__main__":
    main()
