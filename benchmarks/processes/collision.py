"""The peers' problem of two bodies (``peers/blocks.py``) as we solve it."""

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from problems import noted, now

import softway as sw
from softway.arrays import Array
from softway.marching.results.step import Step
from softway.meshes.mesh import Mesh

sys.path.append(str(Path(__file__).parents[1] / "peers"))

import blocks
from cube import NU, SPEED, STEP, E


def scene(cells: int) -> sw.Scene:
    """The blocks; the upper one has so many ``cells`` along an edge."""
    law = sw.NeoHookean(E=E, nu=NU)
    (low, below), (high, above) = blocks.lower(cells), blocks.upper(cells)
    top, bottom = np.flatnonzero(low[:, 2] > -1e-9), np.arange((cells + 1) ** 2)
    meshes = {
        "below": Mesh(points=low, blocks={"hex8": below}, tags={"top": top}),
        "above": Mesh(points=high, blocks={"hex8": above}, tags={"bottom": bottom}),
    }
    speeds = {"below": 0.0, "above": -SPEED}
    bodies = {
        name: sw.Solid(mesh=mesh, material=law, density=1.0, velocity=sw.bodies.Uniform(value=(0.0, 0.0, speeds[name])))
        for name, mesh in meshes.items()
    }
    return sw.Scene(bodies=bodies, contacts=(sw.Contact(between=("below.top", "above.bottom")),))


def collision(cells: int, divide: float = 1.0, tolerance: float = 1e-8) -> dict[str, Any]:
    """A run to the end; ``momentum`` is that of the upper block along z, over its mass."""
    start = now()
    model = sw.build(scene(cells))
    mass = np.asarray(model.mass.sum(axis=1)).ravel()[-((cells + 1) ** 3) :]
    march = sw.march(model, until=blocks.END, step=STEP / divide, method=sw.FixedPoint(tolerance=tolerance))
    speeds: list[float] = []
    facts, _ = noted(_watched(march, mass / mass.sum(), speeds), start, 0.5 * mass.sum() * SPEED**2)
    return facts | {"momentum": speeds}


def _watched(steps: Iterable[Step], shares: Array, speeds: list[float]) -> Iterator[Step]:
    """The slabs, with the mean speed of the upper block after each of them noted."""
    for step in steps:
        speeds.append(float(shares @ step.after.velocity["above"][:, 2]))
        yield step
