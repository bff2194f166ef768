"""What heat costs in a slab: solids thrown at a plane, with a temperature and without.

``python benchmarks/processes/heated.py [--smallest]`` marches each solid with heat and without, slab by slab in turn,
and prints one line of JSON: of each case the unknowns, processor times of a slab [ms] and iterations, with heat and
without.  The coupling E alpha^2 theta / c is .01, as in metals.
"""

import argparse
import json
from time import process_time
from typing import Any

import numpy as np

import softway as sw
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh

WARM = 2
"""Slabs before the clock counts: they compile, and factor the operator."""
HEAT = sw.bodies.Thermal(law=sw.heat.Conduction(conductivity=1e-3, capacity=1.0), temperature=1.0, expansion=0.1)
LAWS = {
    "Hencky": sw.laws.Hencky(E=1.0, nu=0.3),
    "neo-Hookean": sw.NeoHookean(E=1.0, nu=0.3),
    "J2": sw.J2(E=1.0, nu=0.3, yield_stress=0.02),
}
CASES = (("bar2", 40, "Hencky"), ("quad4", 30, "neo-Hookean"), ("hex8", 10, "neo-Hookean"),
         ("hex8", 16, "neo-Hookean"), ("hex8", 10, "J2"))  # fmt: skip


def mesh_of(cell: str, cells: int) -> Mesh:
    """A bar, square or cube of side one."""
    if cell == "bar2":
        return interval(1.0, cells=cells)
    make = rectangle if cell == "quad4" else box
    return make((1.0,) * (2 if cell == "quad4" else 3), (cells,) * (2 if cell == "quad4" else 3), cell=cell)


def scene(mesh: Mesh, law: str, heat: sw.bodies.Thermal | None) -> sw.Scene:
    """The solid, thrown at a plane from below a hundredth of its size."""
    up = np.eye(mesh.dim)[-1]
    solid = sw.Solid(mesh=mesh, material=LAWS[law], density=1.0, thermal=heat,
                     velocity=sw.bodies.Uniform(value=tuple(-0.05 * up)))  # fmt: skip
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=tuple(-1e-3 * up), normal=tuple(up)))
    side = "left" if mesh.dim == 1 else "bottom"
    return sw.Scene(bodies={"body": solid, "plane": plane}, contacts=(sw.Contact(between=(f"body.{side}", "plane")),))


def measured(cell: str, cells: int, law: str, slabs: int) -> dict[str, Any]:
    """Medians of the processor times of a slab [ms], and mean iterations, with heat first."""
    mesh = mesh_of(cell, cells)
    step = 0.5 / cells
    marches = [sw.march(scene(mesh, law, heat), until=(WARM + slabs) * step, step=step) for heat in (HEAT, None)]
    times: list[list[float]] = [[], []]
    iterations: list[list[int]] = [[], []]
    for _ in range(WARM + slabs):
        for k, steps in enumerate(marches):
            start = process_time()
            slab = next(steps)
            times[k].append(1e3 * (process_time() - start))
            iterations[k].append(slab.report.iterations)
    return {
        "case": f"{cell}, {cells} an edge, {law}",
        "unknowns": mesh.n_nodes * mesh.dim,
        "times": [float(np.median(each[WARM:])) for each in times],
        "iterations": [float(np.mean(each[WARM:])) for each in iterations],
    }


def main() -> None:
    """Measure all cases and print them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--smallest", action="store_true", help="meshes of two cells an edge, three slabs")
    smallest = parser.parse_args().smallest
    print(json.dumps({"cases": [measured(c, 2 if smallest else n, law, 3 if smallest else 40) for c, n, law in CASES]}))


if __name__ == "__main__":
    main()
