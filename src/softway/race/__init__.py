"""The same scenario by several methods, side by side: iterations, time, energy, penetration."""

from softway.race.contest import contest, entrants
from softway.race.penalty import Penalty
from softway.race.result import Lap, Result

__all__ = ["Lap", "Penalty", "Result", "contest", "entrants"]
