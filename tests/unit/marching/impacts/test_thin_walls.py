"""Bodies one cell thick that may touch on both faces, or on one."""

import numpy as np
import pytest

import softway as sw
from softway.bodies import Uniform
from softway.meshes import Box, Rectangle
from softway.model.model import Model
from softway.obstacles import HalfSpace, Sphere

L, T, C = 1.0, 0.05, 100.0
"""Length and thickness of a strip [m], and speed of its waves [m/s]."""
FLOOR = sw.Tool(shape=HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
PLANE = {"whole": "strip", "bottom": "strip.bottom"}


def strip(cells: tuple[int, int] = (20, 1), cell: str = "quad4", angle: float = 0.0) -> sw.Solid:
    """Strip that flies down with 1 m/s."""
    return sw.Solid(
        mesh=Rectangle(size=(L, T), cells=cells, cell=cell),
        material=sw.LinearElastic(E=C**2, nu=0.0),
        density=1.0,
        velocity=Uniform(value=(0.0, -1.0)),
        place=sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=angle),)) if angle else sw.bodies.Placement(),
    )


def thrown(solid: sw.Solid, tool: sw.Tool = FLOOR, between: str = "strip") -> Model:
    scene = sw.Scene(bodies={"strip": solid, "tool": tool}, contacts=(sw.Contact(between=(between, "tool")),))
    return sw.build(scene)


