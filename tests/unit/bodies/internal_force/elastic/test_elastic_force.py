"""Internal force: consistency, invariance, averages, and exact solutions."""

from itertools import product

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve
from scipy.spatial.transform import Rotation

from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric, Bar, PlaneStrain, PlaneStress, Section, Volume
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce, elastic_force
from softway.errors import InputError
from softway.laws.bulk import LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.elasticity.elastic_constants import lame
from softway.laws.law import StoredEnergy
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh
from softway.testing.elements import irregular_patch

LAWS = [LinearElastic(E=2.0, nu=0.3), StVenantKirchhoff(E=2.0, nu=0.3), NeoHookean(E=2.0, nu=0.3)]
FINITE = LAWS[1:]
FLAT = ["tri3", "tri6", "quad4", "quad8", "quad9"]
SOLID = ["tet4", "tet10", "hex8", "hex20", "hex27"]
BODIES: list[tuple[str, Section]] = [
    *product(["bar2", "bar3", "bar2 in 2D", "bar3 in 3D"], [Bar(area=0.7)]),
    *product(FLAT, [PlaneStrain(thickness=0.5), PlaneStress(thickness=0.5), Axisymmetric()]),
    *product(SOLID, [Volume()]),
]
EVERY = [
    pytest.param(law, cell, section, id=f"{type(law).__name__}-{type(section).__name__}-{cell}")
    for law, (cell, section) in product(LAWS, BODIES)
]
TURNING = [case for case in EVERY if not case.values[0].linear and not isinstance(case.values[2], Axisymmetric)]


def a_mesh(name: str) -> Mesh:
    """A few irregular cells of unit extent; bars lie along a slanted line."""
    cell, _, space = name.partition(" in ")
    if space:
        return interval(1.0, cells=3, cell=cell, direction=(1.0, 2.0, -0.5)[: int(space[0])], dim=int(space[0]))
    return irregular_patch(cell)


def some_motion(mesh: Mesh, seed: int, size: float = 0.04) -> Array:
    """Random nodal displacements, a fraction of the least edge; none in x on the line x = 0."""
    u = size * mesh.edge() * np.random.default_rng(seed).standard_normal(mesh.points.shape)
    u[mesh.points[:, 0] < 1e-12, 0] = 0.0
    return u


@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
def test_force_and_tangent_are_derivatives(law: StoredEnergy, cell: str, section: Section) -> None:
    mesh = a_mesh(cell)
    body = elastic_force(mesh, law, section)
    u, change = some_motion(mesh, 1), some_motion(mesh, 2)
    step = 1e-3
    slope = difference(body.energy, u, change, step)
    force = body.force(u)
    assert np.vdot(force, change) == pytest.approx(slope, rel=1e-8)
    stiffness = body.tangent(u)
    rate = difference(body.force, u, change, step).ravel()
    assert np.allclose(stiffness @ change.ravel(), rate, rtol=0, atol=1e-8 * np.abs(force).max())
    assert abs(stiffness - stiffness.T).max() <= 1e-14 * abs(stiffness).max()
    energy, same = body.energy_and_force(u)
    assert energy == body.energy(u)
    assert np.array_equal(same, force)


def difference(function, u: Array, change: Array, step: float) -> Array:  # type: ignore[no-untyped-def]
    one, two = (function(u + k * step * change) - function(u - k * step * change) for k in (1.0, 2.0))
    return (8.0 * one - two) / (12.0 * step)


@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
def test_forces_balance(law: StoredEnergy, cell: str, section: Section) -> None:
    """The resultant vanishes; along the axis only, for a body of revolution."""
    mesh = a_mesh(cell)
    force = elastic_force(mesh, law, section).force(some_motion(mesh, 3))
    resultant = force.sum(axis=0)[1 if isinstance(section, Axisymmetric) else 0 :]
    assert np.abs(resultant).max() <= 1e-14 * np.abs(force).sum()


@pytest.mark.parametrize(("law", "cell", "section"), TURNING)
def test_a_turn_stores_nothing_and_turns_the_force(law: StoredEnergy, cell: str, section: Section) -> None:
    mesh = a_mesh(cell)
    body = elastic_force(mesh, law, section)
    axis = {1: [0.0, 0.0, 0.0], 2: [0.0, 0.0, 2.0], 3: [1.0, -2.0, 0.5]}[mesh.dim]
    turn = Rotation.from_rotvec(axis).as_matrix()[: mesh.dim, : mesh.dim]
    x, u = mesh.points, some_motion(mesh, 4)
    stiff = abs(body.tangent(0.0 * u)).max()
    assert body.energy(x @ turn.T - x) <= 1e-24 * stiff
    assert np.abs(body.force(x @ turn.T - x)).max() <= 1e-13 * stiff
    turned = (x + u) @ turn.T - x
    assert body.energy(turned) == pytest.approx(body.energy(u), rel=1e-12)
    assert np.allclose(body.force(turned), body.force(u) @ turn.T, rtol=0, atol=1e-12 * np.abs(body.force(u)).max())


