"""Dead loads."""

import numpy as np
import pytest

from softway.bodies.elements.section import Axisymmetric, Bar, PlaneStrain, Volume
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.loads import Gravity, Traction, traction_force
from softway.errors import InputError
from softway.meshes.generators.shapes import KINDS, ball, box, cylinder, interval, rectangle


def test_gravity() -> None:
    assert Gravity(acceleration=-9.81).vector(1).tolist() == [-9.81]
    with pytest.raises(InputError) as caught:
        Gravity(acceleration=-9.81).vector(3)
    assert caught.value.where == "acceleration"


def test_traction_names() -> None:
    assert (Traction(on="a.b.c", value=1.0).body, Traction(on="a.b.c", value=1.0).tag) == ("a", "b.c")
    assert Traction(on="a", value=1.0).tag == "surface"


@pytest.mark.parametrize("cell", KINDS[1])
def test_bar(cell: str) -> None:
    force = traction_force(interval(1.0, 3, cell=cell), Bar(area=2.0), "right", 5.0)
    assert force.ravel().tolist() == [0.0] * (len(force) - 1) + [10.0]


@pytest.mark.parametrize("cell", KINDS[2])
def test_plate(cell: str) -> None:
    """Resultant and moment of a uniform pressure on an edge of length 2, thickness 0.5."""
    mesh = rectangle((2.0, 1.0), (2, 2), cell=cell)
    force = traction_force(mesh, PlaneStrain(thickness=0.5), "top", (1.0, -3.0))
    assert np.abs(force.sum(axis=0) - [1.0, -3.0]).max() < 1e-14
    assert force[:, 1] @ mesh.points[:, 0] == pytest.approx(-3.0, rel=1e-14)
    if mesh.blocks[cell].shape[1] in (6, 9):  # Simpson's rule
        assert np.sort(-force[mesh.nodes("top"), 1]) == pytest.approx(np.array([1, 1, 2, 4, 4]) / 4.0, rel=1e-13)


@pytest.mark.parametrize("cell", KINDS[2])
def test_ring(cell: str) -> None:
    """Ring 1 < r < 3: the top has the area 8 pi, the outer side of height 1 has 6 pi."""
    mesh = rectangle((2.0, 1.0), (2, 2), origin=(1.0, 0.0), cell=cell)
    assert traction_force(mesh, Axisymmetric(), "top", (0.0, 1.0))[:, 1].sum() == pytest.approx(8 * np.pi, rel=1e-14)
    assert traction_force(mesh, Axisymmetric(), "right", (1.0, 0.0))[:, 0].sum() == pytest.approx(6 * np.pi, rel=1e-14)


@pytest.mark.parametrize("cell", KINDS[3])
def test_solid(cell: str) -> None:
    mesh = box((2.0, 3.0, 1.0), (2, 2, 2), cell=cell)
    force = traction_force(mesh, Volume(), "top", (0.0, 0.0, -2.0))
    assert force[:, 2].sum() == pytest.approx(-12.0, rel=1e-13)
    assert force[:, 2] @ mesh.points[:, :2] == pytest.approx([-12.0, -18.0], rel=1e-13)
    sphere = [traction_force(ball(1.0, n, cell=cell), Volume(), "surface", (1.0, 0.0, 0.0))[:, 0].sum() for n in (4, 8)]
    errors = np.abs(np.array(sphere) / (4 * np.pi) - 1)
    assert np.log2(errors[0] / errors[1]) > (1.6 if mesh.blocks[cell].shape[1] in (4, 8) else 3.3)
    side = traction_force(cylinder(1.0, 2.0, (8, 2), cell=cell), Volume(), "side", (0.0, 1.0, 0.0))[:, 1].sum()
    assert side == pytest.approx(4 * np.pi, rel=0.03)


def test_tag_without_facets_is_refused() -> None:
    mesh = rectangle((1.0, 1.0), (2, 2)).with_tag("corner", lambda x: x.sum(axis=1) == 0.0)
    with pytest.raises(InputError) as caught:
        traction_force(mesh, PlaneStrain(), "corner", (1.0, 0.0))
    assert caught.value.where == "on"


def test_ramps_with_many_instants_take_those_around() -> None:
    rng = np.random.default_rng(0)
    times = np.cumsum(rng.random(500))
    ramp = Ramp(times=tuple(times), factors=tuple(rng.random(500)))
    for start in (-1.0, times[0], times[7], times[-1], *(1.1 * times[-1] * rng.random(50))):
        end = start + 3.0 * rng.random()
        knots = np.array([start, *times[(times > start) & (times < end)], end])
        mean = np.trapezoid(np.interp(knots, ramp.times, ramp.factors), knots) / (end - start)
        assert ramp.at(start) == pytest.approx(np.interp(start, ramp.times, ramp.factors), rel=1e-15)
        assert ramp.mean(start, end) == pytest.approx(mean, rel=1e-14)
