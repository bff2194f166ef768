"""Increments of motion: rotations leave no strain, volumes come back, maps belong together."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.internal_force.inelastic.inelastic_force import inelastic_force
from softway.bodies.internal_force.inelastic.slab_kinematics import (
    half_turn,
    logarithm,
    logarithmic_extra,
    push_forward,
    slab_deformation,
)
from softway.kernels.linalg import tensors
from softway.laws.objective_rates import GreenNaghdi, Jaumann, Logarithmic, Truesdell

RATES = [Jaumann(), Jaumann(increment="polar"), GreenNaghdi(), Logarithmic(), Truesdell()]
RANDOM = np.random.default_rng(7)


def turns(angle: Array) -> Array:
    """Rotations (k, 3, 3) by angles (k,) about random axes."""
    axis = RANDOM.normal(size=(len(angle), 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    W = np.zeros((len(angle), 3, 3))
    W[:, [2, 0, 1], [1, 2, 0]], W[:, [1, 2, 0], [2, 0, 1]] = axis, -axis
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * W + (1.0 - c) * W @ W


def deformed(size: float, k: int = 20) -> Array:
    """Deformation gradients (k, 3, 3)."""
    return np.eye(3) + size * RANDOM.uniform(-1.0, 1.0, (k, 3, 3))


@pytest.mark.parametrize("rate", RATES)
def test_a_rigid_rotation_is_no_strain(rate) -> None:
    """Of any angle below half a turn, of a body as it is deformed; tensors of the material turn with it."""
    F0, Q = deformed(0.3), turns(np.linspace(0.0, 0.97 * np.pi, 20))
    found = slab_deformation(rate, F0, Q @ F0)
    assert np.abs(found.strain).max() < 1e-13
    s = tensors.symmetric(deformed(1.0))
    end = push_forward(push_forward(s, found.first, rate), found.second, rate)
    np.testing.assert_allclose(end, Q @ s @ np.swapaxes(Q, 1, 2), rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("rate", RATES)
def test_the_trace_is_the_change_of_volume(rate) -> None:
    F0, F1 = deformed(0.25), deformed(0.25)
    found = slab_deformation(rate, F0, F1)
    exact = np.log(np.linalg.det(F1) / np.linalg.det(F0))
    np.testing.assert_allclose(tensors.trace(found.strain), exact, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("rate", RATES)
def test_the_reverse_deformation_has_the_inverse_map(rate) -> None:
    """The strain of the way back, carried, is minus that of the way; maps of corotational rates are rotations."""
    F0, F1 = deformed(0.2), deformed(0.2)
    there, back = slab_deformation(rate, F0, F1), slab_deformation(rate, F1, F0)
    whole = there.second @ there.first
    np.testing.assert_allclose(back.second @ back.first @ whole, [np.eye(3)] * 20, rtol=0.0, atol=1e-12)
    if not isinstance(rate, Truesdell):
        np.testing.assert_allclose(whole @ np.swapaxes(whole, 1, 2), [np.eye(3)] * 20, rtol=0.0, atol=1e-12)
    if rate != Jaumann(increment="polar"):
        np.testing.assert_allclose(back.strain, -there.strain, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("rate", RATES)
def test_strain_and_maps_are_objective(rate) -> None:
    """Both ends turned by one rotation: strain and maps turn."""
    F0, F1, Q = deformed(0.2), deformed(0.2), turns(np.full(1, 2.0))[0]
    plain, turned = slab_deformation(rate, F0, F1), slab_deformation(rate, Q @ F0, Q @ F1)
    np.testing.assert_allclose(turned.strain, Q @ plain.strain @ Q.T, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(turned.first, Q @ plain.first @ Q.T, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(turned.second, Q @ plain.second @ Q.T, rtol=0.0, atol=1e-12)


def test_a_stretch_in_fixed_axes_is_its_logarithm() -> None:
    """The polar increment to rounding, the midpoint to third order of the increment."""
    F0, F1 = np.diag([1.0, 2.0, 0.5]), np.diag([1.1, 2.3, 0.45])
    exact = np.log(np.diag(F1) / np.diag(F0))
    polar = slab_deformation(Jaumann(increment="polar"), F0, F1)
    np.testing.assert_allclose(np.diag(polar.strain), exact, rtol=0.0, atol=1e-14)
    middle = slab_deformation(Jaumann(), F0, F1)
    assert np.abs(np.diag(middle.strain) - exact).max() < np.abs(exact).max() ** 3 / 6.0


def test_the_square_of_the_half_rotation_is_the_rotation() -> None:
    """Cayley's map of the skew part, for any size of it."""
    w = RANDOM.normal(size=(30, 3, 3)) * 10.0 ** RANDOM.uniform(-6, 2, (30, 1, 1))
    w = 0.5 * (w - np.swapaxes(w, 1, 2))
    half = half_turn(w)
    whole = np.linalg.solve(np.eye(3) - 0.5 * w, np.eye(3) + 0.5 * w)
    np.testing.assert_allclose(half @ half, whole, rtol=0.0, atol=1e-11)


