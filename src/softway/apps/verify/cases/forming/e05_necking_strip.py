"""E05: necking of a viscous strip with one slightly thinner half: ``A1^(1/m) - A2^(1/m)`` is constant.

Long strip in plane strain, with thickness 0.99 in the first half and 1 in the second. The force is ``A`` times a power
of the rate in both halves, as in the bar of the case.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact import flow
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

M, LONG, CELLS, FIRST = 0.3, 8.0, 16, 0.99


@cache
def thicknesses(slabs: int = 80) -> tuple[Array, Array]:
    """Thickness of the thin and the thick half, at their middles, after each slab."""
    flat = sw.meshes.Rectangle(size=(2.0 * LONG, 1.0), cells=(2 * CELLS, 1)).build()
    points = flat.points.copy()
    points[:, 1] *= np.where(points[:, 0] < LONG - 1e-9, FIRST, 1.0)
    body = sw.Solid(
        mesh=sw.Mesh(points=points, blocks=flat.blocks, tags=flat.tags),
        material=sw.laws.NortonHoff(K=1.0, m=M),
        density=1.0,
        dilatation="mean",
        supports=(
            sw.Fixed(on="left", components="x"),
            sw.Fixed(on="bottom", components="y"),
            sw.Driven(on="right", components="x", velocity=1.0),
        ),
    )
    at = [int(np.argmin(np.abs(points - [x, y]).sum(axis=1))) for x, y in ((LONG / 2, FIRST), (1.5 * LONG, 1.0))]
    until = 20.0
    steps = sw.march(sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off()), until=until, step=until / slabs)
    found = np.array([[points[n, 1] + s.after.displacement["b"][n, 1] for n in at] for s in steps])
    return found[:, 0], found[:, 1]


def thin_at(thick: float) -> float:
    """Thickness of the thin half when the thick half has the thickness ``thick``."""
    thin, other = thicknesses()
    return float(np.interp(-thick, -other, thin))


def compute() -> Outcome:
    """Compute the thin half when the thickness of the thick half is halved."""
    thin, thick = thicknesses()
    curves = (
        Curve(x=thick, y=thin, label="softway"),
        Curve(x=thick, y=flow.neck(thick, M, FIRST), kind="exact", label="closed form"),
        Curve(x=thick, y=FIRST * thick, kind="other", label="without a neck"),
    )
    panel = Panel(title="The neck", x="thickness of the thick half", y="of the thin half", curves=curves)
    return Outcome(values={"A1 at A2=.5": thin_at(0.5)}, panels=(panel,))