def moments(model: Model, x: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass [kg], centre (d,) [m], and second moments (d, d) about it [kg m^2] of nodes at x (n, d)."""
    nodal = np.asarray(model.mass.sum(axis=1)).ravel()
    centre = nodal @ x / nodal.sum()
    return float(nodal.sum()), centre, (x - centre).T @ (model.mass @ (x - centre))


def rebound(model: Model, steps: list[sw.Step]) -> float:
    """Velocity of the centre of mass at the end [m/s]."""
    nodal = np.asarray(model.mass.sum(axis=1)).ravel()
    return float(nodal @ steps[-1].after.velocity["strip"][:, -1] / nodal.sum())


def energy_error(steps: list[sw.Step]) -> float:
    """Greatest error of the energy balance, relative to the energy at the start of a strip."""
    return max(abs(step.ledger.energy_error) for step in steps) / (0.5 * L * T)


@pytest.mark.parametrize("between", PLANE.values(), ids=PLANE)
@pytest.mark.parametrize("cell", ["quad4", "tri3"])
@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_mass_centre_and_moments_along_the_wall_stay(between: str, cell: str, angle: float) -> None:
    """What goes is the moment of the cross-section: rho L t^3 / 12."""
    model = thrown(strip(cell=cell, angle=angle), between=between)
    exact = sw.build(sw.Scene(bodies={"strip": strip(cell=cell, angle=angle)}))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    mass, centre, second = moments(model, model.points @ turn.T)
    _, middle, _ = moments(exact, exact.points @ turn.T)
    assert mass == pytest.approx(L * T, rel=1e-14)
    assert centre == pytest.approx(middle, abs=1e-12 * T)
    assert second == pytest.approx(np.diag([T * L**3 / 12.0, 0.0]), abs=1e-13 * T)
    faces = np.abs((model.points @ turn.T - centre)[:, 1]) > 0.4 * T
    assert not model.massive[faces].any()


@pytest.mark.parametrize("cell", ["hex8", "tet4"])
@pytest.mark.parametrize("between", ["plate", "plate.bottom"])
def test_a_plate_in_space_keeps_its_centre_and_its_moments(cell: str, between: str) -> None:
    plate = sw.Solid(
        mesh=Box(size=(1.0, 0.8, T), cells=(12, 10, 1), cell=cell),
        material=sw.LinearElastic(E=1.0, nu=0.3),
        density=3.0,
    )
    floor = sw.Tool(shape=HalfSpace(point=(0.0, 0.0, -1.0), normal=(0.0, 0.0, 1.0)))
    scene = sw.Scene(bodies={"plate": plate, "floor": floor}, contacts=(sw.Contact(between=(between, "floor")),))
    model = sw.build(scene)
    mass, centre, second = moments(model, model.points)
    assert mass == pytest.approx(2.4 * T, rel=1e-13)
    assert centre == pytest.approx([0.5, 0.4, T / 2.0], abs=1e-12 * T)
    assert second == pytest.approx(mass / 12.0 * np.diag([1.0, 0.64, 0.0]), abs=1e-13)


def test_flat_on_the_floor_with_mass_between_two_springs() -> None:
    """The nodes between the layers oscillate on the lower one: exact for a spring of stiffness 2 E A / t.

    Contact lasts pi t / (sqrt(2) c), 11 percent more than the 2 t / c of the continuum; the peak is sqrt(2) rho c v.
    """
    model, exact = thrown(strip(), between="strip.bottom"), np.pi * T / (np.sqrt(2.0) * C)
    steps = list(sw.march(model, until=3.0 * T / C, step=exact / 100.0))
    release = {event.time for step in steps for event in step.events if event.kind == "release"}
    assert max(release) == pytest.approx(exact, rel=2e-4)
    assert max(release) - min(release) < 1e-9 * exact
    assert rebound(model, steps) == pytest.approx(1.0, abs=1e-4)
    peak = max(step.ledger.contacts["strip.bottom-tool"].force_n for step in steps)
    assert peak == pytest.approx(np.sqrt(2.0) * C * L, rel=1e-3)
    assert energy_error(steps) < 1e-13
    assert max(np.abs(step.certificate.momentum_error).max() for step in steps) < 1e-14


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad9"])
def test_flat_on_the_floor_with_both_faces_and_the_ends(cell: str) -> None:
    model = thrown(strip(cell=cell))
    steps = list(sw.march(model, until=6.0 * T / C, step=T / C / 20.0))
    assert 0.99 < rebound(model, steps) <= 1.0 + 1e-12
    assert energy_error(steps) < 1e-12
    assert max(np.abs(step.certificate.momentum_error).max() for step in steps) < 1e-14


def test_one_cell_is_computed_as_two_layers() -> None:
    """Also in bending: the same mass, stiffness and motion as those of the mesh with two layers of the same cells."""
    roller = sw.Tool(shape=Sphere(radius=0.1, centre=(0.5, -0.1001)))
    one, two = (thrown(strip(cells=(20, layers)), roller) for layers in (1, 2))
    order = [np.lexsort(np.round(m.points, 9).T) for m in (one, two)]
    np.testing.assert_allclose(one.points[order[0]], two.points[order[1]], atol=1e-16)
    masses = [m.mass[o][:, o].toarray() for m, o in zip((one, two), order, strict=True)]
    np.testing.assert_allclose(*masses, atol=1e-13 * masses[0].max())
    marches = [list(sw.march(m, until=0.02, step=2e-4)) for m in (one, two)]
    ends = [s[-1].after.displacement["strip"][o] for s, o in zip(marches, order, strict=True)]
    np.testing.assert_allclose(*ends, atol=1e-9 * T)


@pytest.mark.slow
def test_around_a_roller_as_with_eight_cells() -> None:
    roller = sw.Tool(shape=Sphere(radius=0.1, centre=(0.5, -0.1001)))
    found = []
    for layers in (1, 8):
        model = thrown(strip(cells=(20, layers)), roller)
        steps = list(sw.march(model, until=0.08, step=2e-4))
        found.append(rebound(model, steps))
        assert energy_error(steps) < 1e-11
    assert found[0] == pytest.approx(found[1], rel=0.03)


@pytest.mark.slow
def test_a_plate_between_two_tools_slips_on_both_faces() -> None:
    """Nodes without mass on both faces: N = 2 E A d / t on each, and mu N once the tools have slid far enough."""
    stiff, size, depth, way, mu = 1e4, 0.3, 1e-4, 4e-4, 0.2
    times = (0.0, 0.1, 0.3)

    def tool(height: float, normal: float) -> sw.Tool:
        moved = ((0.0, 0.0, 0.0), (0.0, 0.0, normal * depth), (-normal * way, 0.0, normal * depth))
        shape = HalfSpace(point=(0.0, 0.0, height), normal=(0.0, 0.0, normal))
        return sw.Tool(shape=shape, motion=sw.bodies.Table(times=times, displacements=moved))

    mesh = Box(size=(size, size, T), cells=(3, 3, 1))
    plate = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=stiff, nu=0.0), density=1.0)
    coulomb = sw.Coulomb(mu=mu)
    between = (("plate.bottom", "low"), ("plate.top", "high"))
    model = sw.build(
        sw.Scene(
            bodies={"plate": plate, "low": tool(0.0, 1.0), "high": tool(T, -1.0)},
            contacts=tuple(sw.Contact(between=names, friction=coulomb) for names in between),
        )
    )
    assert model.massive.sum() == 16
    steps = list(sw.march(model, until=0.3, step=2e-3))
    normal = 2.0 * stiff * size**2 * depth / T
    found = steps[-1].ledger
    for contact in found.contacts.values():
        assert contact.count == 16
        assert contact.force_n == pytest.approx(normal, rel=1e-9)
        assert contact.force_t == pytest.approx(mu * normal, rel=1e-9)
    slid = 2.0 * way - mu * normal * T / (0.5 * stiff * size**2)
    one_slab = 2.0 * way / 0.2 * 2e-3
    assert found.dissipation == pytest.approx(mu * normal * slid, abs=mu * normal * one_slab)
    assert max(abs(step.ledger.energy_error) for step in steps) < 1e-12 * found.work_external
    assert max(abs(step.certificate.min_gap) for step in steps) < 1e-15
