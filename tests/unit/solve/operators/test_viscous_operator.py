"""Operator of bodies with viscous stresses and massless nodes."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.model.model import Model


def damped_beam(viscosity: float, span: float, touching: str) -> Model:
    """Cantilever of a polymer in a slab of the length ``span``; the nodes of a side may touch a floor far away."""
    beam = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.02, 0.002), cells=(20, 3)),
        material=sw.laws.Kelvin(E=2.7e9, nu=0.35, shear_viscosity=viscosity),
        density=1410.0,
        supports=(sw.Fixed(on="left"),),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.0), normal=(0.0, 1.0)))
    scene = sw.Scene(
        bodies={"beam": beam, "floor": floor}, contacts=(sw.Contact(between=(f"beam.{touching}", "floor")),)
    )
    model = sw.build(scene)
    return replace(model, parts=tuple(replace(p, internal=replace(p.internal, span=span)) for p in model.parts))


def residual_derivative(model: Model, factor: float, free: Array) -> Array:
    """Derivative of the slab's residual, scaled as the operator is: the end weights of viscous forces act on mass.

    Massive rows have the mean force, ``(f0 + f1)/2 + (g1 - g0)/2`` with the viscous part g, and the second term of the
    massless rows passed on to the nodes that they follow; massless rows are in equilibrium at the end.
    """
    part, zero = model.parts[0], np.zeros((len(model.massive), 2))
    K, viscous = part.internal.tangent(zero).toarray(), part.internal.viscous_tangent(zero).toarray()
    massive = np.repeat(model.massive, 2).astype(float)
    follow = np.kron(model.follow.toarray(), np.eye(2))
    extra = massive[:, None] * viscous + follow.T @ ((1.0 - massive)[:, None] * viscous)
    mass = np.kron(model.mass.toarray(), np.eye(2))
    return (mass + factor * (K + extra))[np.ix_(free, free)]


@pytest.mark.parametrize("touching", ["right", "bottom"])
@pytest.mark.parametrize(("viscosity", "span"), [(4e3, 1e-5), (4e3, 1e-6), (4e4, 1e-4), (4e4, 1e-6)])
def test_an_iteration_halves_the_error_of_damped_bodies(viscosity, span, touching):
    """Viscous stresses at nodes without inertia are in the operator, too: without them the radius is .6 to .999."""
    model = damped_beam(viscosity, span, touching)
    factor = 0.5 * span**2
    operator = model.inertia_and_stiffness(np.zeros((len(model.massive), 2)), factor, viscous_factor=1.0).toarray()
    free = np.flatnonzero(np.repeat(model.parts[0].mesh.points[:, 0] > 1e-9, 2))
    assert len(operator) == len(free)
    error = np.eye(len(free)) - np.linalg.solve(operator, residual_derivative(model, factor, free))
    assert np.abs(np.linalg.eigvals(error)).max() < 0.5
    assert np.linalg.eigvalsh(operator).min() > 0.0