@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
@pytest.mark.parametrize("size", [1.0, 1e-2, 1e-4, 1e-7])
def test_discrete_gradient_is_exact(law: StoredEnergy, cell: str, section: Section, size: float) -> None:
    mesh = a_mesh(cell)
    body = elastic_force(mesh, law, section)
    u0, step = some_motion(mesh, 5), size * some_motion(mesh, 6)
    u1 = u0 + step
    force = body.discrete_gradient(u0, u1)
    gain = body.energy(u1) - body.energy(u0)
    assert abs(np.vdot(force, u1 - u0) - gain) <= 1e-13 * (body.energy(u0) + body.energy(u1))
    moment = np.cross(*(np.pad(a, ((0, 0), (0, 3 - mesh.dim))) for a in (mesh.points + 0.5 * (u0 + u1), force)))
    if not law.linear and not isinstance(section, Axisymmetric):
        assert np.abs(moment.sum(axis=0)).max() <= 1e-13 * np.abs(moment).sum()


@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
def test_discrete_gradient_is_smooth_at_tiny_increments(law: StoredEnergy, cell: str, section: Section) -> None:
    """Down to nothing it stays within rounding of the force in the middle: an iteration on it cannot stagnate."""
    mesh = a_mesh(cell)
    body = elastic_force(mesh, law, section)
    u, step = some_motion(mesh, 7), some_motion(mesh, 8)
    scale = np.abs(body.force(u)).max()
    for size in (1e-6, 1e-9, 1e-12, 1e-15, 0.0):
        error = np.abs(body.discrete_gradient(u, u + size * step) - body.force(u + 0.5 * size * step)).max()
        assert error <= (1e-13 + 10.0 * size**2) * scale


@pytest.mark.parametrize("section", [Bar(), PlaneStrain(), PlaneStress(), Volume()])
def test_average_force_of_st_venant_kirchhoff_is_exact_with_two_points(section: Section) -> None:
    cell = {Bar: "bar3", Volume: "tet10"}.get(type(section), "quad4")
    mesh = a_mesh(cell)
    body = elastic_force(mesh, StVenantKirchhoff(E=2.0, nu=0.3), section)
    u0, u1 = some_motion(mesh, 9, 0.05), some_motion(mesh, 10, 0.05)
    gain = body.energy(u1) - body.energy(u0)
    two, one = (np.vdot(body.average_force(u0, u1, points), u1 - u0) for points in (2, 1))
    assert two == pytest.approx(gain, abs=1e-14 * (body.energy(u0) + body.energy(u1)))
    assert abs(one - gain) > 1e-6 * abs(gain)


@pytest.mark.parametrize("points", [1, 2, 3])
def test_average_force_of_neo_hookean_has_the_order_of_gauss(points: int) -> None:
    """Error of the work over a chord of size s about its middle: s^(2 points + 1)."""
    mesh = a_mesh("quad4")
    body = elastic_force(mesh, NeoHookean(E=2.0, nu=0.3), PlaneStrain())
    middle, step = some_motion(mesh, 11, 0.1), some_motion(mesh, 12, 0.1)

    def error(size: float) -> float:
        u0, u1 = middle - 0.5 * size * step, middle + 0.5 * size * step
        return float(abs(np.vdot(body.average_force(u0, u1, points), u1 - u0) - (body.energy(u1) - body.energy(u0))))

    order = np.log2(error(1.0) / error(0.5))
    assert abs(order - (2 * points + 1)) < 0.1


@pytest.mark.parametrize("cell", ["bar2", "bar3 in 3D"])
def test_bar_of_st_venant_kirchhoff(cell: str) -> None:
    """Nominal stress E/2 (l^3 - l) at the stretch l."""
    mesh = a_mesh(cell)
    body = elastic_force(mesh, StVenantKirchhoff(E=2.0, nu=0.3), Bar(area=0.7))
    stretch = 1.3
    force = body.force((stretch - 1.0) * mesh.points)
    axis = (mesh.points[mesh.nodes("right")] if cell == "bar3 in 3D" else np.ones((1, 1)))[0]
    axis = axis / np.linalg.norm(axis)
    expected = 0.7 * (stretch**3 - stretch)
    assert np.max(force @ axis) == pytest.approx(expected, rel=1e-13)
    assert body.energy((stretch - 1.0) * mesh.points) == pytest.approx(0.7 * (stretch**2 - 1.0) ** 2 / 4.0, rel=1e-13)


