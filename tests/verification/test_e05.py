"""E05: a viscous strip necks where it is a little thinner: ``A1^(1/m) - A2^(1/m)`` stays.

A long strip in plane strain, its first half 0.99 and its second half 1 thick.  The force is ``A`` times a power of the
rate in both halves, as in the bar of the case.
"""

from functools import cache

import numpy as np
import pytest

import results
import softway as sw
from softway.typing import Array

M, LONG, CELLS = 0.3, 8.0, 16


@cache
def thicknesses(slabs: int) -> tuple[Array, Array]:
    """Thickness of the thin and of the thick half, in their middles, after each slab."""
    flat = sw.Rectangle(size=(2.0 * LONG, 1.0), cells=(2 * CELLS, 1)).build()
    points = flat.points.copy()
    points[:, 1] *= np.where(points[:, 0] < LONG - 1e-9, 0.99, 1.0)
    body = sw.Solid(
        mesh=sw.Mesh(points=points, blocks=flat.blocks, tags=flat.tags),
        material=sw.NortonHoff(K=1.0, m=M),
        density=1.0,
        dilatation="mean",
        supports=(
            sw.Fixed(on="left", components="x"),
            sw.Fixed(on="bottom", components="y"),
            sw.Driven(on="right", components="x", velocity=1.0),
        ),
    )
    at = [int(np.argmin(np.abs(points - [x, y]).sum(axis=1))) for x, y in ((LONG / 2, 0.99), (1.5 * LONG, 1.0))]
    until = 20.0
    steps = sw.march(sw.Scene(bodies={"b": body}, inertia=sw.Off()), until=until, step=until / slabs)
    found = np.array([[points[n, 1] + s.after.displacement["b"][n, 1] for n in at] for s in steps])
    return found[:, 0], found[:, 1]


def test_the_neck_grows_as_the_formula_says() -> None:
    thin, thick = thicknesses(80)
    assert thick[-1] < 0.5
    rest = 1.0 - 0.99 ** (1.0 / M)
    np.testing.assert_allclose(thin, (thick ** (1.0 / M) - rest) ** M, rtol=1e-2)


def test_the_case() -> None:
    thin, thick = thicknesses(80)
    found = {"A1 at A2=.5": float(np.interp(-0.5, -thick, thin))}
    assert results.outside("E05", found) == set()
    for A2, A1 in results.case("E05")["reference"]["table"][:5]:
        assert np.interp(-A2, -thick, thin) == pytest.approx(A1, rel=0.01)
