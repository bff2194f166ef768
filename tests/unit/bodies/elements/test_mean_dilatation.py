"""Means of the change of volume: forces from an energy, exact tangents, no locking."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, Section, Volume
from softway.bodies.internal_force.assembled import force_of
from softway.errors import InputError
from softway.marching.start.initial_state import initial_state

MESHES = {
    "hex8": (sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 1, 1)), Volume()),
    "quad4": (sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), PlaneStrain()),
    "tri6": (sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2), cell="tri6"), PlaneStrain()),
    "round": (sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2), cell="quad9"), Axisymmetric()),
}


@pytest.mark.parametrize("dilatation", ["mean", "corner"])
@pytest.mark.parametrize("case", MESHES)
@pytest.mark.parametrize("law", [sw.NeoHookean(E=1.0, nu=0.4), sw.LinearElastic(E=1.0, nu=0.4)], ids=["large", "small"])
def test_forces_have_an_energy_and_tangents_are_their_slopes(case: str, dilatation: str, law: object) -> None:
    source, section = MESHES[case]
    mesh = source.build()
    body = force_of(mesh, law, section, dilatation)
    rng = np.random.default_rng(1)
    u = 0.02 * rng.standard_normal(mesh.points.shape) * np.minimum(mesh.points[:, :1], 0.3)
    w = rng.standard_normal(u.shape)
    h = 1e-6
    slope = (body.energy(u + h * w) - body.energy(u - h * w)) / (2.0 * h)
    assert np.sum(body.force(u) * w) == pytest.approx(slope, rel=1e-7)
    change = (body.force(u + h * w) - body.force(u - h * w)) / (2.0 * h)
    np.testing.assert_allclose(body.tangent_product(u, w), change, atol=1e-7 * np.abs(change).max())
    assert abs(body.tangent(u) - body.tangent(u).T).max() < 1e-12 * abs(body.tangent(u)).max()


@pytest.mark.parametrize("case", MESHES)
def test_homogeneous_strain_is_the_same_at_points_cells_and_corners(case: str) -> None:
    source, section = MESHES[case]
    mesh = source.build()
    u = mesh.points * np.array([0.1, -0.05, 0.02])[: mesh.dim]
    if isinstance(section, Axisymmetric):
        u = mesh.points * np.array([0.1, -0.05])
    law = sw.NeoHookean(E=1.0, nu=0.4)
    plain, *others = (force_of(mesh, law, section, d) for d in ("point", "mean", "corner"))
    for other in others:
        assert other.energy(u) == pytest.approx(plain.energy(u), rel=1e-13)
        np.testing.assert_allclose(other.stress(u), plain.stress(u), atol=1e-14)


def corner_of_cook(cell: str, n: int, nu: float, dilatation: str) -> float:
    """Deflection of the upper corner of Cook's membrane in plane strain, E = 250, resultant 100."""
    flat = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(n, n), cell=cell).build()
    x, y = flat.points.T
    points = np.column_stack([48.0 * x, 44.0 * y * (1.0 - x) + x * (44.0 + 16.0 * y)])
    body = sw.Solid(
        mesh=sw.Mesh(points=points, blocks=flat.blocks, tags=flat.tags),
        material=sw.LinearElastic(E=250.0, nu=nu),
        density=1.0,
        dilatation=dilatation,
        supports=(sw.Fixed(on="left"),),
    )
    loads = (sw.Traction(on="b.right", value=(0.0, 100.0 / 16.0)),)
    at = initial_state(sw.build(sw.Scene(bodies={"b": body}, loads=loads, start=sw.model.StaticStart())))
    return float(at.start.displacement[np.argmin(np.abs(points - [48.0, 60.0]).sum(axis=1)), 1])


@pytest.mark.few(3)
@pytest.mark.parametrize("nu", [0.4999, 0.5])
@pytest.mark.parametrize("cell", ["tri6", "quad8", "quad9"])
def test_taylor_and_hoods_cells_do_not_lock(cell: str, nu: float) -> None:
    assert corner_of_cook(cell, 8, nu, "corner") == pytest.approx(7.77, rel=0.02)
    assert corner_of_cook(cell, 16, nu, "corner") == pytest.approx(7.77, rel=0.01)


def test_plain_cells_lock() -> None:
    assert corner_of_cook("quad4", 16, 0.4999, "point") < 0.4 * 7.77
    assert corner_of_cook("quad4", 16, 0.4999, "mean") == pytest.approx(7.77, rel=0.025)


def test_incompressible_material_needs_the_mean_dilatation() -> None:
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1))
    with pytest.raises(InputError, match=r"material\.nu: nu = 0\.5 with the volume change"):
        sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.5), density=1.0)


@pytest.mark.parametrize("section", [sw.bodies.PlaneStress(), sw.bodies.Bar()], ids=lambda s: type(s).__name__)
def test_free_faces_refuse_means(section: Section) -> None:
    mesh = (
        sw.meshes.Interval(length=1.0, cells=1)
        if isinstance(section, sw.bodies.Bar)
        else sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1))
    )
    body = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0, section=section, dilatation="mean")
    with pytest.raises(InputError, match="dilatation: 'mean' with the section"):
        sw.build(sw.Scene(bodies={"b": body}))


def test_quadratic_cells_refuse_one_mean_for_all() -> None:
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1), cell="quad9")
    body = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.4), density=1.0, dilatation="mean")
    with pytest.raises(InputError, match=r"b\.dilatation: 'mean' with quadratic elements"):
        sw.build(sw.Scene(bodies={"b": body}))
