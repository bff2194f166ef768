"""Piles: many rigid balls or discs that touch each other and walls, and their march."""

from softway.piles.balls import Balls as Balls
from softway.piles.balls import lattice as lattice
from softway.piles.contacts import PileContacts as PileContacts
from softway.piles.groups import BallFile as BallFile
from softway.piles.groups import BallLattice as BallLattice
from softway.piles.groups import BallList as BallList
from softway.piles.march import PileStep as PileStep
from softway.piles.march import march as march
from softway.piles.pile import Pile as Pile
from softway.piles.walls import Box as Box
from softway.piles.walls import Wall as Wall
from softway.piles.walls import box as box

__all__ = [
    "BallFile",
    "BallLattice",
    "BallList",
    "Balls",
    "Box",
    "Pile",
    "PileContacts",
    "PileStep",
    "Wall",
    "box",
    "lattice",
    "march",
]
