"""The number of layers that take the mass of contact nodes: what a wider layer gains and costs."""

import numpy as np
import pytest
from scipy.linalg import eigh

import softway as sw
from softway.arrays import Array
from softway.bodies.elements.section import Bar
from softway.bodies.inertia.mass_matrix import Consistent, nodal_mass
from softway.bodies.inertia.mass_redistribution import redistribute_mass
from softway.meshes.generators.shapes import interval

CELLS = 100


def frequencies(mass: Array) -> Array:
    """First four frequencies [rad/s] of a free bar of unit length and wave speed; its last node may have no mass."""
    stiffness = CELLS * (2.0 * np.eye(CELLS + 1) - np.eye(CELLS + 1, k=1) - np.eye(CELLS + 1, k=-1))
    stiffness[0, 0] = stiffness[-1, -1] = CELLS
    if not mass[-1].any():
        stiffness = stiffness[:-1, :-1] - np.outer(stiffness[:-1, -1], stiffness[-1, :-1]) / stiffness[-1, -1]
        mass = mass[:-1, :-1]
    return np.sqrt(np.abs(eigh(stiffness, mass, eigvals_only=True)[1:5]))


@pytest.mark.parametrize("spread", [10, 22, 50])
def test_a_wider_layer_shifts_the_frequencies_of_a_bar(spread: int) -> None:
    """By half the change of the kinetic energy of the mode (docs/theory/contact/overshoot.md)."""
    mesh = interval(1.0, CELLS)
    plain = nodal_mass(mesh, 1.0, Bar(), Consistent()).toarray()
    moved = redistribute_mass(mesh, 1.0, Bar(), Consistent(), np.array([CELLS]), spread).toarray()
    shift = frequencies(moved) / frequencies(plain) - 1.0
    turns = 2.0 * np.arange(1, 5) * spread / CELLS
    np.testing.assert_allclose(shift, (2.0 / 3.0) / (2.0 * CELLS) * (1.0 - np.sinc(turns)), rtol=0.15)


@pytest.mark.parametrize(("spread", "most"), [(5, 1.075), (25, 1.02)])
def test_a_wider_layer_lowers_the_first_peak(spread: int, most: float) -> None:
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=CELLS),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0, normal=-1.0))
    timing = sw.contact.Energy(spread=spread)
    contact = sw.Contact(between=("bar.right", "wall"), timing=timing)
    model = sw.build(sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,)))
    steps = list(sw.march(model, until=1.0))
    momentum = np.array([1.0, *((model.mass @ s.after.velocity["bar"]).sum() for s in steps)])
    force = -np.diff(momentum) / np.diff([0.0, *(s.after.time for s in steps)])
    assert 1.0 + 1.0 / (3.0 * spread) - 0.002 <= force.max() <= most
