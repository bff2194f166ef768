"""B07, the normal load: two like cylinders pressed together without friction, Hertz's line contact from mortar forces.

The meshes do not match; the diameters come nearer by a given length, and the load is what the contact then bears.
"""

from dataclasses import dataclass

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.exact.contact import LineContact, contact_modulus
from softway.apps.verify.scenes.pressing import ELASTIC, POISSON, YOUNGS, Footprint, footprint
from softway.arrays import Array
from softway.meshes.generators.recipes import GradedDisc

APPROACH, FOCUS = 0.02, 0.18
PARTS = {"upper": 14, "lower": 10}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pressed:
    """The halves ``upper`` and ``lower`` of two cylinders of radius 1: forces of the contact on the nodes (n, 2) of
    each, and the footprint of the upper one.
    """

    upper: Array
    lower: Array
    foot: Footprint

    @property
    def hertz(self) -> LineContact:
        """Two bodies share radius and modulus: half of both."""
        return LineContact(load=self.upper[:, 1].sum(), radius=0.5, modulus=0.5 * contact_modulus(YOUNGS, POISSON))


@pytest.fixture(scope="module", params=[sw.contact.DualMortar(), None], ids=["mortar", "default"])
def pressed(request: pytest.FixtureRequest) -> Pressed:
    """14 elements along the focus of the upper half, 10 along that of the lower; at the start they overlap deeply."""
    meshes = {name: GradedDisc(radius=1.0, focus=FOCUS, cells=c, part="lower").build() for name, c in PARTS.items()}
    places = {
        "upper": sw.bodies.Placement(translation=(0.0, 1.0 - APPROACH)),
        "lower": sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=np.pi),)),
    }
    supports = (sw.Fixed(on="diameter"),)
    bodies = {
        name: sw.Solid(mesh=mesh, material=ELASTIC, density=1.0, supports=supports, place=places[name])
        for name, mesh in meshes.items()
    }
    contact = sw.Contact(between=("upper.boundary", "lower.boundary"), name="pair", method=request.param, start="fit")
    model = sw.build(sw.Scene(bodies=bodies, contacts=(contact,), start=sw.model.StaticStart()))
    step = next(iter(sw.march(model, until=1e-3, step=1e-3)))
    rows = model.rows(model.join(step.before.displacement))
    push = rows.spread(step.before.pressure["pair"], model.shape)
    upper, lower = (push[p.nodes] for p in model.parts)
    nodes = meshes["upper"].nodes("boundary")
    whole = footprint(meshes["upper"], sw.bodies.PlaneStrain(), upper[nodes, 1])
    return Pressed(upper=upper, lower=lower, foot=whole)


def test_the_forces_balance(pressed):
    assert pressed.upper.sum(axis=0) == pytest.approx(-pressed.lower.sum(axis=0), abs=1e-12 * pressed.upper[:, 1].sum())


def test_the_pressure_is_that_of_hertz(pressed):
    """The case is of one body with a rigid one or of two like ones: the ellipse is the same."""
    hertz, foot = pressed.hertz, pressed.foot
    peak, width = foot.fitted
    assert peak == pytest.approx(hertz.peak, rel=0.01)
    assert width == pytest.approx(hertz.half_width, rel=0.01)
    missed = np.abs(foot.pressure - hertz.pressure(np.abs(foot.place))) / hertz.peak
    assert missed[np.abs(foot.place) < 0.5 * hertz.half_width].max() < 0.006
    assert missed.max() < 0.1


def test_nothing_slips_to_one_side(pressed):
    assert pressed.foot.pressure == pytest.approx(pressed.foot.pressure[::-1], abs=1e-9 * pressed.foot.pressure.max())
