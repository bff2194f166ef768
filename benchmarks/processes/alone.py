"""One problem in a process of its own: ``python alone.py NAME '{"option": value}'`` prints a line of JSON."""

import json
import resource
import sys
from collections.abc import Callable
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from problems import ball, beam, glued, noted, now

import softway as sw
from softway.apps.verify.scenes.cube import END, ENERGY, STEP, drop
from softway.bodies.elements.section import Volume
from softway.bodies.inertia.mass_redistribution import redistribute_mass
from softway.meshes.generators.shapes import box
from softway.solve.methods.central_difference import Explicit

sys.path.append(str(Path(__file__).parents[1] / "parts"))

FIXED, NEWTON = sw.FixedPoint(tolerance=1e-8), sw.Newton(tolerance=1e-8)
METHODS = {"fixed": FIXED, "Newton": NEWTON}


def cube(
    cells: int, most: int | None = None, keep: str = "", divide: int = 1, tolerance: float = 1e-8, end: float = END
) -> dict[str, Any]:
    """The peers' problem; ``divide`` shortens its slabs."""
    start = now()
    march = sw.march(drop(cells), until=end, step=STEP / divide, method=sw.FixedPoint(tolerance=tolerance))
    facts, last = noted(march, start, ENERGY, most)
    place = last.after.displacement["cube"]
    if keep:
        np.save(keep, place)
    return facts | {"bits": sha256(place.tobytes()).hexdigest()}


def inertia(cells: int, keep: str) -> int:
    """The mass matrix of the peers' problem, whose contact nodes have none, in a file; the number of its entries."""
    mesh = box((1.0, 1.0, 1.0), cells=(cells,) * 3, cell="hex8")
    matrix = redistribute_mass(
        mesh, 1.0, Volume(), sw.bodies.Consistent(), np.flatnonzero(mesh.points[:, 2] < 1e-9)
    ).tocoo()
    at = np.rint(mesh.points * cells).astype(int)
    number = at[:, 0] + (cells + 1) * (at[:, 1] + (cells + 1) * at[:, 2])
    rows, columns = (number[part] for part in matrix.coords)
    np.savez(keep, rows=rows, columns=columns, values=matrix.data)
    return int(matrix.nnz)


def explicit(cells: int) -> dict[str, Any]:
    """The same cube of tetrahedra, by central differences."""
    start = now()
    march = sw.march(drop(cells, "tet4", sw.bodies.Lumped()), until=END, method=Explicit())
    return noted(march, start, ENERGY)[0]


def compact(cells: int, until: float = 1e-3, most: int | None = None) -> dict[str, Any]:
    """A ball all of whose surface may touch, and central differences without contact in the same process."""
    from problems import bare
    from problems import compact as thrown

    plain = bare(thrown(cells, touching=False), until, 100)
    model = sw.build(thrown(cells))
    energy = float(model.kinetic(model.velocity).sum())
    start = now()
    facts, _ = noted(sw.march(model, until=until, method=Explicit()), start, energy, most)
    return facts | {"bare": plain}


def impact(cells: int, method: str, most: int) -> dict[str, Any]:
    """The ball against the plane."""
    start = now()
    march = sw.march(ball(cells), until=15.0, step=0.15, method=METHODS[method])
    return noted(march, start, 0.5 * 0.06**2, most)[0]


def bent(cells: int, method: str, most: int) -> dict[str, Any]:
    """The clamped beam; the unit of energy is the work of the load."""
    start = now()
    march = sw.march(beam(cells), until=62 * 0.4, step=0.4, method=METHODS[method])
    facts, last = noted(march, start, 1.0, most)
    return facts | {"drift": facts["drift"] / last.ledger.work_external}


def block(nu: float, cells: int = 9, most: int = 20) -> dict[str, Any]:
    """The nearly incompressible block."""
    start = now()
    return noted(sw.march(glued(cells, nu), until=100.0, step=0.3, method=FIXED), start, 0.5 * 0.15**2 / 3, most)[0]


def kernels(cell: str, cells: int, repeats: int) -> list[dict[str, Any]]:
    """Rates of the internal force."""
    from bench_kernels import measured

    return [asdict(rate) for rate in measured(cell, cells, repeats)]


def history(cell: str, cells: int, dilatation: str, repeats: int) -> list[dict[str, Any]]:
    """Rates of the internal force of laws with a history."""
    from bench_history import measured

    return [asdict(rate) for rate in measured(cell, cells, dilatation, repeats)]


def factor(cells: int, cases: list[list[Any]]) -> list[dict[str, Any]]:
    """Costs of direct solvers: backend, precision, threads."""
    from bench_factor import measured, operator, streaming

    matrix, _ = operator(cells)
    stream = {t: streaming(t) for t in {case[2] for case in cases}}
    return [asdict(measured(*case, matrix, stream[case[2]])) | {"stream": stream[case[2]]} for case in cases]


def contact(cells: int) -> dict[str, Any]:
    """Contact slabs against slabs of flight."""
    from bench_contact import Clock, ContactSet, measured

    return asdict(measured(cells, 0.1, Clock(ContactSet, "meet")))


def slabs(largest: int) -> list[dict[str, Any]]:
    """Costs of slabs of the three rules."""
    from bench_slab import costs

    return [asdict(cost) for cost in costs(largest)]


def small(slabs: int, repeats: int) -> list[dict[str, Any]]:
    """Slabs of small problems: compiled, with records, and by the solver for all models."""
    from small_problems import costs

    return [asdict(cost) for cost in costs(slabs, repeats)]


def pile(count: list[int], until: float) -> dict[str, Any]:
    """Spheres that fall into a box."""
    from bench_pile import measured

    return asdict(measured((count[0], count[1], count[2]), until))


def collision(cells: int, divide: float = 1.0) -> dict[str, Any]:
    """The peers' problem of two bodies; ``divide`` shortens its slabs."""
    from collision import collision as marched

    return marched(cells, divide)


def pressed(cells: int, slabs: int, friction: float | None) -> dict[str, Any]:
    """Slabs of two blocks in contact against slabs without it."""
    from bench_two_bodies import measured

    return asdict(measured(cells, slabs, friction))


def unmet(cells: int, slabs: int, resting: bool) -> dict[str, float]:
    """Slabs with contact that never closes, and with the floor alone."""
    from bench_open_contact import measured

    return measured(cells, slabs, resting)


PROBLEMS: dict[str, Callable[..., Any]] = {
    f.__name__: f
    for f in (
        cube,
        inertia,
        explicit,
        compact,
        impact,
        bent,
        block,
        kernels,
        history,
        factor,
        contact,
        slabs,
        small,
        pile,
        collision,
        pressed,
        unmet,
    )  # fmt: skip
}


def main() -> None:
    """Run, and print the line: the result, and the most memory that the process had [MB]."""
    result = PROBLEMS[sys.argv[1]](**json.loads(sys.argv[2]))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024.0 if sys.platform == "linux" else 2.0**20)
    print("\n" + json.dumps({"result": result, "peak": peak}))


if __name__ == "__main__":
    main()
