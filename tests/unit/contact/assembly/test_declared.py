"""Contacts that name all their members."""

import pytest

import softway as sw
from softway.contact.assembly.declared import at_declared, resolved
from softway.contact.contact import Contact
from softway.errors import InputError
from softway.laws.friction.coulomb import Coulomb
from softway.marching.start.initial_state import initial_state
from softway.obstacles import HalfSpace

SOLIDS, TOOLS = ("a", "b"), ("floor", "wall")


def told(*contacts: Contact) -> list[tuple[str, tuple[str, ...]]]:
    return [(c.label, c.names) for _, c in resolved(contacts, SOLIDS, TOOLS)]


def test_pairs_stay_as_they_are() -> None:
    pairs = (Contact(between=("a.left", "floor")), Contact(between=("a", "b"), name="both"))
    assert resolved(pairs, SOLIDS, TOOLS) == tuple(enumerate(pairs))


def test_all_is_every_surface_with_every_other_itself_and_the_tools() -> None:
    assert told(Contact(between="all")) == [
        ("all", ("a", "a", "b", "b")),
        ("a-floor", ("a", "floor")),
        ("b-floor", ("b", "floor")),
        ("a-wall", ("a", "wall")),
        ("b-wall", ("b", "wall")),
    ]


def test_a_list_names_its_members_and_its_tools() -> None:
    assert told(Contact(between=("a", "b", "floor"), name="heap")) == [
        ("heap", ("a", "b")),
        ("a-floor", ("a", "floor")),
        ("b-floor", ("b", "floor")),
    ]
    assert told(Contact(between=("a", "floor", "wall"))) == [("a-floor", ("a", "floor")), ("a-wall", ("a", "wall"))]


def test_declared_contacts_keep_their_numbers_and_laws() -> None:
    rough = Coulomb(mu=0.5)
    contacts = (Contact(between="all"), Contact(between=("b", "floor"), friction=rough))
    found = [c for _, c in resolved(contacts, SOLIDS, TOOLS)]
    assert [c.label for c in found] == ["all", "b-floor", "a-floor", "a-wall", "b-wall"]
    assert found[1].friction is rough
    assert found[2].friction.frictionless


def test_friction_of_all_is_that_of_its_tools() -> None:
    rough = Coulomb(mu=0.2)
    assert {c.friction for _, c in resolved((Contact(between="all", friction=rough),), SOLIDS, TOOLS)} == {rough}


def test_tools_alone_are_refused() -> None:
    with pytest.raises(InputError, match=r"contacts\[0\].between.*has no solid"):
        resolved((Contact(between=("floor", "floor", "wall")),), SOLIDS, TOOLS)


def test_a_list_of_pairs_that_others_have_is_refused() -> None:
    pairs = tuple(Contact(between=("a", tool)) for tool in TOOLS)
    with pytest.raises(InputError, match=r"contacts\[2\].between: .*another contact.*\n.*leave this contact out"):
        resolved((*pairs, Contact(between=("a", *TOOLS))), SOLIDS, TOOLS)


def test_every_part_has_the_number_of_its_contact() -> None:
    contacts = (Contact(between=("b", "floor")), Contact(between=("a", "b", "floor")), Contact(between="all"))
    assert [(k, c.names) for k, c in resolved(contacts, SOLIDS, TOOLS)] == [
        (0, ("b", "floor")),
        (1, ("a", "b")),
        (2, ("a", "a", "b", "b")),
        (1, ("a", "floor")),
        (2, ("a", "wall")),
        (2, ("b", "wall")),
    ]


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ("contacts[3].start", "contacts[1].start"),
        ("contacts[1]", "contacts[1]"),
        ("contacts[7].start", "contacts[7].start"),
        ("bodies.a.mesh", "bodies.a.mesh"),
    ],
)
def test_errors_name_the_declared_contact(where: str, told: str) -> None:
    with pytest.raises(InputError) as found, at_declared((0, 1, 2, 1)):
        raise InputError(where, "wrong", "right")
    assert (found.value.where, found.value.problem, found.value.remedy) == (told, "wrong", "right")


def test_a_start_inside_a_tool_names_the_contact_as_it_was_given() -> None:
    law, size = sw.LinearElastic(E=1.0, nu=0.3), (1.0, 1.0)
    bodies = {
        name: sw.Solid(mesh=sw.meshes.Rectangle(size=size, cells=(4, 4), origin=(x, 0.0)), material=law, density=1.0)
        for name, x in (("a", 0.0), ("b", 3.0))
    }
    floor, wall = HalfSpace(point=(0.0, -0.1), normal=(0.0, 1.0)), HalfSpace(point=(0.2, 0.0), normal=(1.0, 0.0))
    tools = {"floor": sw.Tool(shape=floor), "wall": sw.Tool(shape=wall)}
    scene = sw.Scene(bodies={**bodies, **tools}, contacts=(sw.Contact(between="all"),))
    with pytest.raises(InputError, match=r"^contacts\[0\].between: 'a' starts 0.2 m inside 'wall'"):
        initial_state(sw.build(scene))
