"""D04: uniaxial stress of a hypoelastic bar is Young's modulus times the logarithm of the stretch, its area follows."""

import numpy as np
import pytest

import results
import softway as sw
from softway.bodies.rate_force import RateForce, rate_force
from softway.verify.scenes.driving import RATES, equilibria

YOUNGS, POISSON, STEPS = 1.0, 0.3, 50
EXACT = {float(k): v for k, v in results.case("D04")["reference"]["sigma"].items()}
TURNING = [name for name in RATES if name != "truesdell"]


def bar(stretch: float, dim: int, rate: str, steps: int = STEPS) -> tuple[float, float, float]:
    """Stress, ratio of the areas, and axial force of a bar along an oblique axis."""
    axis = np.array([1.0, 2.0, -2.0])[:dim]
    axis /= np.linalg.norm(axis)
    mesh = sw.Mesh(points=np.stack([0.0 * axis, axis]), blocks={"bar2": np.array([[0, 1]])})
    law = sw.Hypoelastic(E=YOUNGS, nu=POISSON, rate=RATES[rate])
    internal = rate_force(mesh, law, sw.Bar(area=1.0))
    memory = internal.memory
    for k in range(1, steps + 1):
        u = np.stack([0.0 * axis, (stretch ** (k / steps) - 1.0) * axis])
        now = internal.during(memory, 1.0)
        memory = now.settled(u)
    pull = now.force(u)[1] @ axis
    return float(memory.stress[0, 0, 0]), float(np.prod(memory.lateral[0])), float(pull)


def cell(stretch: float, rate: str, plane: bool, steps: int = STEPS) -> tuple[float, float, float]:
    """The same of a cell whose sides are free: a cube, or a square in plane stress."""
    dim = 2 if plane else 3
    size, cells = (1.0,) * dim, (1,) * dim
    mesh = (sw.Rectangle(size=size, cells=cells) if plane else sw.Box(size=size, cells=cells)).build()
    axes = [("left", "x"), ("bottom", "y")] if plane else [("left", "x"), ("front", "y"), ("bottom", "z")]
    solid = sw.Solid(
        mesh=mesh,
        material=sw.Hypoelastic(E=YOUNGS, nu=POISSON, rate=RATES[rate]),
        density=1.0,
        section=sw.PlaneStress() if plane else None,
        supports=(*(sw.Fixed(on=tag, components=c) for tag, c in axes), sw.Fixed(on="right", components="x")),
    )
    model = sw.build(sw.Scene(bodies={"cell": solid}))
    path = [(mesh.points * ([s, *[s**-POISSON] * (dim - 1)] - np.ones(dim)), 0.0) for s in steady(stretch, steps)]
    *_, (_, (memory,)) = equilibria(model, path)
    assert memory is not None
    part = model.parts[0]
    assert isinstance(part.internal, RateForce)
    now = part.internal.during(memory, 1.0)
    F = now.points.gradient(now.sampling.derivatives(memory.displacement), memory.lateral)[0]
    force = now.remembered(memory)[1][mesh.nodes("right"), 0].sum()
    return float(memory.stress[0, 0, 0]), float(F[1, 1] * F[2, 2]), float(force)


def steady(stretch: float, steps: int) -> list[float]:
    """Stretches in equal increments of length."""
    return [1.0 + (stretch - 1.0) * k / steps for k in range(1, steps + 1)]


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
    assert results.outside("D04", {"sigma(2)": cell(2.0, "jaumann", plane=False)[0]}) == set()
