"""Iterations on power-law flow without inertia: the plain fixed point, and those that people use."""

from functools import cache

import numpy as np
import pytest

import softway as sw
from softway.bodies.elements.section import PlaneStrain
from softway.bodies.internal_force.assembled import force_of

POWERS = [0.8, 0.5, 0.3, 0.2]


def channel(m: float) -> sw.Scene:
    """Half of a channel between plates, driven by gravity along it: shear stress y, u = m/(m + 1) (1 - (1 - y)^..)."""
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.2, 1.0), cells=(1, 8)),
        material=sw.laws.NortonHoff(K=1.0, m=m),
        density=1.0,
        dilatation="mean",
        supports=(
            sw.Fixed(on="bottom"),
            sw.Fixed(on="left", components="y"),
            sw.Fixed(on="right", components="y"),
        ),
    )
    return sw.Scene(bodies={"b": body}, loads=(sw.Gravity(acceleration=(1.0, 0.0)),), inertia=sw.bodies.Off())


@cache
def flow(m: float, newton: bool) -> tuple[sw.Step, ...]:
    """Three slabs from rest."""
    solver = sw.Newton() if newton else sw.FixedPoint()
    return tuple(sw.march(channel(m), until=0.03, step=0.01, method=solver))


@pytest.mark.parametrize("newton", [False, True], ids=["fixed point", "newton"])
@pytest.mark.parametrize("m", POWERS)
def test_no_slab_takes_more_than_twenty_iterations(m: float, newton: bool) -> None:
    steps = flow(m, newton)
    assert max(s.report.iterations for s in steps) <= 20
    assert not any(s.report.rejections for s in steps)
    speed = np.diff([s.after.displacement["b"][:, 0].max() for s in steps])[-1] / 0.01
    assert speed == pytest.approx(m / (m + 1.0), rel=0.03)  # Poiseuille's flow on eight cells
    last = steps[-1].ledger
    assert abs(last.energy_error) < 1e-5 * last.work_external  # the forces of a steady flow leave no scalar to close it


@pytest.mark.parametrize("m", POWERS)
def test_the_plain_fixed_point_contracts_by_one_less_m(m: float) -> None:
    """Simple shear under a given shear stress, with the viscosity of the last iterate: log errors shrink by 1 - m."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)).build()
    body = force_of(mesh, sw.laws.NortonHoff(K=1.0, m=m), PlaneStrain(), "point").during(
        force_of(mesh, sw.laws.NortonHoff(K=1.0, m=m), PlaneStrain(), "point").state, 1e-6
    )
    shear = np.column_stack([mesh.points[:, 1], np.zeros(mesh.n_nodes)])
    stress, rate, errors = 2.0, 1.0, []
    for _ in range(6):
        u = rate * 1e-6 * shear
        secant = shear.ravel() @ body.secant(u) @ shear.ravel()
        held = float(np.sum(body.force(u) * shear))
        rate += (stress - held) / (secant * 1e-6)
        errors.append(np.log(rate / stress ** (1.0 / m)))
    for old, new in zip(errors[1:], errors[2:], strict=False):
        assert new / old == pytest.approx(1.0 - m, rel=0.05)


def test_the_frozen_secant_operator_contracts_by_one_less_m_too() -> None:
    """The paper's fixed point: one operator, made of the viscosity of the solution, errors fall by 1 - m."""
    m = 0.5
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)),
        material=sw.laws.NortonHoff(K=1.0, m=m),
        density=1.0,
        supports=(sw.Fixed(on="bottom"), sw.Fixed(on="top", components="y")),
    )
    loads = (sw.Traction(on="b.top", value=(2.0, 0.0)),)
    scene = sw.Scene(bodies={"b": body}, loads=loads, inertia=sw.bodies.Off())
    first = next(iter(sw.march(scene, until=1e-6, step=1e-6, method=sw.Newton())))
    plain = sw.FixedPoint(depth=0, handover=False, tolerance=1e-9, operator=sw.solve.Factored(moduli="secant"))
    second = next(iter(sw.march(scene, until=3e-6, step=1.01e-6, method=plain, state=first.after)))
    speed = second.after.displacement["b"][:, 0].max() - first.after.displacement["b"][:, 0].max()
    assert speed / (second.after.time - first.after.time) == pytest.approx(2.0 ** (1.0 / m), rel=1e-3)
