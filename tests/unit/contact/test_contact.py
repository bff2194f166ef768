"""The declaration of a contact."""

from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, Paper


def test_names() -> None:
    contact = Contact(between=("part.bottom", "floor"))
    assert (contact.label, contact.body, contact.tag) == ("part.bottom-floor", "part", "bottom")
    assert Contact(between=("part", "floor")).tag == "surface"
    assert Contact(between=("part", "floor"), name="landing").label == "landing"


def test_the_energy_rule_is_the_default() -> None:
    assert Contact(between=("a", "b")).timing == Energy(located=False)
    assert Paper() == Paper(approach="kept", split="product")