def lateral_balance(body: ElasticForce, mesh: Mesh, stretches: list[float | None]) -> tuple[Array, Array]:
    """Displacement and force of a unit cube with given stretches; those that are None carry no force."""
    free = [axis for axis, s in enumerate(stretches) if s is None]
    stretch = np.array([1.0 if s is None else s for s in stretches])
    for _ in range(30):
        u = mesh.points * (stretch - 1.0)
        force, modes = body.force(u), [np.eye(3)[axis] * mesh.points for axis in free]
        residual = np.array([np.vdot(force, mode) for mode in modes])
        K = body.tangent(u)
        matrix = np.array([[p.ravel() @ (K @ q.ravel()) for q in modes] for p in modes])
        stretch[free] -= np.linalg.solve(matrix, residual)
    u = mesh.points * (stretch - 1.0)
    return u, body.force(u)


@pytest.mark.parametrize("law", FINITE)
def test_bar_is_a_volume_with_free_sides(law: StoredEnergy) -> None:
    cube = box((1.0, 1.0, 1.0), (1, 1, 1), cell="hex8")
    solid = elastic_force(cube, law, Volume())
    u, force = lateral_balance(solid, cube, [1.4, None, None])
    line = interval(1.0, cells=2)
    bar = elastic_force(line, law, Bar())
    assert bar.energy(0.4 * line.points) == pytest.approx(solid.energy(u), rel=1e-13)
    assert bar.force(0.4 * line.points)[-1, 0] == pytest.approx(force[cube.nodes("right"), 0].sum(), rel=1e-12)
    assert np.allclose(bar.stress(0.4 * line.points), solid.stress(u), atol=1e-12)
    assert bar.volume_ratio(0.4 * line.points) == pytest.approx(solid.volume_ratio(u), rel=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_plane_stress_is_a_volume_with_free_faces(law: StoredEnergy) -> None:
    cube = box((1.0, 1.0, 1.0), (1, 1, 1), cell="hex8")
    solid = elastic_force(cube, law, Volume())
    u, _ = lateral_balance(solid, cube, [1.2, 0.9, None])
    square = rectangle((1.0, 1.0), (2, 1), cell="tri6")
    plate = elastic_force(square, law, PlaneStress())
    v = square.points * np.array([0.2, -0.1])
    assert plate.energy(v) == pytest.approx(solid.energy(u), rel=1e-13)
    assert np.allclose(plate.stress(v), solid.stress(u)[0], atol=1e-13)
    assert plate.volume_ratio(v) == pytest.approx(solid.volume_ratio(u), rel=1e-13)


@pytest.mark.parametrize("law", LAWS)
def test_plane_strain_is_a_volume_that_is_held(law: StoredEnergy) -> None:
    cube, square = box((1.0, 1.0, 1.0), (1, 1, 1), cell="tet10"), rectangle((1.0, 1.0), (2, 1), cell="quad9")
    gradient = np.array([[0.1, 0.3], [-0.2, 0.05]])
    solid, slice_ = elastic_force(cube, law, Volume()), elastic_force(square, law, PlaneStrain())
    u = np.zeros_like(cube.points)
    u[:, :2] = cube.points[:, :2] @ gradient.T
    v = square.points @ gradient.T
    assert slice_.energy(v) == pytest.approx(solid.energy(u), rel=1e-13)
    assert np.allclose(slice_.stress(v), solid.stress(u)[0], atol=1e-13)
    assert slice_.volume_ratio(v) == pytest.approx(solid.volume_ratio(u), rel=1e-13)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("cell", FLAT)
def test_homogeneous_stretch_of_a_full_cylinder(law: StoredEnergy, cell: str) -> None:
    """u_r = a r, u_y = b y down to the axis: a homogeneous strain of the volume pi R^2 L."""
    mesh = rectangle((0.5, 2.0), (3, 2), cell=cell)
    body = elastic_force(mesh, law, Axisymmetric())
    stretch = np.array([1.1, 0.8, 1.1])
    E = law.measure.strain(np.diag(stretch - 1.0), np.eye(3))
    u = mesh.points * (stretch[:2] - 1.0)
    assert body.energy(u) == pytest.approx(np.pi * 0.25 * 2.0 * float(law.energy(E)), rel=1e-13)
    sigma = law.stress(E) if law.linear else law.stress(E) * np.diag(stretch**2) / np.prod(stretch)
    assert np.allclose(body.stress(u), sigma, atol=1e-13)


@pytest.mark.parametrize(
    ("cell", "order"), [("quad4", 2.0), ("tri3", 2.0), ("quad8", 4.0), ("quad9", 4.0), ("tri6", 4.0)]
)
def test_thick_walled_tube_converges_to_lame(cell: str, order: float) -> None:
    """Inner pressure, ends held: u(a) of Lame (1852); the compliance converges at twice the order of the element."""
    law, a, b, length, p = LinearElastic(E=2.0, nu=0.3), 1.0, 2.0, 0.5, 0.1
    _, shear = lame(2.0, 0.3)
    share = p * a**2 / (b**2 - a**2)
    exact = share * (1.0 - 2.0 * 0.3) * a / (2.0 * shear) + share * b**2 / (2.0 * shear * a)
    errors = []
    for n in (4, 8, 16):
        mesh = rectangle((b - a, length), (n, 1), cell=cell, origin=(a, 0.0))
        body = elastic_force(mesh, law, Axisymmetric())
        inner = mesh.nodes("left")
        shares = np.array([0.5, 0.5]) if len(inner) == 2 else simpson(mesh.points[inner, 1])
        load = np.zeros_like(mesh.points)
        load[inner, 0] = 2.0 * np.pi * a * length * p * shares
        free = np.flatnonzero(np.stack([np.ones(mesh.n_nodes, bool), np.zeros(mesh.n_nodes, bool)], axis=1).ravel())
        K = body.tangent(np.zeros_like(mesh.points)).tocsr()[free][:, free]
        solved = spsolve(K.tocsc(), load.ravel()[free])
        errors.append(abs(shares @ solved[inner] - exact))
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > order - 0.2)


