"""Bodies of several materials against exact solutions: waves, a composite bar, a layered beam."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.elements.section import PlaneStress
from softway.bodies.internal_force.assembled import internal_force
from softway.bodies.internal_force.materials import materials_of

WIDTH = 0.3
"""Width of the pulse [m]; 30 cells of 0.01 m."""


def strip(dim: int, cells: int, length: float) -> sw.Mesh:
    """Bar, strip or prism whose halves are the regions ``near`` and ``far``."""
    size = length / cells
    if dim == 1:
        mesh = sw.meshes.Interval(length=length, cells=cells)
    elif dim == 2:
        mesh = sw.meshes.Rectangle(size=(length, 2 * size), cells=(cells, 2))
    else:
        mesh = sw.meshes.Box(size=(length, size, size), cells=(cells, 1, 1))
    divided = sw.meshes.Divided(mesh=mesh, regions={"near": sw.meshes.InBox(high=(0.5 * length,))}, rest="far")
    return divided.build()


def pulse(x: np.ndarray, start: float) -> np.ndarray:
    """Displacement pulse of the height one between ``start`` and ``start + WIDTH``."""
    s = (x - start) / WIDTH
    return np.where((s > 0.0) & (s < 1.0), np.sin(np.pi * np.clip(s, 0.0, 1.0)) ** 4, 0.0)


def peak(values: np.ndarray) -> float:
    """Extreme value of a pulse, by the parabola through the three nodes around it."""
    k = int(np.argmax(np.abs(values)))
    a, b, c = values[k - 1 : k + 2]
    return float(b - (c - a) ** 2 / (8.0 * (a - 2.0 * b + c)))


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_pulse_at_an_interface_of_impedances_1_and_2(dim: int) -> None:
    mesh = strip(dim, 200, 2.0)
    nu = 0.0 if dim == 1 else 0.3
    stiff = (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu)  # E of the plane-wave modulus one
    speed, height = 1.0, 1e-3
    profile, ahead = pulse(mesh.points[:, 0], 0.4), 1e-5
    slope = (pulse(mesh.points[:, 0] + ahead, 0.4) - pulse(mesh.points[:, 0] - ahead, 0.4)) / (2.0 * ahead)
    along = np.eye(dim)[0]
    solid = sw.Solid(
        mesh=mesh,
        material={"near": sw.LinearElastic(E=stiff, nu=nu), "far": sw.LinearElastic(E=2.0 * stiff, nu=nu)},
        density={"near": 1.0, "far": 2.0},
        displacement=height * profile[:, None] * along,
        velocity=-speed * height * slope[:, None] * along,
        supports=() if dim == 1 else (sw.Fixed(on="all", components="yz"[: dim - 1]),),
    )
    steps = list(sw.march(sw.build(sw.Scene(bodies={"bar": solid})), until=0.8, step=0.004))
    u = steps[-1].after.displacement["bar"]
    line = np.flatnonzero((np.abs(mesh.points[:, 1:]) < 1e-12).all(axis=1))
    line = line[np.argsort(mesh.points[line, 0])]
    x, u = mesh.points[line, 0], u[line, 0] / height
    assert peak(u[x > 1.0]) == pytest.approx(2.0 / 3.0, abs=5e-3)
    assert peak(u[x < 1.0]) == pytest.approx(-1.0 / 3.0, abs=5e-3)
    total = steps[0].ledger.energy_kinetic + steps[0].ledger.energy_strain
    assert max(abs(step.ledger.energy_error) for step in steps) < 1e-12 * total


def test_composite_bar_under_a_dead_load() -> None:
    """Displacement F (x/E1) up to the interface, and F (L/E1 + (x - L)/E2) from there."""
    mesh = strip(1, 10, 2.0)
    solid = sw.Solid(
        mesh=mesh,
        material={"near": sw.LinearElastic(E=3.0), "far": sw.LinearElastic(E=7.0)},
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    loads = (sw.Traction(on="bar.right", value=(1e-3,)),)
    scene = sw.Scene(bodies={"bar": solid}, loads=loads, start=sw.model.StaticStart())
    model = sw.build(scene)
    state = next(sw.march(model, until=0.1, step=0.1)).before
    x = mesh.points[:, 0]
    exact = 1e-3 * (np.minimum(x, 1.0) / 3.0 + np.maximum(x - 1.0, 0.0) / 7.0)
    assert np.abs(state.displacement["bar"][:, 0] - exact).max() < 1e-15
    stress = model.stress("bar", state.displacement["bar"])[:, 0, 0]
    assert np.abs(stress / 1e-3 - 1.0).max() < 1e-12


def test_layered_beam_has_the_stiffness_of_the_transformed_section() -> None:
    """Pure bending with nu = 0: u = (-k x (y - a), k x^2/2) about the axis a of the transformed section is exact."""
    length, low, high, youngs, curvature = 3.0, 0.2, 0.3, (2.0, 5.0), 1e-3
    mesh = sw.meshes.Divided(
        mesh=sw.meshes.Rectangle(size=(length, low + high), cells=(6, 5), cell="quad9"),
        regions={"low": sw.meshes.InBox(high=(length, low))},
        rest="high",
    ).build()
    laws = {"low": sw.LinearElastic(E=youngs[0]), "high": sw.LinearElastic(E=youngs[1])}
    body = internal_force(mesh, materials_of(mesh, laws, 1.0), PlaneStress(), "point")
    area, centre = np.array([low, high]) * youngs, np.array([0.5 * low, low + 0.5 * high])
    axis = float(area @ centre / area.sum())
    stiffness = float(np.array(youngs) @ (np.array([low, high]) ** 3 / 12.0) + area @ (centre - axis) ** 2)
    x, y = mesh.points.T
    u = curvature * np.stack([-x * (y - axis), 0.5 * x**2], axis=1)
    energy, force = body.energy_and_force(u)
    inner, right = (x > 1e-9) & (x < length - 1e-9), x > length - 1e-9
    size, rounding = stiffness * curvature, 1e-14 * max(youngs) * np.abs(u).max()
    assert np.abs(force[inner]).max() < rounding
    assert abs(force[right, 0].sum()) < rounding
    assert -(y[right] - axis) @ force[right, 0] == pytest.approx(size, rel=1e-12)
    assert energy == pytest.approx(0.5 * stiffness * curvature**2 * length, rel=1e-12)


def test_mass_of_regions() -> None:
    """Mass, centre and moment of inertia of a body of two densities, also with massless contact nodes."""
    mesh = sw.meshes.Divided(
        mesh=sw.meshes.Rectangle(size=(2.0, 1.0), cells=(16, 8)),
        regions={"left": sw.meshes.InBox(high=(0.5,))},
        rest="right",
    )
    law = sw.LinearElastic(E=1.0)
    block = sw.Solid(mesh=mesh, material={"left": law, "right": law}, density={"left": 6.0, "right": 2.0})
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    bodies, contact = {"block": block, "floor": floor}, sw.Contact(between=("block.bottom", "floor"))
    for contacts in ((), (contact,)):
        model = sw.build(sw.Scene(bodies=bodies, contacts=contacts))
        x, ones = model.points, np.ones(len(model.points))
        assert ones @ (model.mass @ ones) == pytest.approx(6.0, rel=1e-12)
        assert ones @ (model.mass @ x) == pytest.approx([3.0 * 0.25 + 3.0 * 1.25, 3.0], rel=1e-12)
        assert x[:, 0] @ (model.mass @ x[:, 0]) == pytest.approx(
            6.0 * 0.5**3 / 3.0 + 2.0 * (8.0 - 0.125) / 3.0, rel=1e-9
        )
