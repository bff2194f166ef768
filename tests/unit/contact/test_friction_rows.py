"""Friction of contact rows, on the surface that there is around them."""

import numpy as np
import pytest

import softway as sw
from softway.contact.friction_rows import row_areas, surfaces_of

FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))


@pytest.mark.parametrize("section", [sw.bodies.PlaneStrain(thickness=0.3), sw.bodies.Axisymmetric()], ids=repr)
def test_friction_acts_on_the_area_that_a_stretched_surface_has(section: object) -> None:
    """Tresca's law holds with shear times area: a length grows with the stretch, a disc around an axis with its square.

    The axis is the left side; half of a node's part of the surface belongs to it on either side.
    """
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(2.0, 1.0), cells=(4, 4)),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        section=section,
        supports=(sw.Fixed(on="left", components="x"),),
    )
    contact = sw.Contact(between=("block.bottom", "floor"), friction=sw.laws.Tresca(shear=5.0))
    model = sw.build(sw.Scene(bodies={"block": solid, "floor": FLOOR}, contacts=(contact,)))
    for stretch in (1.0, 1.5):
        u = (stretch - 1.0) * model.points * [1.0, 0.0]
        here = model.friction.at(u)
        area = 0.3 * 2.0 * stretch if isinstance(section, sw.bodies.PlaneStrain) else np.pi * (2.0 * stretch) ** 2
        pressed = np.ones(len(here.area))
        assert here.limit(pressed).sum() == pytest.approx(5.0 * area, rel=1e-12)
        assert here.resistance(pressed, pressed)[0].sum() == pytest.approx(5.0 * area, rel=1e-12)


def test_no_row_of_an_eight_node_facet_has_a_negative_area() -> None:
    """Three by three irregular facets of a unit square: shares of 1/12 for corners and 1/6 for mid-nodes of each."""
    mesh = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 1), cell="hex20").build()
    solid = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), friction=sw.laws.Tresca(shear=5.0))
    model = sw.build(sw.Scene(bodies={"block": solid, "floor": floor}, contacts=(contact,)))
    bent = np.zeros_like(model.points)
    bent[:, 0] = 0.1 * model.points[:, 0] * (1.0 - model.points[:, 0]) * model.points[:, 1]
    assert model.friction.at(bent).limit(np.ones(len(model.friction.area))).sum() == pytest.approx(5.0, rel=1e-12)
    assert row_areas(surfaces_of(contact, model.parts), bent)[mesh.nodes("bottom")].min() > 0.0
    even = row_areas(surfaces_of(contact, model.parts), 0.0 * bent)
    assert even[mesh.nearest((0.0, 0.0, 0.0))] == pytest.approx(1.0 / 9.0 / 12.0, rel=1e-12)
    assert even[mesh.nearest((0.5, 1.0 / 3.0, 0.0))] == pytest.approx(2.0 / 9.0 / 6.0, rel=1e-12)
