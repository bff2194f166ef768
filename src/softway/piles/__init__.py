"""Piles: many rigid balls or discs that touch each other and walls, and their march."""

from softway.piles.balls import Balls as Balls
from softway.piles.balls import lattice as lattice
from softway.piles.march import PileStep as PileStep
from softway.piles.march import march as march
from softway.piles.pile import Pile as Pile
from softway.piles.walls import Wall as Wall
from softway.piles.walls import box as box

__all__ = ["Balls", "Pile", "PileStep", "Wall", "box", "lattice", "march"]
