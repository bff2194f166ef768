"""Memory of the matter: children inherit, parents take means by volume, totals stay."""

import numpy as np
import pytest
from turning import balances, on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.memory import inheritance, remembered
from softway.adaptivity.transfer import Motion, transfer
from softway.bodies.internal_force.material_state import MaterialState
from softway.meshes.generators.shapes import interval, rectangle

LAW = sw.J2(E=100.0, nu=0.3, yield_stress=0.5, hardening=sw.laws.LinearHardening(modulus=10.0))


def stretched(on: AdaptedSolid) -> tuple[np.ndarray, MaterialState]:
    """Displacement beyond yield in a part of the body, and the state that it leaves."""
    x = on.points
    u = 0.02 * x[:, :1] ** 2 * np.eye(x.shape[1])[0]
    internal = on.part.internal
    state = internal.during(internal.state, 1.0).committed(u)
    assert state is not None
    return u, state


def total(on: AdaptedSolid, values: np.ndarray) -> np.ndarray:
    return np.einsum("p,p...->...", on.part.internal.sampling.volume, values)


@pytest.mark.parametrize("cell", ["tri3", "tri6"])
def test_totals_stay(cell: str) -> None:
    body = solid(rectangle((1.0, 1.0), (3, 3), cell=cell), LAW)
    rng = np.random.default_rng(1)
    before, after = (on_levels(body, rng.integers(0, 4, body.mesh.n_cells)) for _ in range(2))
    u, state = stretched(before)
    found = remembered(before, after, state, np.zeros(after.points.shape))
    for name in ("stress", "stored", "dissipated"):
        old, new = total(before, getattr(state, name)), total(after, getattr(found, name))
        assert new == pytest.approx(old, abs=1e-13 * abs(total(before, abs(getattr(state, name)))).max())
    for name, values in state.law.items():
        assert total(after, found.law[name]) == pytest.approx(total(before, values), abs=1e-13 * abs(values).max())
    assert found.dissipated.max() <= state.dissipated.max()


def test_children_inherit_and_come_back() -> None:
    body = solid(rectangle((1.0, 1.0), (3, 3), cell="tri3"), LAW)
    before, after = on_levels(body, np.full(18, 1)), on_levels(body, np.full(18, 4))
    u, state = stretched(before)
    down = remembered(before, after, state, np.zeros(after.points.shape))
    back = remembered(after, before, down, u)
    assert back.stress == pytest.approx(state.stress, rel=1e-14, abs=1e-14)
    assert back.dissipated == pytest.approx(state.dissipated, rel=1e-14)


def test_equal_leaves_keep_every_point() -> None:
    body = solid(rectangle((1.0, 1.0), (2, 2), cell="tri6"), LAW)
    before = on_levels(body, np.full(8, 2))
    u, state = stretched(before)
    again = remembered(before, before, state, u)
    assert np.array_equal(again.stress, state.stress)


def test_means_never_raise_a_quadratic_energy() -> None:
    mesh = interval(1.0, cells=4)
    fine, coarse = on_levels(solid(mesh), np.full(4, 3)), on_levels(solid(mesh), np.array([0, 1, 2, 3]))
    volume = fine.part.internal.sampling.volume
    values = np.random.default_rng(2).normal(size=len(volume))
    found = inheritance(fine.adapted.leaves, coarse.adapted.leaves, volume).of(values)
    assert coarse.part.internal.sampling.volume @ found**2 <= volume @ values**2
    assert coarse.part.internal.sampling.volume @ found == pytest.approx(volume @ values, abs=1e-14)


def test_regions_keep_to_themselves() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3")
    mesh = mesh.with_region("soft", lambda x: x[:, 0] < 0.5).with_region("hard", lambda x: x[:, 0] > 0.5)
    body = solid(mesh, {"soft": LAW, "hard": sw.NeoHookean(E=100.0, nu=0.3)})
    before, after = on_levels(body, np.full(32, 3)), on_levels(body, np.full(32, 1))
    u, state = stretched(before)
    motion = Motion(displacement=u, velocity=np.cos(2.0 * before.points), state=state)
    found = transfer(before, after, motion)
    assert found.motion.state is not None
    assert set(found.motion.state.regions) == {"soft"}
    old, new = balances(before, motion), balances(after, found.motion)
    assert new.energy == pytest.approx(old.energy, rel=1e-12)
    assert new.momentum == pytest.approx(old.momentum, abs=1e-12 * old.momenta)


def test_a_plastic_body_goes_on_from_its_memory() -> None:
    body = solid(rectangle((1.0, 1.0), (4, 4), cell="tri3"), LAW)
    before, after = on_levels(body, np.full(32, 4)), on_levels(body, np.full(32, 2))
    u, state = stretched(before)
    motion = Motion(displacement=u, velocity=np.cos(2.0 * before.points), state=state)
    found = transfer(before, after, motion)
    assert found.motion.state is not None
    assert np.array_equal(found.motion.state.displacement, found.motion.displacement)
    internal = after.part.internal.during(found.motion.state, 0.01)
    energy, force = internal.energy_and_force(found.motion.displacement)
    assert energy == pytest.approx(
        after.part.internal.stored_force(found.motion.state, found.motion.displacement)[0], rel=1e-12
    )
    assert np.isfinite(force).all()
