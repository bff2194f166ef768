"""D08: the elastica, a slender cantilever with a dead load at its tip that bends it far."""

import numpy as np
import pytest

import results
import softway as sw
from softway.laws.law import Material
from softway.verify.scenes.driving import equilibria

YOUNGS, HEIGHT = 1e4, 1.0 / 50.0
STIFFNESS = YOUNGS * HEIGHT**3 / 12.0
TABLE = {float(k): v for k, v in results.case("D08")["reference"]["table"].items()}


def bent(k: float, law: Material, steps: int, cells: int = 20) -> tuple[float, float]:
    """Deflection and shortening of the tip under ``P L^2/(E I) = k``, in so many steps of the load."""
    mesh = sw.Rectangle(size=(1.0, HEIGHT), cells=(cells, 1), cell="quad9").build()
    beam = sw.Solid(mesh=mesh, material=law, density=1.0, section=sw.PlaneStress(), supports=(sw.Fixed(on="left"),))
    load = sw.Traction(on="beam.right", value=(0.0, -k * STIFFNESS / HEIGHT))
    model = sw.build(sw.Scene(bodies={"beam": beam}, loads=(load,)))
    *_, (u, _) = equilibria(model, [(None, j / steps) for j in range(1, steps + 1)])
    right = mesh.nodes("right")
    middle = right[np.argsort(mesh.points[right, 1])[len(right) // 2]]
    return float(-u[middle, 1]), float(-u[middle, 0])


@pytest.mark.parametrize("k", TABLE)
def test_elastic(k: float) -> None:
    """A load step or two; what remains is the stretch of the axis and the shear of a beam of finite height."""
    found = bent(k, sw.StVenantKirchhoff(E=YOUNGS), 4)
    assert found[0] == pytest.approx(TABLE[k][0], rel=6e-4)
    assert found[1] == pytest.approx(TABLE[k][1], rel=2e-3)


def test_hypoelastic() -> None:
    """The stress is carried along through all the rotation: ten steps are within a part in a thousand."""
    found = bent(5.0, sw.Hypoelastic(E=YOUNGS), 10)
    assert found[0] == pytest.approx(TABLE[5.0][0], rel=1e-3)
    assert found[1] == pytest.approx(TABLE[5.0][1], rel=3e-3)


def test_the_case() -> None:
    deflection, shortening = bent(5.0, sw.StVenantKirchhoff(E=YOUNGS), 4)
    found = {"tip deflection k=5": deflection, "tip shortening k=5": shortening}
    assert results.outside("D08", found) == set()
