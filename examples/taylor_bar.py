"""Taylor's bar: a copper cylinder of 32.4 by 6.4 mm hits a rigid wall at 227 m/s and comes to rest.

Run it with ``python examples/taylor_bar.py``; ``--cells 10`` refines the mesh, ``--space`` computes the whole bar in
three dimensions.  The program prints the final shape and draws ``demo/taylor_bar.png``.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np

import softway as sw
from softway.apps.verify.scenes import taylor

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "demo"
FRAMES = (0.0, 10e-6, 20e-6, 40e-6, 80e-6)
STEP = 0.78e-6
"""Time step (slab) [s] for five cells across the radius, eight times the automatic one."""


def in_space(across: int) -> sw.Scene:
    """Scene of the whole bar on the plane z = 0, with ``across`` cells across its diameter."""
    mesh = sw.meshes.Cylinder(radius=taylor.RADIUS, height=taylor.LENGTH, cells=(across, round(2.5 * across)))
    scene = taylor.scene((5, 25))
    bar = scene.bodies["bar"]
    assert isinstance(bar, sw.Solid)
    bar = replace(
        bar, mesh=mesh, section=None, supports=(), velocity=sw.bodies.Uniform(value=(0.0, 0.0, -taylor.SPEED))
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
    contacts = (sw.Contact(between=("bar.bottom", "wall")), sw.Contact(between=("bar.side", "wall")))
    return sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=contacts)


def marched(scene: sw.Scene, step: float) -> tuple[taylor.Crushed, dict[float, sw.Step]]:
    """Final shape of the bar, and the slabs nearest to the instants of the picture."""
    model, steps, shown, begun = sw.build(scene), [], {}, time.perf_counter()
    for found in sw.march(model, until=taylor.END, step=step, method=taylor.METHOD):
        steps.append(found)
        for instant in FRAMES:
            if abs(found.after.time - instant) <= 0.5 * step or (instant == 0.0 and len(steps) == 1):
                shown[instant] = found
        if len(steps) % 20 == 0:
            print(f"t = {1e6 * found.after.time:5.1f} us  {time.perf_counter() - begun:7.1f} s", flush=True)
    print(f"{len(steps)} slabs in {time.perf_counter() - begun:.0f} s")
    return taylor.measured(model, steps), shown


def picture(scene: sw.Scene, shown: dict[float, sw.Step], file: Path) -> None:
    """Draw deformed sections with the plastic strain, side by side."""
    mesh = scene.bodies["bar"].mesh.build()
    figure, axes = plt.subplots(1, len(FRAMES), figsize=(11.0, 5.0), sharey=True, layout="constrained")
    for axis, instant in zip(axes, FRAMES, strict=True):
        state = shown[instant].before if instant == 0.0 else shown[instant].after
        x = 1e3 * (mesh.points + state.displacement["bar"])[mesh.blocks["quad4"]]
        strain = state.memory["bar"].law["plastic_strain"].reshape(len(x), -1).mean(axis=1)
        for side in (1.0, -1.0):
            cells = PolyCollection(x * (side, 1.0), array=strain, cmap="viridis", edgecolors="black", linewidths=0.2)
            cells.set_clim(0.0, 3.0)
            axis.add_collection(cells)
        axis.plot([-8.0, 8.0], [0.0, 0.0], color="black")
        axis.set(xlim=(-8.0, 8.0), ylim=(-1.0, 33.5), aspect="equal", title=f"{1e6 * instant:.0f} us", xlabel="mm")
    figure.colorbar(cells, ax=axes, label="plastic strain", shrink=0.8)
    file.parent.mkdir(exist_ok=True)
    figure.savefig(file, dpi=110)
    plt.close(figure)


def main() -> None:
    """Compute the axisymmetric or the three-dimensional bar."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=5, help="across the radius, with --space across the diameter")
    parser.add_argument("--step", type=float, help="time step [s]")
    parser.add_argument("--space", action="store_true")
    given = parser.parse_args()
    step = given.step or STEP * (2.0 if given.space else 1.0) * 5.0 / given.cells
    scene = in_space(given.cells) if given.space else taylor.scene((given.cells, 5 * given.cells))
    found, shown = marched(scene, step)
    for name in found.__dataclass_fields__:
        print(f"{name:12} {np.round(getattr(found, name), 6)}")
    if not given.space:
        picture(scene, shown, OUT / "taylor_bar.png")


if __name__ == "__main__":
    main()
