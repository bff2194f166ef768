"""The shipped bracket dropped on an edge: its mesh refined everywhere, and one that follows the contact and the waves.

``python benchmarks/processes/bracket.py [--levels L]`` marches to the end of the rise of the force and prints one line
of JSON: of each run the processor time of building and marching [s], the nodes summed over its slabs, and the greatest
von Mises stress [Pa] and contact force [N] after each slab.
"""

import argparse
import json
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

import softway as sw
from softway.meshes.adaptive.refinement import refined
from softway.record.write.grid.grid_layout import von_mises
from softway.scenario.built import built

SCENARIO = Path(__file__).parents[2] / "scenarios" / "bracket_drop.toml"
STEP, END = 2e-6, 60e-6
ADAPT = sw.meshes.Adapt(tolerance=4.0, every=10, buffer=1, contact_cells=2)
"""Most of the strain energy is near the edge, in cells that are few of all: a greater threshold than that for waves."""


def march(scene: sw.Scene, until: float = END) -> dict[str, Any]:
    """Processor time, nodes and greatest values of a march."""
    start, nodes, stress, force = process_time(), 0, [], []
    for step in sw.march(scene, until=until, step=STEP):
        nodes += step.model.shape[0]
        state = step.after
        found = step.model.stress("bracket", state.displacement["bracket"], state.memory.get("bracket"))
        stress.append(float(von_mises(found).max()))
        force.append(step.ledger.contacts["floor"].force_n)
    return {"cpu": process_time() - start, "nodes": nodes, "stress": stress, "force": force,
            "energy_error": abs(step.ledger.energy_error)}  # fmt: skip


def main() -> None:
    """Measure both runs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--levels", type=int, default=6, help="bisections of a cell; three halve its edges")
    levels = parser.parse_args().levels
    scene = built(sw.load(SCENARIO))
    bracket = scene.bodies["bracket"]
    assert isinstance(bracket, sw.Solid)
    fine = refined(bracket.mesh, np.full(bracket.mesh.n_cells, levels)).mesh
    both = replace(bracket, mesh=fine), replace(bracket, adapt=replace(ADAPT, levels=levels))
    scenes = [replace(scene, bodies={**scene.bodies, "bracket": body}) for body in both]
    march(replace(scene, bodies={**scene.bodies, "bracket": replace(bracket, adapt=ADAPT)}), 3.0 * STEP)  # compiles
    print(json.dumps(dict(zip(("uniform", "adapted"), map(march, scenes), strict=True))))


if __name__ == "__main__":
    main()
