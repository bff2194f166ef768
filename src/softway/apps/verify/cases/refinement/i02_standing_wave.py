"""I02: order of displacement and velocity of a standing wave, refined in space and time."""

from collections.abc import Callable
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

CELLS = (10, 20, 40, 80)
END = 4.0


def wave(x: Array) -> Array:
    """Displacement at t = 0 and t = 4; the velocity is zero there."""
    return np.asarray(np.sin(0.5 * np.pi * x))


@cache
def errors(cells: int) -> tuple[float, float, float]:
    """Errors of displacement and velocity in L2, and displacement of the tip, with a slab of one cell's transit."""
    x = np.linspace(0.0, 1.0, cells + 1)
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
        displacement=sw.bodies.Profile(at=tuple(x.tolist()), values=tuple(wave(x).tolist())),
    )
    *_, last = sw.march(sw.Scene(bodies={"bar": bar}), until=END, step=1.0 / cells)
    u, v = (field["bar"][:, 0] for field in (last.after.displacement, last.after.velocity))
    return l2(x, u, wave), l2(x, v, np.zeros_like), float(u[-1])


def l2(x: Array, values: Array, exact: Callable[[Array], Array]) -> float:
    """Norm of the difference between a linear interpolation and an exact function, by five Gauss points a cell."""
    points, weights = np.polynomial.legendre.leggauss(5)
    at = x[:-1, None] + 0.5 * (1.0 + points) * np.diff(x)[:, None]
    square = (np.interp(at, x, values) - exact(at)) ** 2
    return float(np.sqrt((0.5 * np.diff(x) * (square @ weights)).sum()))


def orders(error: Array) -> Array:
    """Orders between successive meshes, one column for each error."""
    return np.asarray(np.log2(error[:-1] / error[1:]))


def compute() -> Outcome:
    """Compute with 10, 20, 40 and 80 elements."""
    found = np.array([errors(cells) for cells in CELLS])
    slopes = orders(found[:, :2])
    values = {
        "order of the displacement": slopes[:, 0].tolist(),
        "order of the velocity": slopes[:, 1].tolist(),
        "displacement of the tip": found[-1, 2],
    }
    edges = [1.0 / cells for cells in CELLS]
    curves = tuple(Curve(x=edges, y=found[:, k], label=name) for k, name in enumerate(("displacement", "velocity")))
    return Outcome(values=values, panels=(Panel(title="Error at t = 4", x="edge", y="L2", log="xy", curves=curves),))
