"""The fused kernels of laws with a history against the arrays of NumPy."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from softway.arrays import Array
from softway.bodies.elements.quadrature import Dilating
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, PlaneStress, Section, Volume
from softway.bodies.internal_force.inelastic.array_evaluation import RateArrayEvaluation
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce, inelastic_force
from softway.bodies.internal_force.inelastic.kernel_evaluation import RateKernelEvaluation
from softway.bodies.internal_force.material_state import MaterialState
from softway.kernels.jit.threads import use
from softway.laws.bulk import J2, Hypoelastic
from softway.laws.law import RateLaw
from softway.laws.objective_rates import GreenNaghdi, Jaumann
from softway.laws.plasticity.hardening import LinearHardening, PowerHardening, Voce
from softway.laws.plasticity.rate_dependence import Perzyna
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh
from softway.testing.elements import irregular_patch

pytestmark = pytest.mark.slow

METAL = {"E": 2.0, "nu": 0.3, "yield_stress": 0.02}
VOCE = Voce(saturation=0.05, exponent=16.0, modulus=0.1)
LAWS = {
    "hypoelastic": Hypoelastic(E=2.0, nu=0.3),
    "perfect": J2(**METAL),
    "linear": J2(**METAL, hardening=LinearHardening(modulus=0.1)),
    "kinematic": J2(**METAL, hardening=LinearHardening(modulus=-0.05), kinematic=0.2),
    "voce": J2(**METAL, hardening=VOCE),
    "both": J2(**METAL, hardening=VOCE, kinematic=0.1),
    "softening": J2(**METAL, hardening=Voce(saturation=0.01, exponent=5.0)),
}
FLAT, SOLID = ["tri3", "tri6", "quad4", "quad8", "quad9"], ["tet4", "tet10", "hex8", "hex20", "hex27"]
BODIES: list[tuple[str, Section]] = [
    *product(FLAT, [PlaneStrain(thickness=0.5), Axisymmetric()]),
    *product(SOLID, [Volume()]),
]
EVERY = [
    pytest.param(law, cell, section, id=f"{name}-{type(section).__name__}-{cell}")
    for (name, law), (cell, section) in product(LAWS.items(), BODIES)
]


def noise(mesh: Mesh, size: float, seed: int = 1) -> Array:
    """Random nodal displacements, a fraction of the least edge; none in x on the line x = 0."""
    u = size * mesh.edge() * np.random.default_rng(seed).standard_normal(mesh.points.shape)
    u[mesh.points[:, 0] < 1e-12, 0] = 0.0
    return u


def paths(mesh: Mesh, section: Section) -> list[list[Array]]:
    """Motions in slabs: of every size, there and back, and with large rotations where they are motions of the body."""
    found = [[noise(mesh, s), noise(mesh, 1.2 * s, 2), noise(mesh, -s)] for s in (1e-9, 1e-4, 3e-3, 0.03)]
    if not isinstance(section, Axisymmetric):
        turning = []
        for k in (1, 2, 3):
            turn = Rotation.from_rotvec([0.0, 0.0, 0.8 * k] if mesh.dim == 2 else [0.4 * k, -0.8 * k, 0.2 * k])
            R = turn.as_matrix()[: mesh.dim, : mesh.dim]
            turning.append((mesh.points + noise(mesh, 0.01 * k)) @ R.T - mesh.points)
        found.append(turning)
    return found


def plain(body: InelasticForce) -> InelasticForce:
    """The same body by arrays."""
    return replace(body, work=body.plain)


@pytest.mark.few(17)
@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
def test_kernels_agree_with_arrays(law: RateLaw, cell: str, section: Section) -> None:
    mesh = irregular_patch(cell)
    body = inelastic_force(mesh, law, section)
    assert isinstance(body.work, RateKernelEvaluation)
    w, flowed = noise(mesh, 1.0, 3), 0.0
    for path in paths(mesh, section):
        memory = body.state
        for u in path:
            memory = compare(body.during(memory, 0.1), u, w)
        flowed = max(flowed, memory.law.get("plastic_strain", np.ones(1)).max())
    assert flowed > 0.0


@pytest.mark.few(9)
@pytest.mark.parametrize("name", ["hypoelastic", "linear", "both"])
@pytest.mark.parametrize(
    ("cell", "section"),
    [b for b in BODIES if b[0] not in ("hex20", "hex27", "tet10")],
    ids=lambda x: x if isinstance(x, str) else type(x).__name__,
)
def test_mean_dilatation(name: str, cell: str, section: Section) -> None:
    mesh = irregular_patch(cell)
    body = inelastic_force(mesh, LAWS[name], section, "mean")
    assert isinstance(body.work, RateKernelEvaluation)
    for path in paths(mesh, section):
        memory = body.state
        for u in path:
            memory = compare(body.during(memory, 0.1), u, noise(mesh, 1.0, 3))


def compare(body: InelasticForce, u: Array, w: Array) -> MaterialState:
    """Everything the kernels compute at the end of a slab; the memory after."""
    arrays = plain(body)
    stiffness = arrays.tangent(u)
    size = abs(stiffness).max()
    rounding = size * (np.abs(u).max() + 0.05)  # that of F = I + H, which the arrays subtract
    (W, f), (energy, force) = arrays.energy_and_force(u), body.energy_and_force(u)
    np.testing.assert_allclose(force, f, rtol=0.0, atol=3e-14 * rounding)
    after, known = body.committed(u), arrays.committed(u)
    assert_same(after, known, size)
    assert energy == pytest.approx(W, rel=1e-12, abs=1e-14 * body.sampling.volume.sum() * (1e-3 + known.stored.max()))
    matrix = body.tangent(u)
    np.testing.assert_allclose((matrix - stiffness).data, 0.0, rtol=0.0, atol=3e-14 * size)
    assert abs(matrix - matrix.T).max() <= 1e-14 * size
    K = 10.0 * size * np.abs(w).max()
    np.testing.assert_allclose(body.tangent_product(u, w), arrays.tangent_product(u, w), rtol=0.0, atol=3e-14 * K)
    blocks = body.tangent_diagonal_blocks(u)
    np.testing.assert_allclose(blocks, arrays.tangent_diagonal_blocks(u), rtol=0.0, atol=3e-14 * size)
    stored, again, viscous = body.stored_force(after, u)
    assert stored == pytest.approx(body.stored_energy(after, energy), rel=1e-12)
    np.testing.assert_allclose(again, force, rtol=0.0, atol=3e-14 * rounding)
    assert viscous is None
    assert body.end_force(u)[2] is None
    return after


def assert_same(found: MaterialState, known: MaterialState, size: float) -> None:
    """The same memory, to rounding of strains of order one."""
    assert found.law.keys() == known.law.keys()
    for a, b in ((found.stress, known.stress), *((found.law[k], known.law[k]) for k in known.law)):
        rounding = 1e-13 * np.abs(b).max(initial=0.1)  # components are differences of parts as great as the greatest
        np.testing.assert_allclose(a, b, rtol=0.0, atol=rounding)
        assert not a.flags.writeable
    np.testing.assert_allclose(found.stored, known.stored, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(found.dissipated, known.dissipated, rtol=1e-12, atol=1e-15)
    assert np.array_equal(found.displacement, known.displacement)
    assert np.array_equal(found.lateral, known.lateral)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_tensors_turn_with_the_body(law: RateLaw) -> None:
    """A rigid turn of a stressed body turns its force, and takes up nothing."""
    mesh = irregular_patch("hex8")
    body = inelastic_force(mesh, law, Volume())
    u = noise(mesh, 0.02)
    memory = body.committed(u)
    R = Rotation.from_rotvec([0.5, -1.0, 0.3]).as_matrix()
    turned = body.during(memory, 1.0)
    energy, force = turned.energy_and_force((mesh.points + u) @ R.T - mesh.points)
    np.testing.assert_allclose(force, body.force(u) @ R.T, rtol=0.0, atol=1e-13 * np.abs(force).max())
    assert energy == pytest.approx(turned.stored_energy(memory, energy), rel=1e-12)


def test_other_laws_sections_and_rates_keep_the_arrays() -> None:
    square = rectangle((1.0, 1.0), cells=(2, 2))
    for law in (
        Hypoelastic(E=1.0, rate=GreenNaghdi()),
        Hypoelastic(E=1.0, rate=Jaumann(increment="polar")),
        J2(**METAL, hardening=PowerHardening(modulus=1.0, exponent=0.3)),
        J2(**METAL, flow=Perzyna(drag=1.0, reference=1.0)),
        type("Other", (Hypoelastic,), {})(E=1.0),
    ):
        assert isinstance(inelastic_force(square, law, PlaneStrain()).work, RateArrayEvaluation)
    assert isinstance(inelastic_force(square, LAWS["linear"], PlaneStress()).work, RateArrayEvaluation)
    assert isinstance(inelastic_force(square, LAWS["linear"], PlaneStrain(), "corner").work, RateArrayEvaluation)


def test_cells_of_two_kinds() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.1, 1.0], [0.0, 0.9], [2.0, 0.2]])
    mesh = Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2]])})
    body = inelastic_force(mesh, LAWS["both"], PlaneStrain())
    memory = compare(body, noise(mesh, 0.04), noise(mesh, 1.0, 2))
    compare(body.during(memory, 1.0), noise(mesh, 0.05, 5), noise(mesh, 1.0, 2))


@pytest.mark.parametrize(
    ("cell", "dilatation"),
    [*product(["hex8", "tet4", "quad4"], ["point"]), pytest.param("hex8", "mean", marks=pytest.mark.minutes)],
)
def test_the_bits_do_not_depend_on_the_threads(cell: str, dilatation: Dilating) -> None:
    n = 16 if cell == "hex8" else 18
    mesh = rectangle((3.0, 1.0), cells=(150, 60)) if cell == "quad4" else box((1.0,) * 3, cells=(n, n, n), cell=cell)
    body = inelastic_force(mesh, LAWS["both"], PlaneStrain() if mesh.dim == 2 else Volume(), dilatation)
    cells = body.work.cells
    assert len(cells.blocks[0].starts) - 1 >= 4
    u = noise(mesh, 0.02)
    body, v = body.during(body.committed(u), 1.0), 1.5 * u
    with use(1):
        alone = everything(body, v)
    for number in (2, 3):
        with use(number):
            assert all(np.array_equal(a, b) for a, b in zip(alone, everything(body, v), strict=True))
    compare(body, v, u)


def everything(body: InelasticForce, u: Array) -> list[Array]:
    """Results of all kernels."""
    energy, force = body.energy_and_force(u)
    after, (_, again, _) = body.committed(u), body.stored_force(body.state, u)
    tangent, blocks = body.tangent(u).data, body.tangent_diagonal_blocks(u)
    memory = [after.stress, after.law["plastic_strain"], after.law["back_stress"], after.stored, after.dissipated]
    return [np.array(energy), force, again, tangent, blocks, body.tangent_product(u, force), *memory]


@pytest.mark.few(7)
@pytest.mark.parametrize("dilatation", ["point", "mean"])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_one_inverted_cell_spoils_no_other(law: RateLaw, dilatation: Dilating) -> None:
    mesh = box((3.0, 1.0, 1.0), cells=(3, 1, 1), cell="hex8")
    body = inelastic_force(mesh, law, Volume(), dilatation)
    u = np.zeros_like(mesh.points)
    u[mesh.points[:, 0] > 2.5, 0] = -2.0
    for way in (body, plain(body)):
        energy, force = way.energy_and_force(u)
        assert energy == np.inf
        assert np.array_equal(np.isnan(force).any(axis=1), mesh.points[:, 0] > 1.5)
        assert np.isnan(way.committed(u).stress).any()
        assert np.isnan(way.tangent(u).data).any()
