"""Which bodies share a scalar, which groups turn freely, and how much of a residual is closed along the motion."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies.internal_force.slab_average import EnergyMomentum, SlabForce, Weighted
from softway.model.build import build
from softway.model.model import Model
from softway.solve.equations.end_forces import EndForces
from softway.solve.equations.energy_balance import EnergyClosure, body_groups, close_energy, end_force_closure


def blocks(count: int, contacts: tuple[tuple[str, str], ...], force: SlabForce, held: str = "") -> Model:
    """Blocks of side one in a row, named a, b, c ..., that touch each other; one may be held on its left side."""
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3), origin=(float(k), 0.0)),
            material=sw.NeoHookean(E=1.0, nu=0.3),
            density=1.0,
            force=force,
            supports=(sw.Fixed(on="left"),) if name == held else (),
        )
        for k, name in enumerate("abc"[:count])
    }
    return build(sw.Scene(bodies=bodies, contacts=tuple(sw.Contact(between=pair) for pair in contacts)))


def ends(model: Model, pressure: float = 0.0) -> EndForces:
    """A slab between two random configurations, with the same force in all rows at both ends."""
    u0, u1, v0 = 0.02 * np.random.default_rng(1).normal(size=(3, *model.shape)) * model.free
    (V0, f0), (V1, f1) = model.energy_and_force(u0), model.energy_and_force(u1)
    rows = model.rows(model.displacement)
    push, shear = pressure * rows.near, np.zeros_like(rows.normal)
    return EndForces(
        u0=u0, u1=u1, f0=f0, f1=f1, V0=V0, V1=V1, mean=0.5 * (f0 + f1), v0=v0, rows0=rows, rows1=rows, force0=push,
        force1=push, shear0=shear, shear1=shear,
    )  # fmt: skip


def test_a_body_that_joins_a_group_joins_all_of_it() -> None:
    """Whichever side of a contact it is on: a and b are one group already when c comes to b."""
    for pairs in ((("a.right", "b.left"), ("c.left", "b.right")), (("a.right", "b.left"), ("b.right", "c.left"))):
        model = blocks(3, pairs, Weighted())
        rows = model.rows(model.displacement)
        assert body_groups(model, (rows, rows.near)).tolist() == [0, 0, 0]
        assert body_groups(model, (rows, rows.near & rows.of_contact(0))).tolist() == [0, 0, 1]


@pytest.mark.parametrize("held", ["", "a", "b"])
def test_only_groups_without_any_support_keep_their_spin(held: str) -> None:
    """Supports take the spin of a group: its mean force is completed by the scalar alone."""
    model = blocks(2, (("a.right", "b.left"),), EnergyMomentum(), held)
    e = ends(model, pressure=1e-3)
    found = close_energy(model, e, fallback=False)
    turning = found.mean - e.mean - model.nodal(found.scalar) * (e.f1 - e.f0)
    assert found.scalar[0] == found.scalar[1] != 0.0 and not found.clipped
    assert (np.abs(turning).max() > 1e-6) == (not held)


@pytest.mark.parametrize(("share", "closed"), [(0.005, True), (0.02, False), (0.05, False)])
def test_up_to_a_hundredth_of_the_work_is_closed_along_the_motion(share: float, closed: bool) -> None:
    """What a scalar leaves over that has no work to weigh, relative to the work of the internal forces."""
    model = blocks(1, (), Weighted())
    e = ends(model)
    du = e.u1 - e.u0
    work, left = float(np.sum(e.mean * du)), share * float(np.abs(e.mean * du).sum())
    found = _closed(model, e, _across(e), e.V0 + work + left)
    assert abs(found.scalar[0]) < 1e-9 and found.bounded and found.clipped != closed
    missing = 0.0 if closed else left
    assert work + left - float(np.sum(found.mean * du)) == pytest.approx(missing, abs=1e-15)


def test_what_forces_at_the_end_dissipate_is_missing_from_the_energy() -> None:
    """Kinetic and stored energy grow by the work of the load less this loss; contact forces do none in open gaps."""
    model = blocks(2, (("a.right", "b.left"),), Weighted())
    e, heavy = ends(model, pressure=0.01), model.massive[:, None]
    balanced = model.load + e.rows1.spread(e.force1, model.shape)
    e = replace(e, f1=np.where(heavy, e.f1, balanced))
    found, du = end_force_closure(model, e), e.u1 - e.u0
    kinetic = np.sum((model.load - found.mean) * du * heavy)
    assert found.lost.sum() == pytest.approx(np.sum(model.load * du) - kinetic - np.sum(e.V1 - e.V0), abs=1e-15)
    assert np.abs(e.force1 @ e.rows1.normal_component(du)) > 1e-4


@pytest.mark.parametrize(("units", "scalar"), [(1.0, False), (100.0, True)])
def test_the_work_of_contact_forces_over_the_rounding_of_positions_needs_no_scalar(units: float, scalar: bool) -> None:
    """Great forces that press bodies together do such a work, in units in the last place, though nothing moves."""
    model = blocks(2, (("a.right", "b.left"),), Weighted())
    e = ends(model, pressure=1e3)
    work = model.space.totals(e.mean * (e.u1 - e.u0) * model.massive[:, None])
    extent, force = float(np.abs(model.points + e.u1).max()), 2.0 * float(e.force0.sum())
    noise = units * float(np.finfo(float).eps) * extent * force
    found = close_energy(model, replace(e, V1=e.V0 + work + [noise, 0.0]), fallback=False)
    assert (found.scalar != 0.0).tolist() == [scalar, scalar]


def test_the_mean_force_is_continuous_where_the_derivative_of_the_balance_passes_zero() -> None:
    """At a load of buckling the forces of both ends do the same work; the missing work is closed on either side."""
    model = blocks(1, (), Weighted())
    e = ends(model)
    du = e.u1 - e.u0
    across, work = _across(e), float(np.sum(e.mean * du))
    left = 0.004 * float(np.abs(e.mean * du).sum())
    along = left / float(np.sum(du * du)) * du
    found = [_closed(model, e, across + s * along, e.V0 + work + left) for s in np.linspace(-4.0, 4.0, 1601)]
    scalars = np.array([f.scalar[0] for f in found])
    assert (scalars.min(), scalars.max()) == pytest.approx((-0.5, 0.5))
    assert np.abs(np.diff(scalars)).max() == pytest.approx(0.25 * 0.005, rel=0.01)
    forces = np.array([f.mean for f in found])
    assert np.abs(np.diff(forces, axis=0)).max() < 0.01 * np.abs(across).max()
    np.testing.assert_allclose(np.sum(forces * du, axis=(1, 2)), work + left, rtol=1e-12)
    assert not any(f.clipped for f in found)


@pytest.mark.parametrize("share", [0.005, 0.02])
def test_no_scalar_closes_a_balance_of_equal_end_forces(share: float) -> None:
    """Their derivative is exactly zero: the missing work is told, and closed along the motion where it is slight."""
    model = blocks(1, (), Weighted())
    e = ends(model)
    du = e.u1 - e.u0
    work, left = float(np.sum(e.mean * du)), share * float(np.abs(e.mean * du).sum())
    found = _closed(model, e, np.zeros_like(du), e.V0 + work + left)
    assert found.scalar[0] == 0.0 and found.bounded and found.clipped == (share > 0.01)
    missing = left if found.clipped else 0.0
    assert work + left - float(np.sum(found.mean * du)) == pytest.approx(missing, abs=1e-15)


def _closed(model: Model, e: EndForces, swing: np.ndarray, V1: np.ndarray) -> EnergyClosure:
    """Closure with a difference ``swing`` (n, d) of the forces at both ends around their mean."""
    return close_energy(model, replace(e, f0=e.mean - 0.5 * swing, f1=e.mean + 0.5 * swing, V1=V1), fallback=False)


def _across(e: EndForces) -> np.ndarray:
    """Difference (n, d) of the forces at both ends without its part that does work."""
    du, swing = e.u1 - e.u0, e.f1 - e.f0
    return swing - du * np.sum(swing * du) / np.sum(du * du)
