"""Contacts that name all their members."""

import pytest

from softway.contact.assembly.declared import resolved
from softway.contact.contact import Contact
from softway.errors import InputError
from softway.laws.friction.coulomb import Coulomb

SOLIDS, TOOLS = ("a", "b"), ("floor", "wall")


def told(*contacts: Contact) -> list[tuple[str, tuple[str, ...]]]:
    return [(c.label, c.names) for c in resolved(contacts, SOLIDS, TOOLS)]


def test_pairs_stay_as_they_are() -> None:
    pairs = (Contact(between=("a.left", "floor")), Contact(between=("a", "b"), name="both"))
    assert resolved(pairs, SOLIDS, TOOLS) == pairs


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
    found = resolved((Contact(between="all"), Contact(between=("b", "floor"), friction=rough)), SOLIDS, TOOLS)
    assert [c.label for c in found] == ["all", "b-floor", "a-floor", "a-wall", "b-wall"]
    assert found[1].friction is rough
    assert found[2].friction.frictionless


def test_friction_of_all_is_that_of_its_tools() -> None:
    rough = Coulomb(mu=0.2)
    assert {c.friction for c in resolved((Contact(between="all", friction=rough),), SOLIDS, TOOLS)} == {rough}


def test_tools_alone_are_refused() -> None:
    with pytest.raises(InputError, match=r"contacts\[0\].between.*has no solid"):
        resolved((Contact(between=("floor", "floor", "wall")),), SOLIDS, TOOLS)
