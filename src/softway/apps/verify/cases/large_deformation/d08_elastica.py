"""D08: elastica, a slender cantilever strongly bent by a dead load at its tip. 20 x 1 quadratic cells."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes.driving import equilibria
from softway.laws.law import Material
from softway.record.view.plots.curves import Curve, Panel

YOUNGS, HEIGHT = 1e4, 1.0 / 50.0
STIFFNESS = YOUNGS * HEIGHT**3 / 12.0
ELASTIC = sw.laws.StVenantKirchhoff(E=YOUNGS)


@cache
def bent(k: float, law: Material = ELASTIC, steps: int = 4, cells: int = 20) -> tuple[float, float]:
    """Deflection and shortening of the tip under ``P L^2/(E I) = k``, applied in ``steps`` load steps."""
    mesh = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(cells, 1), cell="quad9").build()
    beam = sw.Solid(
        mesh=mesh, material=law, density=1.0, section=sw.bodies.PlaneStress(), supports=(sw.Fixed(on="left"),)
    )
    load = sw.Traction(on="beam.right", value=(0.0, -k * STIFFNESS / HEIGHT))
    model = sw.build(sw.Scene(bodies={"beam": beam}, loads=(load,)))
    *_, (u, _) = equilibria(model, [(None, j / steps) for j in range(1, steps + 1)])
    right = mesh.nodes("right")
    middle = right[np.argsort(mesh.points[right, 1])[len(right) // 2]]
    return float(-u[middle, 1]), float(-u[middle, 0])


def compute() -> Outcome:
    """Compute k = 5; the panel has the other loads of the table."""
    deflection, shortening = bent(5.0)
    table = {float(k): v for k, v in sheet("D08")["reference"]["table"].items()}
    loads = list(table)
    ours, exact = np.array([bent(k) for k in loads]), np.array(list(table.values()))
    curves = []
    for j, name in enumerate(("deflection", "shortening")):
        curves.append(Curve(x=loads, y=ours[:, j], kind="dots", label=name))
        curves.append(Curve(x=loads, y=exact[:, j], kind="exact"))
    panel = Panel(title="Tip of the elastica", x="P L^2 / (E I)", y="displacement / L", curves=tuple(curves))
    return Outcome(values={"tip deflection k=5": deflection, "tip shortening k=5": shortening}, panels=(panel,))
