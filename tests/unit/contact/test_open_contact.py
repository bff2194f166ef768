"""Open contact: the search leaves out what no row may touch, and what it finds is as without a margin."""

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.loads import Gravity, Load, Traction
from softway.bodies.setup.placement import Placement, Rotation
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact, DualMortar, NodeToSurface
from softway.contact.contact_set import ContactSet
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.laws.friction import Coulomb, Frictionless
from softway.marching.march import march
from softway.meshes.generators.shapes import box, rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace

Way = Literal["nodes", "mortar", "all"]
WAYS = pytest.mark.parametrize("way", ["nodes", "mortar", "all"])


def two(
    way: Way, dim: int, above: float, tilt: float = 0.0, friction: float = 0.0, loads: tuple[Load, ...] = ()
) -> Model:
    """A block ``above`` another one, and a floor at rest under the lower one."""
    low = box((1.0, 1.0, 0.5), (4, 4, 2)) if dim == 3 else rectangle((1.0, 0.5), (4, 2))
    up = tuple(np.eye(dim)[-1].tolist())
    place = Placement(
        rotations=(Rotation(angle=tilt, axis=(0.0, 1.0, 0.0) if dim == 3 else (0.0, 0.0, 1.0)),),
        translation=(*[0.07] * (dim - 1), 0.0),
        bottom=0.5 + above,
    )
    bodies = {
        "low": Solid(mesh=low, material=LinearElastic(E=100.0), density=1.0),
        "high": Solid(mesh=low, material=LinearElastic(E=100.0), density=1.0, place=place),
        "floor": Tool(shape=HalfSpace(point=(0.0,) * dim, normal=up)),
    }
    law = Coulomb(mu=friction) if friction else Frictionless()
    if way == "all":
        between = Contact(between=("low", "low", "high", "high"), name="two", friction=law)
    else:
        method = NodeToSurface(nodes="both") if way == "nodes" else DualMortar()
        between = Contact(between=("low.surface", "high.surface"), name="two", method=method, friction=law)
    floor = Contact(between=("low.bottom", "floor"), name="floor")
    return build(Scene(bodies=bodies, contacts=(floor, between), loads=loads))


@WAYS
@pytest.mark.parametrize("dim", [2, 3])
def test_surfaces_beyond_the_margin_have_no_pairs(way: Way, dim: int) -> None:
    """The rows against the floor alone are left, and do not change in the slab."""
    model = two(way, dim, above=0.03)
    u, contacts = model.displacement, model.contacts
    floor = contacts.contact == 0
    found, every = contacts.meet(u, u, 0.0, 1.0, contacts.closest), contacts.meet(u, u, 0.0, 1.0)
    assert every.found > found.found == floor.sum()
    assert found.fixed_rows is contacts.known_rows
    rows = found.at(u + 0.1)
    assert rows.near.tolist() == floor.tolist()
    reference = every.at(u + 0.1)
    np.testing.assert_array_equal(rows.gap(u)[floor], reference.gap(u)[floor])
    assert abs(rows.gradient[floor.nonzero()[0]] - reference.gradient[floor.nonzero()[0]]).max() == 0.0


@WAYS
@pytest.mark.parametrize("dim", [2, 3])
def test_rows_within_the_margin_are_as_without_it(way: Way, dim: int) -> None:
    """A tilted block: beside one of its edges rows have opponents, further away they have none."""
    model = two(way, dim, above=0.005, tilt=0.12)
    u, contacts = model.displacement, model.contacts
    found, every = contacts.meet(u, u, 0.0, 1.0, contacts.closest), contacts.meet(u, u, 0.0, 1.0)
    rows, reference = found.at(u), every.at(u)
    between = rows.contact == 1
    gap, wanted = rows.gap(u), reference.gap(u)
    close = between & (wanted < contacts.closest[1])
    assert close.any()
    np.testing.assert_allclose(gap[close], wanted[close], atol=1e-15)
    which = np.flatnonzero(close)
    assert abs(rows.gradient[which] - reference.gradient[which]).max() <= 1e-14
    assert (gap[between & ~close] >= contacts.closest[1]).all()
    assert 0 < found.found < every.found
    assert (rows.near & between).sum() < (reference.near & between).sum()


