"""D04: uniaxial stress of a hypoelastic bar is Young's modulus times the logarithm of the stretch, its area follows."""

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.large_deformation.d04_uniaxial_hypoelastic import POISSON, STEPS, YOUNGS, cell
from softway.apps.verify.scenes.driving import RATES
from softway.bodies.internal_force.inelastic.inelastic_force import inelastic_force

EXACT = {float(k): v for k, v in results.case("D04")["reference"]["sigma"].items()}
TURNING = [name for name in RATES if name != "truesdell"]


def bar(stretch: float, dim: int, rate: str, steps: int = STEPS) -> tuple[float, float, float]:
    """Stress, ratio of the areas, and axial force of a bar along an oblique axis."""
    axis = np.array([1.0, 2.0, -2.0])[:dim]
    axis /= np.linalg.norm(axis)
    mesh = sw.Mesh(points=np.stack([0.0 * axis, axis]), blocks={"bar2": np.array([[0, 1]])})
    law = sw.Hypoelastic(E=YOUNGS, nu=POISSON, rate=RATES[rate])
    internal = inelastic_force(mesh, law, sw.bodies.Bar(area=1.0))
    memory = internal.state
    for k in range(1, steps + 1):
        u = np.stack([0.0 * axis, (stretch ** (k / steps) - 1.0) * axis])
        now = internal.during(memory, 1.0)
        memory = now.committed(u)
    pull = now.force(u)[1] @ axis
    return float(memory.stress[0, 0, 0]), float(np.prod(memory.lateral[0])), float(pull)


@pytest.mark.parametrize("stretch", EXACT)
@pytest.mark.parametrize("rate", TURNING)
def test_bar(stretch: float, rate: str) -> None:
    """In one, two and three dimensions."""
    for dim in (1, 2, 3):
        stress, area, force = bar(stretch, dim, rate)
        assert stress == pytest.approx(EXACT[stretch], rel=1e-4)
        assert area == pytest.approx(stretch ** (-2.0 * POISSON), rel=1e-4)
        assert force == pytest.approx(EXACT[stretch] * stretch ** (-2.0 * POISSON), rel=2e-4)


@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("rate", TURNING)
def test_cell_with_free_sides(rate: str, plane: bool) -> None:
    """The error falls with the square of the step: five and more are enough for a thousandth."""
    for stretch in (0.8, 1.25):
        stress, area, force = cell(stretch, rate, plane, 6)
        assert stress == pytest.approx(EXACT[stretch], rel=1e-3)
        assert area == pytest.approx(stretch ** (-2.0 * POISSON), rel=1e-3)
        assert force == pytest.approx(EXACT[stretch] * stretch ** (-2.0 * POISSON), rel=1e-3)


def test_the_case() -> None:
    assert results.missed("D04") == set()
