"""Force per area of the present surface around each node."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.setup.loads import traction_force
from softway.contact.surfaces.nodal_tractions import TractionMap, traction_map

FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))


def tractions(*tags: str) -> tuple[np.ndarray, TractionMap]:
    """Points of a square of four by four cells, and the map of contacts of some of its tags with a floor each."""
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)), material=sw.LinearElastic(E=1.0), density=1.0
    )
    floors = {f"floor{k}": FLOOR for k in range(len(tags))}
    contacts = tuple(sw.Contact(between=(f"square.{tag}", name)) for tag, name in zip(tags, floors, strict=True))
    model = sw.build(sw.Scene(bodies={"square": solid, **floors}, contacts=contacts))
    return model.points, traction_map(contacts, model.parts)


@pytest.mark.parametrize("tags", [("bottom",), ("surface",), ("bottom", "surface"), ("surface", "bottom", "bottom")])
def test_a_surface_of_several_contacts_has_its_area_once(tags: tuple[str, ...]) -> None:
    """Forces that a pressure of 3 Pa has on the inner nodes of the bottom, which is stretched to twice its length."""
    x, found = tractions(*tags)
    inner = np.flatnonzero((x[:, 1] == 0.0) & (x[:, 0] > 0.0) & (x[:, 0] < 1.0))
    force = np.zeros((len(x), 1))
    force[inner] = 3.0 * 2.0 / 4.0
    assert found.at(x * [1.0, 0.0], force)[inner, 0] == pytest.approx(np.full(3, 3.0), rel=1e-12)


def test_a_uniform_pressure_on_eight_node_facets_is_found_at_every_node() -> None:
    """Corners carry forces against the pressure."""
    mesh = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3), cell="hex20").build()
    solid = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)))
    contacts = (sw.Contact(between=("cube.bottom", "floor")),)
    model = sw.build(sw.Scene(bodies={"cube": solid, "floor": floor}, contacts=contacts))
    bottom = mesh.nodes("bottom")
    force = traction_force(mesh, sw.bodies.Volume(), "bottom", (0.0, 0.0, 3.0))[:, 2:]
    assert force[bottom].min() < 0.0
    found = traction_map(contacts, model.parts).at(np.zeros_like(mesh.points), force)
    assert found[bottom, 0] == pytest.approx(np.full(len(bottom), 3.0), rel=1e-12)
