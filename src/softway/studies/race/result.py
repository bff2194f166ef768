"""Result of a method in a race: its slabs, its time, and the reason of a failure."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from softway.arrays import Array
from softway.marching.rules.slab_rule import Method
from softway.studies.race.penalty import Penalty
from softway.units import Second

Entrant = Method | Penalty


@dataclass(frozen=True, slots=True, kw_only=True)
class Lap:
    """Slab of a method in a race.

    Parameters
    ----------
    time
        End of the slab [s].
    iterations, rejected, factorisations
        Iterations and rejected tries of the slab; factorisations since the start.
    energy, error
        Energy at the end of the slab, and error of the energy balance since the start, with the work of loads, tools
        and supports and the dissipation of velocity jumps [J].
    gap, force
        Smallest gap [m] and smallest normal force [N] at the end; None without contact.
    wall, cpu
        Wall time and CPU time of the slab, with rejected tries [s].
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
    """Result of a method.

    Parameters
    ----------
    name, method
        Key of the method, and the method.
    laps
        Accepted slabs.
    wall, cpu
        Wall time and CPU time of all slabs, with a failed one; without the time to build the model [s].
    initial
        Energy at the start [J].
    reason
        Reason of the failure; empty if the method reached the end.
    displacement
        Displacement (n, d) of every solid after the last slab [m].
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
        """Number of factorisations."""
        return self.laps[-1].factorisations if self.laps else 0

    @property
    def rejected(self) -> int:
        """Number of rejected slabs."""
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
        """Smallest normal contact force [N]; zero without contact."""
        return min((lap.force for lap in self.laps if lap.force is not None), default=0.0)

    @property
    def first(self) -> Second:
        """CPU time of the first slab, including the elimination order and the first factor [s]."""
        return self.laps[0].cpu if self.laps else 0.0

    @property
    def usual(self) -> Second:
        """Median CPU time of a slab, which excludes the first factor and the loading of kernels [s]."""
        return float(np.median([lap.cpu for lap in self.laps])) if self.laps else 0.0
