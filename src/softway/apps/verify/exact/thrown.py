"""Free bar thrown at a rigid wall in closed form (d'Alembert, St Venant): cases A02, A10 and A12.

At the touch a compression wave of stress rho c v starts from the tip and stops the bar. It returns from the free rear
end as a release wave that reverses the velocity, and reaches the tip after 2 L / c. Then the tip leaves the wall; the
bar is stress free with the velocity -v everywhere.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from softway.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Thrown:
    """Bar with its speed v towards the wall and the initial gap, in any consistent units.

    Examples
    --------
    >>> bar = Thrown(gap=0.3)
    >>> tuple(round(float(v), 12) for v in (bar.touch, bar.release, bar.force, bar.tip(3.3), bar.rear(1.3)))
    (0.3, 2.3, 1.0, -0.7, 1.3)
    """

    length: float = 1.0
    youngs: float = 1.0
    density: float = 1.0
    area: float = 1.0
    speed: float = 1.0
    gap: float = 0.0

    @property
    def transit(self) -> float:
        """Transit time of a wave from one end to the other, L / c."""
        return self.length * sqrt(self.density / self.youngs)

    @property
    def touch(self) -> float:
        """Time of the touch."""
        return self.gap / self.speed

    @property
    def release(self) -> float:
        """Time of the release."""
        return self.touch + 2.0 * self.transit

    @property
    def force(self) -> float:
        """Force of the wall from touch to release, rho c v A."""
        return self.area * self.speed * sqrt(self.youngs * self.density)

    @property
    def mass(self) -> float:
        """Mass of the bar."""
        return self.density * self.area * self.length

    @property
    def energy(self) -> float:
        """Energy of the bar, constant in time."""
        return 0.5 * self.mass * self.speed**2

    def tip(self, t: float | Array) -> Array:
        """Displacement of the tip towards the wall."""
        t = np.asarray(t, float)
        return self.gap - self.speed * (np.maximum(self.touch - t, 0.0) + np.maximum(t - self.release, 0.0))

    def rear(self, t: float | Array) -> Array:
        """Displacement of the rear end towards the wall."""
        turn = self.touch + self.transit
        return self.speed * (turn - np.abs(np.asarray(t, float) - turn))

    def push(self, t: float | Array) -> Array:
        """Force of the wall at time t, limit from the right."""
        t = np.asarray(t, float)
        return np.where((t >= self.touch) & (t < self.release), self.force, 0.0)
