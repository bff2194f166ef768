"""D07: Cook's membrane, a tapered panel under bending and shear; compressible, and nearly or fully incompressible."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.bodies.elements.quadrature import Dilating
from softway.marching.start.initial_state import initial_state
from softway.record.view.plots.curves import Curve, Panel


def membrane(n: int, cell: str) -> sw.Mesh:
    """Mesh of n by n cells on the tapered panel."""
    unit = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(n, n), cell=cell).build()
    (s, t), corners = unit.points.T, np.array(sheet("D07")["definition"]["corners"], float)
    shape = np.stack([(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t], axis=1)
    return sw.Mesh(points=shape @ corners, blocks=unit.blocks, tags=unit.tags)


@cache
def raised(part: str, n: int, cell: str = "quad4", dilatation: Dilating = "point") -> tuple[float, float]:
    """Rise of the middle and the upper corner of the right side in static equilibrium."""
    data, mesh = sheet("D07")["definition"][part], membrane(n, cell)
    body = sw.Solid(
        mesh=mesh,
        material=sw.LinearElastic(E=data["E"], nu=data["nu"]),
        density=1.0,
        section=sw.bodies.PlaneStress() if data["plane"] == "stress" else sw.bodies.PlaneStrain(),
        supports=(sw.Fixed(on="left"),),
        dilatation=dilatation,
    )
    load = sw.Traction(on="panel.right", value=(0.0, data["F"] / 16.0))
    u = initial_state(
        sw.build(sw.Scene(bodies={"panel": body}, loads=(load,), start=sw.model.StaticStart()))
    ).start.displacement
    right = mesh.nodes("right")
    right = right[np.argsort(mesh.points[right, 1])]
    return float(u[right[len(right) // 2], 1]), float(u[right[-1], 1])


def compute() -> Outcome:
    """Compute 16 by 16 cells: quadratic in a, linear with mean dilatation in b; the panel has coarser meshes."""
    found = {"b corner": raised("b", 16, dilatation="mean")[1], "a mid": raised("a", 16, "quad9")[0]}
    meshes, exact = [4, 8, 16], sheet("D07")["reference"]["b"]["uy_corner"]
    kinds: tuple[tuple[str, Dilating], ...] = (("quad4", "mean"), ("quad4", "point"), ("quad9", "point"))
    curves = [
        Curve(x=meshes, y=[raised("b", n, cell, kind)[1] for n in meshes], kind="dots", label=f"{cell}, {kind}")
        for cell, kind in kinds
    ]
    limit = Curve(x=[4.0, 16.0], y=[exact, exact], kind="exact", label="extrapolated")
    panel = Panel(title="Corner, nearly incompressible", x="cells a side", y="rise", curves=(*curves, limit))
    return Outcome(values=found, panels=(panel,))