def simpson(y: Array) -> Array:
    """Shares of the nodes of one quadratic edge in a constant load."""
    middle = 0.5 * (y.min() + y.max())
    return np.where(np.abs(y - middle) < 1e-9, 4.0, 1.0) / 6.0


def test_inverted_elements_have_infinite_energy_without_warning() -> None:
    mesh = a_mesh("quad4")
    for law in FINITE:
        body = elastic_force(mesh, law, PlaneStrain())
        mirrored = -2.0 * mesh.points * np.array([1.0, 0.0])
        assert body.energy(mirrored) == np.inf
        assert not np.isfinite(body.force(mirrored)).any()
        assert body.volume_ratio(mirrored) == pytest.approx(-1.0, rel=1e-12)
        assert not np.isfinite(body.discrete_gradient(0.0 * mirrored, mirrored)).any()
    linear = elastic_force(mesh, LAWS[0], PlaneStrain())
    assert np.isfinite(linear.energy(mirrored))


def test_small_strain_keeps_its_digits_in_a_body() -> None:
    """A neo-Hookean cube under a strain of 1e-7 against Hooke's energy; the third order term leaves 1e-7."""
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2), cell="hex8")
    u = 1e-7 * mesh.points @ np.array([[1.0, 0.3, 0.0], [-0.3, 0.5, 0.2], [0.1, -0.2, -1.0]])
    finite, hooke = (elastic_force(mesh, law, Volume()).energy(u) for law in (LAWS[2], LAWS[0]))
    assert finite == pytest.approx(hooke, rel=1e-6)


def test_linear_tangent_is_constant_and_says_so() -> None:
    mesh = a_mesh("tri6")
    body = elastic_force(mesh, LAWS[0], PlaneStress())
    assert body.linear
    assert abs(body.tangent(some_motion(mesh, 13)) - body.tangent(np.zeros_like(mesh.points))).max() == 0.0
    assert not elastic_force(mesh, LAWS[2], PlaneStress()).linear


def test_blocks_of_different_cells_share_their_nodes() -> None:
    """A unit square of one quad4 and two tri3 under a homogeneous strain: no force inside, energy of the area."""
    points = np.array([[0.0, 0.0], [0.4, 0.0], [1.0, 0.0], [0.0, 1.0], [0.6, 1.0], [1.0, 1.0]])
    blocks = {"quad4": np.array([[0, 1, 4, 3]]), "tri3": np.array([[1, 2, 5], [1, 5, 4]])}
    mesh = Mesh(points=points, blocks=blocks)
    law, gradient = LAWS[2], np.array([[0.1, 0.2], [0.0, -0.1]])
    body = elastic_force(mesh, law, PlaneStrain())
    H = np.zeros((3, 3))
    H[:2, :2] = gradient.T
    W = float(law.energy(law.measure.strain(H, np.eye(3))))
    assert body.energy(points @ gradient.T) == pytest.approx(W, rel=1e-13)
    assert body.stress(points @ gradient.T).shape == (3, 3, 3)
    stiffness = body.tangent(points @ gradient.T)
    assert stiffness.shape == (12, 12)
    change = some_motion(mesh, 14)
    rate = difference(body.force, points @ gradient.T, change, 1e-3).ravel()
    assert np.allclose(stiffness @ change.ravel(), rate, rtol=0, atol=1e-8 * np.abs(rate).max())


def test_a_section_that_does_not_fit_is_refused() -> None:
    with pytest.raises(InputError) as error:
        elastic_force(a_mesh("quad4"), LAWS[0], Volume())
    assert error.value.where == "section"
