"""Contact: who may touch whom, how nodes move inside a slab, and the rules in time."""

from softway.contact.assembly.tie import Tie as Tie
from softway.contact.contact import Contact as Contact
from softway.contact.contact import DualMortar as DualMortar
from softway.contact.contact import NodeToSurface as NodeToSurface
from softway.contact.impact_rule import Energy as Energy
from softway.contact.impact_rule import Impulse as Impulse
from softway.contact.impact_rule import Paper as Paper

__all__ = [
    "Contact",
    "DualMortar",
    "Energy",
    "Impulse",
    "NodeToSurface",
    "Paper",
    "Tie",
]