@WAYS
def test_what_the_margin_missed_is_found(way: Way) -> None:
    """The upper block ends a tenth of an edge deep in the lower one, which was not expected."""
    model = two(way, 2, above=0.05)
    u, contacts = model.displacement, model.contacts
    found = contacts.meet(u, u, 0.0, 1.0, contacts.closest)
    end = u.copy()
    end[model.parts[1].nodes, 1] -= 0.075
    assert found.missed(u) is None
    wider = found.missed(end)
    assert wider is not None
    gap = wider.at(end).gap(end)
    assert gap[model.contacts.contact == 1].min() == pytest.approx(-0.025)
    assert wider.missed(end) is None, "twice what was needed"


@WAYS
def test_what_leaves_the_expected_motion_without_a_touch_is_not_searched_for_again(way: Way) -> None:
    model = two(way, 2, above=0.05)
    u, contacts = model.displacement, model.contacts
    end = u.copy()
    end[model.parts[1].nodes, 1] -= 0.045
    assert contacts.meet(u, u, 0.0, 1.0, contacts.closest).missed(end) is None


@WAYS
@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_a_body_that_is_suddenly_accelerated_touches_in_the_same_slab(way: Way, friction: float) -> None:
    """Nothing moves before, so that the search expects rest; the loads carry the upper block .1 down in one slab.

    The slab is that of a search as wide as a cell.
    """
    push = Traction(on="high.top", value=(0.0, -6.0))
    model = two(way, 2, above=0.03, friction=friction, loads=(push,))
    u, contacts = model.displacement, model.contacts
    assert contacts.meet(u, u, 0.0, 0.1, contacts.closest).found == (contacts.contact == 0).sum()
    wide = tuple(None if m is None else replace(m, distance=contacts.reach) for m in contacts.margins)
    full = replace(model, contacts=replace(contacts, margins=wide, known=None, known_rows=None))
    narrow, reference = ([next(march(m, until=0.1, step=0.1))] for m in (model, full))
    one, other = narrow[0], reference[0]
    assert one.slab.span == other.slab.span
    assert one.ledger.contacts["two"].force_n > 0.0
    assert one.certificate.min_gap >= -1e-15
    for name in ("low", "high"):
        np.testing.assert_allclose(one.after.displacement[name], other.after.displacement[name], atol=1e-9)


@WAYS
def test_open_contact_is_searched_once_a_slab(way: Way, monkeypatch: pytest.MonkeyPatch) -> None:
    searches, plain = [], ContactSet.meet

    def counted(self: ContactSet, *given: object) -> object:
        found = plain(self, *given)
        searches.append(found)
        return found

    model = two(way, 2, above=0.05, loads=(Gravity(acceleration=(0.0, -1.0)),))
    states = march(model, until=0.1, step=0.01)
    monkeypatch.setattr(ContactSet, "meet", counted)
    slabs = sum(1 for _ in states)
    in_slabs = [s for s in searches if s.search is not None]
    assert len(in_slabs) == slabs == 10
    assert all(s.found == (model.contacts.contact == 0).sum() for s in in_slabs)


def test_nodes_beside_a_body_are_not_held_by_the_planes_of_its_faces() -> None:
    """A tilted cube overhangs another one: only nodes above the lower one touch.

    After fifteen iterations nodes stay on the planes of their faces, continued beyond the edges; nodes out of reach do
    not take part.
    """
    cube, law = box((1.0, 1.0, 1.0), (3, 3, 3)), NeoHookean(E=1e3, nu=0.3)
    place = Placement(translation=(0.13, 0.21, 1.1), rotations=(Rotation(angle=0.1, axis=(1.0, 1.0, 0.0)),))
    thrown = Uniform(value=(0.3, 0.3, -2.0))
    bodies = {
        "high": Solid(mesh=cube, material=law, density=1.0, velocity=thrown, place=place),
        "low": Solid(mesh=cube, material=law, density=1.0),
        "floor": Tool(shape=HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))),
    }
    between = Contact(between=("high.surface", "low.surface"), name="two", method=NodeToSurface())
    scene = Scene(bodies=bodies, contacts=(between, Contact(between=("low.bottom", "floor"))))
    steps = list(march(scene, until=0.0641, step=0.0641 / 10))
    touches = [e.position for s in steps for e in s.events if e.contact == "two" and e.kind == "touch"]
    assert len(touches) >= 5
    assert np.max(np.array(touches)[:, :2]) <= 1.0 + 0.1 / 3.0, "a tenth of an edge, the margin of the search"
