"""How a method did in a race: its slabs, its time, and why it failed if it did."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from softway.march.advance import Method
from softway.race.penalty import Penalty
from softway.typing import Array
from softway.units import Second

Entrant = Method | Penalty


@dataclass(frozen=True, slots=True, kw_only=True)
class Lap:
    """One slab of one method.

    Parameters
    ----------
    time
        At its end [s].
    iterations, rejected, factorisations
        Of the slab; tries of it that were dropped; factors since the start.
    energy, error
        Energy at its end, and what it misses for the start, the work of loads, tools and supports, and the dissipation
        of jumps [J].
    gap, force
        Least gap [m] and least normal force [N] at its end; None without contact.
    wall, cpu
        Time that it took, rejected tries included [s].
    """

    time: Second
    iterations: int
    rejected: int
    factorisations: int
    energy: float
    error: float
    gap: float | None
    force: float | None
    wall: Second = 0.0
    cpu: Second = 0.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Result:
    """How a method did.

    Parameters
    ----------
    name, method
        Key of the method, and what it was.
    laps
        Its slabs.
    wall, cpu
        Time of all slabs, a failed one included; the arrays of the model are made before [s].
    initial
        Energy at the start [J].
    reason
        Why it failed; nothing if it did not.
    displacement
        (n, d) of every solid after the last slab [m].
    """

    name: str
    method: Entrant
    laps: tuple[Lap, ...]
    wall: Second
    cpu: Second
    initial: float
    reason: str = ""
    displacement: Mapping[str, Array] = field(default_factory=dict)

    @property
    def iterations(self) -> Array:
        """Iterations (s,) of each slab."""
        return np.array([lap.iterations for lap in self.laps], int)

    @property
    def factorisations(self) -> int:
        """Factors made."""
        return self.laps[-1].factorisations if self.laps else 0

    @property
    def rejected(self) -> int:
        """Slabs dropped and tried again."""
        return sum(lap.rejected for lap in self.laps)

    @property
    def drift(self) -> float:
        """Greatest error of the energy balance, relative to the greatest energy."""
        greatest = max([self.initial, *(lap.energy for lap in self.laps)])
        return max((abs(lap.error) for lap in self.laps), default=0.0) / max(greatest, 1e-300)

    @property
    def penetration(self) -> float:
        """Greatest depth of a node in its opponent [m]."""
        return max(0.0, *(-lap.gap for lap in self.laps if lap.gap is not None), 0.0)

    @property
    def least_force(self) -> float:
        """Least normal force of contact [N]; zero without contact."""
        return min((lap.force for lap in self.laps if lap.force is not None), default=0.0)

    @property
    def first(self) -> Second:
        """CPU time of the first slab, with the order of elimination and the first factor [s]."""
        return self.laps[0].cpu if self.laps else 0.0

    @property
    def usual(self) -> Second:
        """CPU time of a slab: the median, which neither the first factor nor the loading of kernels moves [s]."""
        return float(np.median([lap.cpu for lap in self.laps])) if self.laps else 0.0