def test_logarithm() -> None:
    C = deformed(0.3)
    C = np.swapaxes(C, 1, 2) @ C
    L = logarithm(C)
    values, axes = np.linalg.eigh(L)
    np.testing.assert_allclose((axes * np.exp(values)[:, None]) @ np.swapaxes(axes, 1, 2), C, rtol=1e-12, atol=1e-13)


def test_the_logarithmic_spin() -> None:
    """In its axes the rate of ln V is the stretching, by differences; also where two stretches are nearly equal."""
    for size in (0.3, 1e-4):
        F, L, t = deformed(size, 8), deformed(1.0, 8) - np.eye(3), 1e-5
        D, W = tensors.symmetric(L), 0.5 * (L - np.swapaxes(L, 1, 2))
        spin = W + logarithmic_extra(F, D)

        def stretch(s: float, F: Array = F, L: Array = L) -> Array:
            G = F + s * L @ F
            return 0.5 * logarithm(G @ np.swapaxes(G, 1, 2))

        rate = (stretch(t) - stretch(-t)) / (2.0 * t)
        h = stretch(0.0)
        np.testing.assert_allclose(rate - spin @ h + h @ spin, D, rtol=0.0, atol=1e-8)


def test_inverted_elements_have_no_logarithmic_strain() -> None:
    """The volume ratio is negative: nan, without a warning."""
    found = slab_deformation(Jaumann(), np.eye(3)[None], np.diag([-1.0, 1.0, 1.0])[None] + 1e-3)
    assert np.isnan(found.strain).any()


@pytest.mark.parametrize("dilatation", ["point", "mean"])
def test_closed_paths_leave_no_pressure(dilatation) -> None:
    """Nodes that wander and come back: the pressure is that of the volume, to rounding, however great the slabs."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)).build()
    body = inelastic_force(mesh, sw.J2(E=1.0, nu=0.3, yield_stress=0.02), sw.bodies.PlaneStrain(), dilatation)
    path = 0.08 * RANDOM.uniform(-1.0, 1.0, (6, *mesh.points.shape))
    memory = body.state
    for u in (*path, 0.0 * path[0]):
        memory = body.during(memory, 1.0).committed(u)
    assert memory.law["plastic_strain"].min() > 0.1
    assert np.abs(memory.stress).max() > 0.005
    assert np.abs(tensors.trace(memory.stress)).max() < 1e-14


def test_a_homogeneous_motion_is_one_for_all_points() -> None:
    """The patch test: cells of any shape, with a mean dilatation or without, have one stress, and inner nodes rest."""
    plain = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 2)).build()
    inner = np.flatnonzero(np.abs(plain.points - 0.5).max(axis=1) < 0.1)
    points = plain.points.copy()
    points[inner] += (0.1, -0.08, 0.12)
    mesh = sw.Mesh(points=points, blocks=plain.blocks)
    for dilatation in ("point", "mean"):
        body = inelastic_force(mesh, sw.J2(E=1.0, nu=0.3, yield_stress=0.02), sw.bodies.Volume(), dilatation)
        memory = body.state
        for k in (1, 2, 3):
            H = 0.03 * k * np.array([[1.0, 0.8, 0.0], [-0.3, -0.5, 0.2], [0.0, 0.4, 0.2]])
            now = body.during(memory, 1.0)
            memory = now.committed(points @ H.T)
        assert np.ptp(memory.stress, axis=0).max() < 1e-14
        assert np.abs(now.force(points @ H.T)[inner]).max() < 1e-15
