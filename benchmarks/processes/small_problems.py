"""What a slab of a small problem costs: compiled, with its steps, with its history, and by the solver for all models.

``python benchmarks/processes/small_problems.py`` prints the table.  Times are those of the processor, the best of some
runs.  ``told`` is a run with a callback for each step.  A run has its line of the history and its two probes for each
slab, and one frame at the end; what opening and closing it takes is left out, by the difference of a long and a short
run.  Bars fly, a disc lies on a floor.
"""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from importlib import import_module
from itertools import islice
from pathlib import Path
from time import process_time

import softway as sw

SLABS = import_module("softway.marching.slabs")
FEW = 4000
"""Slabs of a march of stored energies: a quarter of them are compiled, too."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """Microseconds a slab: the march with its steps, the run with its records, the run with a callback that receives
    each step, and the march for all models.
    """

    case: str
    unknowns: int
    march: float
    run: float
    told: float
    python: float


def bars(cells: int) -> tuple[str, sw.Scene, float]:
    """Elastic bars that fly towards a wall, and the length of their slabs."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1e-3),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=2.0, normal=-1.0))
    contact = sw.Contact(between=("body.right", "wall"))
    return f"{cells} bars", sw.Scene(bodies={"body": solid, "wall": wall}, contacts=(contact,)), 0.1 / cells


def disc(cells: int, law: type[sw.LinearElastic] | type[sw.NeoHookean]) -> tuple[str, sw.Scene, float]:
    """An elastic disc that lies on a floor, and the length of its slabs."""
    solid = sw.Solid(mesh=sw.meshes.Disc(radius=1.0, cells=cells), material=law(E=1e3, nu=0.3), density=1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.0), normal=(0.0, 1.0)))
    scene = sw.Scene(
        bodies={"body": solid, "floor": floor},
        contacts=(sw.Contact(between=("body.boundary", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, -9.81)),),
    )
    return f"disc of {cells} cells, {law.__name__}", scene, 1e-3


def measured(case: str, scene: sw.Scene, step: float, slabs: int, repeats: int) -> Cost:
    """Times of a case."""
    model, few = sw.build(scene), max(slabs // 20, 5)
    end = slabs * step

    def march(count: int) -> None:
        for _ in islice(sw.march(model, until=end, step=step), count):
            pass

    checked = {count: sw.check(_scenario(scene, step, count)) for count in (slabs, slabs // 4)}

    def run(count: int, progress: Callable[[sw.Progress], None] | None = None) -> None:
        with tempfile.TemporaryDirectory() as folder:
            sw.run(checked[count], Path(folder) / "run", progress=progress)

    def told(count: int) -> None:
        run(count, lambda progress: None)

    def each(run: Callable[[int], None]) -> float:
        spent = [count * _best(run, count, repeats, nullcontext) for count in (slabs, slabs // 4)]
        return (spent[0] - spent[1]) / (slabs - slabs // 4)

    return Cost(
        case=case,
        unknowns=int(model.dofs.size),
        march=_best(march, slabs, repeats, nullcontext),
        run=each(run),
        told=each(told),
        python=_best(march, few, repeats, _for_all_models),
    )


def _scenario(scene: sw.Scene, step: float, slabs: int) -> sw.Scenario:
    """The march with its records: two probes, and a frame at the end."""
    tag = scene.contacts[0].between[0].rpartition(".")[2]
    probes = [sw.Probe(name=name, of="body", tag=tag, quantity=name) for name in ("position", "velocity")]
    return sw.Scenario(
        title="small",
        bodies=scene.bodies,
        contacts=scene.contacts,
        loads=scene.loads,
        time=sw.Time(end=slabs * step, step=step),
        output=sw.Output(fields_every=slabs * step, probes=probes),
    )


def _best(
    march: Callable[[int], None], count: int, repeats: int, by: Callable[[], AbstractContextManager[None]]
) -> float:
    """Least time of a slab [us]; the first run is not counted."""
    times = []
    with by():
        for _ in range(repeats + 1):
            start = process_time()
            march(count)
            times.append(process_time() - start)
    return 1e6 * min(times[1:]) / count


@contextmanager
def _for_all_models() -> Iterator[None]:
    """Context in which no slab is compiled."""
    compiled = SLABS.compiled_model, SLABS.stored_model
    SLABS.compiled_model = SLABS.stored_model = lambda *of: None
    try:
        yield
    finally:
        SLABS.compiled_model, SLABS.stored_model = compiled


def costs(slabs: int, repeats: int) -> Iterator[Cost]:
    """Every case; slabs of stored energies take a millisecond, so that fewer of them are enough."""
    for case in (bars(2), bars(200), disc(20, sw.LinearElastic)):
        yield measured(*case, slabs=slabs, repeats=repeats)
    for case in (disc(20, sw.NeoHookean), disc(28, sw.NeoHookean)):
        yield measured(*case, slabs=min(slabs, FEW), repeats=min(repeats, 2))


def main() -> None:
    """Print the table."""
    print(f"{'case':32} {'unknowns':>8} {'march us':>9} {'run us':>9} {'told us':>9} {'all models us':>14}")
    for cost in costs(4000, 5):
        row = f"{cost.march:9.1f} {cost.run:9.1f} {cost.told:9.1f} {cost.python:14.0f}"
        print(f"{cost.case:32} {cost.unknowns:8d} {row}", flush=True)


if __name__ == "__main__":
    main()
