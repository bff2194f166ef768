"""Bodies of several materials in a march: one law under two names is one law, the ledger closes, runs continue."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import softway as sw
from softway.bodies.bulk_viscosity import BulkViscosity
from softway.bodies.elements.section import PlaneStrain
from softway.bodies.internal_force.assembled import internal_force
from softway.bodies.internal_force.materials import materials_of
from softway.record.storage.serialisation import packed, unpacked

HALVES = sw.meshes.Divided(
    mesh=sw.meshes.Rectangle(size=(1.0, 0.6), cells=(5, 4)),
    regions={"low": sw.meshes.InBox(high=(2.0, 0.3)), "tip": sw.meshes.InBall(centre=(1.0, 0.6), radius=0.25)},
    rest="high",
)
NAMES = ("low", "tip", "high")
FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
NEO = sw.NeoHookean(E=1.0, nu=0.3)
J2 = sw.J2(E=1.0, nu=0.3, yield_stress=0.02)
KELVIN = sw.laws.Kelvin(E=1.0, nu=0.3, shear_viscosity=0.01)


def scene(material: object, timing: object = None, **given: object) -> sw.Scene:
    """Turning block that falls on a floor."""
    density, mesh = given.pop("density", 1.0), given.pop("mesh", HALVES)
    block = sw.Solid(
        mesh=mesh,
        material=material,
        density=density,
        velocity=sw.bodies.Affine(value=(0.05, -0.2), gradient=((0.0, -0.2), (0.2, 0.0))),
        place=sw.bodies.Placement(bottom=0.01),
        **given,
    )
    timing = sw.contact.Energy() if timing is None else timing
    contact = sw.Contact(between=("block.surface", "floor"), timing=timing)
    return sw.Scene(bodies={"block": block, "floor": FLOOR}, contacts=(contact,))


def marched(given: sw.Scene, slabs: int = 12, **settings: object) -> list:
    """Steps of a march of some slabs."""
    return list(sw.march(sw.build(given), until=slabs * 0.02, step=0.02, **settings))


CASES = {
    "elastic": (NEO, {}, {}),
    "linear": (sw.LinearElastic(E=1.0, nu=0.3), {}, {}),
    "plastic": (J2, {}, {}),
    "mean": (J2, {"dilatation": "mean"}, {}),
    "shock": (NEO, {"shock": BulkViscosity()}, {}),
    "average field": (sw.laws.StVenantKirchhoff(E=1.0, nu=0.3), {"force": sw.bodies.AverageField()}, {}),
    "discrete gradient": (NEO, {"force": sw.bodies.DiscreteGradient()}, {}),
    "energy and momentum": (NEO, {"force": sw.bodies.EnergyMomentum()}, {}),
    "viscous": (KELVIN, {}, {}),
    "explicit": (J2, {"mass": sw.bodies.Lumped()}, {"method": sw.Explicit()}),
    "matrix-free": (NEO, {}, {"method": sw.FixedPoint(operator=sw.solve.MatrixFree())}),
    "newton": (J2, {}, {"method": sw.Newton()}),
    "impulse": (NEO, {"timing": sw.contact.Impulse()}, {}),
}


@pytest.mark.few(5)
@pytest.mark.parametrize("case", CASES)
def test_one_law_under_several_names_is_the_body_of_one_law(case: str) -> None:
    law, solid, settings = CASES[case]
    one = marched(scene(law, **solid), **settings)
    several = marched(scene(dict.fromkeys(NAMES, law), **solid), **settings)
    assert len(one) == len(several)
    for a, b in zip(one, several, strict=True):
        assert np.abs(a.after.displacement["block"] - b.after.displacement["block"]).max() < 1e-11
        assert a.ledger.energy_strain == pytest.approx(b.ledger.energy_strain, abs=1e-12)
        assert a.ledger.dissipation == pytest.approx(b.ledger.dissipation, abs=1e-12)
    assert any(closed.any() for step in one for closed in step.after.closed.values())


@pytest.mark.parametrize("method", [sw.FixedPoint(), sw.Explicit()])
def test_an_elastic_and_a_plastic_region_close_the_ledger(method: object) -> None:
    laws = {"low": J2, "tip": sw.LinearElastic(E=4.0, nu=0.2), "high": NEO}
    mass = sw.bodies.Lumped() if isinstance(method, sw.Explicit) else sw.bodies.Consistent()
    given = scene(laws, density={"low": 1.0, "tip": 5.0, "high": 2.0}, mass=mass)
    model, steps = sw.build(given), marched(given, slabs=60, method=method)
    start = steps[0].ledger.energy_kinetic
    assert steps[-1].ledger.dissipation > 1e-3 * start
    if isinstance(method, sw.FixedPoint):
        assert max(abs(step.ledger.energy_error) for step in steps) < 1e-11 * start
    internal, last = model.parts[0].internal, steps[-1].after
    memory, u = last.memory["block"], last.displacement["block"]
    found = internal.stored_scalars(memory)
    mesh = model.parts[0].mesh
    assert set(memory.regions) == {"low"}
    assert found["plastic_strain"][mesh.cells("low")].max() > 1e-3
    assert found["plastic_strain"][np.setdiff1d(mesh.cells("all"), mesh.cells("low"))].max() == 0.0
    assert internal.dissipated_energy(memory) == pytest.approx(steps[-1].ledger.dissipation, rel=1e-9)
    assert internal.stored_energy(memory, 0.0) == pytest.approx(internal.stored_force(memory, u)[0], rel=1e-12)
    owner = found["material"]
    assert [owner[mesh.cells(name)].tolist()[0] for name in laws] == [1.0, 2.0, 3.0]


def test_tangent_force_and_energy_of_regions_agree() -> None:
    mesh = HALVES.build()
    laws = {"low": NEO, "tip": sw.laws.StVenantKirchhoff(E=3.0, nu=0.2), "high": sw.LinearElastic(E=2.0)}
    body = internal_force(mesh, materials_of(mesh, laws, 1.0), PlaneStrain(), "point")
    rng = np.random.default_rng(1)
    u, w = 0.01 * rng.standard_normal(mesh.points.shape), rng.standard_normal(mesh.points.shape)
    matrix, step = body.tangent(u), 1e-6
    slope = (body.force(u + step * w) - body.force(u - step * w)) / (2.0 * step)
    assert np.abs(body.tangent_product(u, w) - slope).max() < 1e-6 * np.abs(slope).max()
    assert np.abs((matrix @ w.ravel()).reshape(w.shape) - slope).max() < 1e-6 * np.abs(slope).max()
    work = (body.energy(u + step * w) - body.energy(u - step * w)) / (2.0 * step)
    assert work == pytest.approx(float((body.force(u) * w).sum()), rel=1e-5)
    blocks = body.tangent_diagonal_blocks(u)
    n, d = w.shape
    dense = matrix.toarray().reshape(n, d, n, d)
    assert np.abs(blocks - dense[np.arange(n), :, np.arange(n)]).max() < 1e-12
    assert np.array_equal(body.tangent(0.0 * u).indices, matrix.indices)
    assert np.array_equal(body.secant(u).indptr, matrix.indptr)


def test_a_march_continues_from_any_slab_with_the_same_bits() -> None:
    given = scene({"low": J2, "tip": NEO, "high": KELVIN})
    whole = marched(given, slabs=24)
    state = unpacked(*packed(whole[11].march_state))
    rest = list(sw.march(sw.build(given), until=0.48, step=0.02, state=state))
    assert len(rest) == 12
    for a, b in zip(whole[12:], rest, strict=True):
        assert np.array_equal(a.after.displacement["block"], b.after.displacement["block"])
        assert np.array_equal(a.after.velocity["block"], b.after.velocity["block"])
        assert a.ledger.energy_strain == b.ledger.energy_strain


def test_two_bodies_of_several_materials_touch() -> None:
    """Blocks of soft and stiff layers meet: momentum and energy are kept."""
    laws = {"low": sw.LinearElastic(E=1.0, nu=0.3), "tip": NEO, "high": sw.NeoHookean(E=5.0, nu=0.2)}
    density = {"low": 1.0, "tip": 1.0, "high": 3.0}
    one = sw.Solid(mesh=HALVES, material=laws, density=density, velocity=sw.bodies.Uniform(value=(0.0, 0.1)))
    other = replace(one, velocity=sw.bodies.Uniform(), place=sw.bodies.Placement(translation=(0.13, 0.605)))
    contact = sw.Contact(between=("one.top", "other.bottom"))
    steps = marched(sw.Scene(bodies={"one": one, "other": other}, contacts=(contact,)), slabs=40)
    start = steps[0].ledger
    assert max(abs(step.ledger.energy_error) for step in steps) < 1e-11 * start.energy_kinetic
    for before, after in pairwise(steps):
        assert np.abs(after.ledger.momentum - before.ledger.momentum).max() < 1e-12
    assert any(after.after.closed["one.top-other.bottom"].any() for after in steps)


@pytest.mark.slow
def test_averages_of_the_volume_change_end_at_the_interface() -> None:
    """A nearly incompressible layer on a soft one, with linear pressures in each region: the ledger closes."""
    laws = {"low": sw.NeoHookean(E=1.0, nu=0.499), "tip": NEO, "high": sw.LinearElastic(E=0.5, nu=0.1)}
    mesh = replace(HALVES, mesh=sw.meshes.Rectangle(size=(1.0, 0.6), cells=(5, 4), cell="quad9"))
    steps = marched(scene(laws, dilatation="corner", mesh=mesh), slabs=12)
    start = steps[0].ledger.energy_kinetic
    assert max(abs(step.ledger.energy_error) for step in steps) < 1e-11 * start
    assert any(closed.any() for step in steps for closed in step.after.closed.values())
