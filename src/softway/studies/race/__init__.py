"""Comparison of solution methods on one scenario: iterations, time, energy, penetration."""

from softway.studies.race.contest import contest, entrants
from softway.studies.race.penalty import Penalty
from softway.studies.race.result import Lap, Result

__all__ = ["Lap", "Penalty", "Result", "contest", "entrants"]
