"""What an open contact costs: a block inside of a hollow box that it never touches, in flight and resting on a floor.

``python benchmarks/parts/bench_open_contact.py [--cells N] [--slabs N]`` marches the two bodies with the box on a floor
alone and with their contact too, slab by slab in turn, and prints the times of a slab and their ratio.  The block is
one cell away from the box.  12 cells make 2,197 nodes.
"""

import argparse
from collections.abc import Callable
from time import process_time

import numpy as np

import softway as sw
from softway.arrays import Array, BoolArray
from softway.meshes.generators.shapes import box
from softway.meshes.mesh import Mesh

WARM = 2
"""Slabs before the clock counts: they compile, and factor the operator."""


def part_of_box(cells: int, keep: Callable[[Array], BoolArray]) -> Mesh:
    """Cells of a cube of side one whose centres are at distances from its middle, in cells, that ``keep`` takes."""
    cube = box((1.0, 1.0, 1.0), (cells, cells, cells))
    every = cube.blocks["hex8"]
    middle = cube.points[every].mean(axis=1)
    taken = every[keep(cells * np.abs(middle - 0.5).max(axis=1))]
    nodes, renumbered = np.unique(taken, return_inverse=True)
    points = cube.points[nodes]
    lowest = np.flatnonzero(points[:, 2] < 1e-9)
    return Mesh(points=points, blocks={"hex8": renumbered.reshape(taken.shape)}, tags={"bottom": lowest})


def scene(cells: int, resting: bool, method: sw.contact.DualMortar | sw.contact.NodeToSurface | None) -> sw.Scene:
    """The box, two cells thick, and the block; with a contact of both if a ``method`` is given."""
    law, half = sw.NeoHookean(E=1e4, nu=0.3), 0.5 * cells
    thrown = sw.bodies.Uniform(value=(0.0, 0.0, 0.0) if resting else (0.3, 0.1, 0.2))
    meshes = {
        "box": part_of_box(cells, lambda away: away > half - 2.0),
        "block": part_of_box(cells, lambda away: away < half - 3.0),
    }
    bodies = {name: sw.Solid(mesh=m, material=law, density=1.0, velocity=thrown) for name, m in meshes.items()}
    below = (0.0, 0.0, -1e-4 if resting else -0.5)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=below, normal=(0.0, 0.0, 1.0)))
    contacts = [sw.Contact(between=("box.bottom", "floor"))]
    if method is not None:
        contacts.append(sw.Contact(between=("box.surface", "block.surface"), method=method))
    loads = (sw.Gravity(acceleration=(0.0, 0.0, -9.81)),) if resting else ()
    return sw.Scene(bodies={**bodies, "floor": floor}, contacts=tuple(contacts), loads=loads)


def measured(cells: int, slabs: int, resting: bool) -> dict[str, float]:
    """Mean processor times of a slab [ms]: with the floor alone, and with open contact by either method."""
    methods = {"floor": None, "mortar": sw.contact.DualMortar(), "nodes": sw.contact.NodeToSurface()}
    step = 2e-3
    until = (WARM + slabs) * step
    marches = {name: sw.march(scene(cells, resting, m), until=until, step=step) for name, m in methods.items()}
    times: dict[str, list[float]] = {name: [] for name in marches}
    for _ in range(WARM + slabs):
        for name, steps in marches.items():
            start = process_time()
            next(steps)
            times[name].append(process_time() - start)
    return {name: 1e3 * float(np.mean(spent[WARM:])) for name, spent in times.items()}


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--cells", type=int, default=12, help="cells along the edge of the box")
    options.add_argument("--slabs", type=int, default=28)
    chosen = options.parse_args()
    for resting in (False, True):
        found = measured(chosen.cells, chosen.slabs, resting)
        ratios = ", ".join(f"{name} {ms:.1f} ms ({ms / found['floor']:.2f})" for name, ms in found.items())
        print(f"{'resting' if resting else 'in flight'}: {ratios}", flush=True)


if __name__ == "__main__":
    main()
