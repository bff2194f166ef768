"""The fused kernels against the arrays of NumPy."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal
from itertools import product

import numpy as np
import pytest
from numba import njit
from scipy.spatial.transform import Rotation

from softway.arrays import Array
from softway.bodies.elements.quadrature import Dilating
from softway.bodies.elements.section import Axisymmetric, Bar, PlaneStrain, PlaneStress, Section, Volume
from softway.bodies.internal_force.elastic.array_evaluation import ArrayEvaluation
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce, elastic_force
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.kernels.fused import elastic
from softway.kernels.jit.elementary import exp, inverse_cube_root, log1p
from softway.kernels.jit.lanes import LANES
from softway.kernels.jit.simd import load, store
from softway.kernels.jit.threads import share, threads, use
from softway.laws.bulk import LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.law import StoredEnergy
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh
from softway.testing.elements import irregular_patch

LAWS = [LinearElastic(E=2.0, nu=0.3), StVenantKirchhoff(E=2.0, nu=0.3), NeoHookean(E=2.0, nu=0.45)]
SOFT = LAWS[2]
FLAT = ["tri3", "tri6", "quad4", "quad8", "quad9"]
SOLID = ["tet4", "tet10", "hex8", "hex20", "hex27"]
BODIES: list[tuple[str, Section]] = [
    *product(FLAT, [PlaneStrain(thickness=0.5), Axisymmetric()]),
    *product(SOLID, [Volume()]),
]
EVERY = [
    pytest.param(law, cell, section, id=f"{type(law).__name__}-{type(section).__name__}-{cell}")
    for law, (cell, section) in product(LAWS, BODIES)
]


def noise(mesh: Mesh, size: float, seed: int = 1) -> Array:
    """Random nodal displacements, a fraction of the least edge; none in x on the line x = 0."""
    u = size * mesh.edge() * np.random.default_rng(seed).standard_normal(mesh.points.shape)
    u[mesh.points[:, 0] < 1e-12, 0] = 0.0
    return u


def states(mesh: Mesh, section: Section, law: StoredEnergy) -> list[Array]:
    """Displacements of every size, and a large rotation where it is a motion of the body."""
    found = [np.zeros_like(mesh.points), noise(mesh, 1e-9), noise(mesh, 1e-4), noise(mesh, 0.04)]
    if not isinstance(section, Axisymmetric):
        turn = Rotation.from_rotvec([0.0, 0.0, 2.5] if mesh.dim == 2 else [1.0, -2.0, 0.5]).as_matrix()
        found.append(mesh.points @ (turn[: mesh.dim, : mesh.dim].T - np.eye(mesh.dim)) + noise(mesh, 0.04))
    return found


def assert_close(value: Array, reference: Array, scale: float) -> None:
    """Equal to the rounding of sums of numbers of a given size."""
    np.testing.assert_allclose(value, reference, rtol=0.0, atol=3e-14 * scale)


@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
def test_kernels_agree_with_arrays(law: StoredEnergy, cell: str, section: Section) -> None:
    mesh = irregular_patch(cell)
    body = elastic_force(mesh, law, section)
    assert isinstance(body.work, KernelEvaluation)
    w = noise(mesh, 1.0, 2)
    for u in states(mesh, section, law):
        compare(body, u, w)


@pytest.mark.parametrize(("law", "cell", "section"), EVERY)
def test_mean_dilatation(law: StoredEnergy, cell: str, section: Section) -> None:
    mesh = irregular_patch(cell)
    body = elastic_force(mesh, law, section, "mean")
    assert isinstance(body.work, KernelEvaluation)
    w = noise(mesh, 1.0, 2)
    for u in states(mesh, section, law):
        compare(body, u, w, 0.05)  # the arrays subtract I from I + H


def compare(body: ElasticForce, u: Array, w: Array, rounded: float = 0.0) -> None:
    """Everything the kernels compute, at the displacement u and its change w; ``rounded`` is the size of numbers whose
    rounding remains where there is no displacement.
    """
    plain = body.plain
    stiffness = plain.tangent(u)
    size = abs(stiffness).max()
    (W, f), (energy, force) = plain.energy_and_force(u), body.energy_and_force(u)
    assert energy == pytest.approx(W, rel=1e-13, abs=1e-13 * rounded * size * (np.abs(u).max() + 1e-16))
    assert_close(force, f, size * (np.abs(u).max() + rounded))
    assert energy == body.energy(u)
    assert np.array_equal(force, body.force(u))
    matrix = body.tangent(u)
    assert np.array_equal(matrix.indices, stiffness.indices)
    assert np.array_equal(matrix.indptr, stiffness.indptr)
    assert_close(matrix.data, stiffness.data, size)
    assert abs(matrix - matrix.T).max() <= 1e-15 * size
    assert_close(body.tangent_product(u, w), plain.tangent_product(u, w), 10.0 * size * np.abs(w).max())
    assert_close(body.tangent_diagonal_blocks(u), plain.tangent_diagonal_blocks(u), size)


def test_other_laws_and_sections_keep_the_arrays() -> None:
    square, line = rectangle((1.0, 1.0), cells=(2, 2)), interval(1.0, cells=2)
    assert isinstance(elastic_force(square, SOFT, PlaneStress()).work, ArrayEvaluation)
    assert isinstance(elastic_force(line, SOFT, Bar()).work, ArrayEvaluation)
    other = type("Other", (NeoHookean,), {})(E=1.0, nu=0.3)
    body = elastic_force(square, other, PlaneStrain())
    assert isinstance(body.work, ArrayEvaluation)
    compare(body, noise(square, 0.04), noise(square, 1.0, 2))


def test_cells_of_two_kinds() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.1, 1.0], [0.0, 0.9], [2.0, 0.2]])
    mesh = Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2]])})
    body = elastic_force(mesh, SOFT, PlaneStrain())
    compare(body, noise(mesh, 0.04), noise(mesh, 1.0, 2))


@pytest.fixture(scope="module", params=["hex8", "tet4", "quad4", "quad4 mean"])
def large(request: pytest.FixtureRequest) -> tuple[ElasticForce, Array]:
    """A body of several parts, moved."""
    cell, _, mean = request.param.partition(" ")
    if cell == "quad4":
        mesh = rectangle((3.0, 1.0), cells=(150, 60))
    else:
        n = 16 if cell == "hex8" else 18
        mesh = box((1.0, 1.0, 1.0), cells=(n, n, n), cell=cell)
    body = elastic_force(mesh, SOFT, PlaneStrain() if mesh.dim == 2 else Volume(), "mean" if mean else "point")
    assert len(body.work.cells.blocks[0].starts) - 1 >= 4
    return body, noise(mesh, 0.02)


def everything(body: ElasticForce, u: Array) -> list[Array]:
    """Results of all kernels."""
    energy, force = body.energy_and_force(u)
    blocks = body.tangent_diagonal_blocks(u)
    return [np.array(energy), force, body.tangent(u).data, body.tangent_product(u, force), blocks]


def test_the_bits_do_not_depend_on_the_threads(large: tuple[ElasticForce, Array]) -> None:
    with use(1):
        alone = everything(*large)
    for number in (2, 3):
        with use(number):
            assert all(np.array_equal(a, b) for a, b in zip(alone, everything(*large), strict=True))


def test_parts_make_up_the_whole(large: tuple[ElasticForce, Array]) -> None:
    body, u = large
    expected = body.plain.tangent(u)
    size = abs(expected).max()
    assert_close(body.tangent(u).data, expected.data, size)
    assert_close(body.force(u), body.plain.energy_and_force(u)[1], size * np.abs(u).max())
    assert_close(body.tangent_product(u, u), (expected @ u.ravel()).reshape(u.shape), 10.0 * size * np.abs(u).max())
    node = np.arange(len(u))
    corner = expected.tocsr()[node * u.shape[1], node * u.shape[1]]
    assert_close(body.tangent_diagonal_blocks(u)[:, 0, 0], np.asarray(corner).ravel(), size)


def test_two_models_at_once(large: tuple[ElasticForce, Array]) -> None:
    body, u = large
    expected = body.force(u), body.force(0.5 * u)
    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(body.force, [u, 0.5 * u] * 6))
    assert all(np.array_equal(f, expected[k % 2]) for k, f in enumerate(found))


@pytest.mark.parametrize("law", LAWS[1:], ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("dilatation", ["point", "mean"])
@pytest.mark.parametrize("cell", ["tri3", "quad4", "tet4", "hex8"])
def test_inverted_elements_have_infinite_energy(cell: str, dilatation: Dilating, law: StoredEnergy) -> None:
    mesh = irregular_patch(cell)
    body = elastic_force(mesh, law, PlaneStrain() if mesh.dim == 2 else Volume(), dilatation)
    u = np.zeros_like(mesh.points)
    u[:, 0] = -2.0 * mesh.points[:, 0]
    assert body.energy(u) == np.inf
    assert np.isnan(body.force(u)).any()
    assert np.isnan(body.tangent(u).data).any()


def test_one_inverted_cell_spoils_no_other() -> None:
    mesh = box((3.0, 1.0, 1.0), cells=(3, 1, 1), cell="hex8")
    body = elastic_force(mesh, SOFT, Volume())
    u = np.zeros_like(mesh.points)
    u[mesh.points[:, 0] > 2.5, 0] = -2.0
    assert body.energy(u) == np.inf
    assert np.array_equal(np.isnan(body.force(u)).any(axis=1), mesh.points[:, 0] > 1.5)


def test_logarithm() -> None:
    """To one unit in the last place, from the smallest number to the largest, and near the ends of its polynomial."""

    @njit
    def logarithms(j, out):  # type: ignore[no-untyped-def]
        for k in range(len(j)):
            out[k] = log1p(j[k], 1.0 / (1.0 + j[k]))

    rng = np.random.default_rng(0)
    powers = 10.0 ** rng.uniform(-307.0, 307.0, 20000)
    shrunk = -(10.0 ** rng.uniform(-307.0, 0.0, 20000))
    ends = np.sqrt([0.5, 2.0])[:, None] * (1.0 + 1e-15 * np.arange(-50, 50)) - 1.0
    special = [0.0, 5e-324, 2.0**-53, 2.0**-52, -(2.0**-54), 2.0**-53 - 1.0, 1.0, -0.5]
    j = np.concatenate([powers, shrunk, rng.uniform(-1.0, 3.0, 20000), ends.ravel(), special])
    j = j[j > -1.0]
    found, expected = np.empty_like(j), np.log1p(j)
    logarithms(j, found)
    assert np.max(np.abs(found - expected) / np.spacing(np.abs(expected))) <= 2.0


def test_exponential() -> None:
    """To two units in the last place, and the ends beyond."""

    @njit
    def exponentials(x, out):  # type: ignore[no-untyped-def]
        for k in range(0, len(x), LANES):
            store(out, k, exp(load(x, k)))

    rng = np.random.default_rng(0)
    x = np.concatenate(
        [rng.uniform(-700.0, 700.0, 8000), rng.uniform(-1.0, 1.0, 8000), [0.0, 5e-324, -1e-17, 1e-9] * 2]
    )
    found = np.empty_like(x)
    exponentials(x, found)
    assert np.max(np.abs(found / np.exp(x) - 1.0)) < 4.5e-16
    exponentials(np.array([-1e9, 1e9] * 4), ends := np.empty(8))
    assert ends[:2].tolist() == pytest.approx([np.exp(-700.0), np.exp(700.0)])


@pytest.mark.slow
def test_inverse_cube_root() -> None:
    """To two units in the last place of the exact root; ``nan`` where the number is not positive."""

    @njit
    def roots(x, out):  # type: ignore[no-untyped-def]
        for k in range(0, len(x), LANES):
            store(out, k, inverse_cube_root(load(x, k)))

    rng = np.random.default_rng(0)
    x = np.concatenate([10.0 ** rng.uniform(-200.0, 200.0, 8000), rng.uniform(0.5, 2.0, 8000), [1.0, 1.0 + 2e-16] * 4])
    found = np.empty_like(x)
    roots(x, found)
    exact = np.array([float(1 / Decimal(float(v)) ** (1 / Decimal(3))) for v in x])
    assert np.max(np.abs(found / exact - 1.0)) < 5e-16
    roots(np.array([0.0, -1.0, np.nan, 8.0] * 2), ends := np.empty(8))
    assert np.isnan(ends[:3]).all()
    assert ends[3] == 0.5


OTHER_PROCESS = """
import numpy as np
from softway.bodies.internal_force.elastic.elastic_force import elastic_force
from softway.bodies.elements.section import Volume
from softway.kernels.fused import elastic
from softway.laws.bulk import NeoHookean
from softway.testing.elements import irregular_patch
for cell in ("tet4", "hex8", "tet4"):
    mesh = irregular_patch(cell)
    body = elastic_force(mesh, NeoHookean(E=1.0, nu=0.3), Volume())
    u = 0.01 * np.sin(np.arange(mesh.points.size)).reshape(mesh.points.shape)
    force, expected = body.force(u), body.plain.energy_and_force(u)[1]
    assert np.abs(force - expected).max() < 1e-13 * np.abs(expected).max(), cell
assert sum(elastic.force.stats.cache_hits.values()) == 1, elastic.force.stats
assert not elastic.force.stats.cache_misses
"""


def test_kernels_on_disk_serve_every_cell() -> None:
    mesh = irregular_patch("hex8")
    elastic_force(mesh, SOFT, Volume()).force(np.zeros_like(mesh.points))
    assert len(elastic.force.signatures) == 1
    ran = subprocess.run(
        [sys.executable, "-W", "error", "-c", OTHER_PROCESS], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert not ran.stdout + ran.stderr


def test_threads_are_chosen_for_a_while() -> None:
    before = threads()
    with use(3):
        assert threads() == 3
        calls: list[tuple[int, int]] = []
        share(lambda first, last: calls.append((first, last)), 9)
        assert sorted(calls) == [(0, 3), (3, 6), (6, 9)]
    assert threads() == before
    with use(2), pytest.raises(ZeroDivisionError):
        share(lambda first, last: 1 // (2 - first), 4)
