"""Rigid follower on an eccentric disc: lift, contact force, and times of separation and landing.

The disc rotates uniformly about a point at the distance e from its centre. The follower is guided along a line through
this point. It touches with a point, or with a roller whose radius is added to that of the disc.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from softway.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Cam:
    """Eccentric disc that rotates uniformly.

    Parameters
    ----------
    radius, eccentricity
        R and e < R [m].
    rate
        Angular velocity, positive [rad/s].
    angle
        Angle of the centre of the disc from the horizontal at t = 0 [rad].

    Examples
    --------
    >>> cam = Cam(radius=4.0, eccentricity=1.0, rate=2.0)
    >>> round(cam.lift(np.pi / 4), 12), round(cam.acceleration(np.pi / 4), 12)
    (5.0, -5.0)
    """

    radius: float
    eccentricity: float
    rate: float
    angle: float = 0.0

    def lift(self, time: float) -> float:
        """Height of the follower above the axis [m], ``e sin + sqrt(R^2 - e^2 cos^2)``."""
        sine, _, rest = self._parts(time)
        return self.eccentricity * sine + rest

    def velocity(self, time: float) -> float:
        """Velocity of the follower [m/s]."""
        sine, cosine, rest = self._parts(time)
        return self.rate * self.eccentricity * cosine * (1.0 + self.eccentricity * sine / rest)

    def acceleration(self, time: float) -> float:
        """Acceleration of the follower [m/s^2]."""
        sine, cosine, rest = self._parts(time)
        e = self.eccentricity
        swing = e * e * (cosine**2 - sine**2) / rest - (e * e * cosine * sine) ** 2 / rest**3
        return self.rate**2 * (swing - e * sine)

    def push(self, time: float, mass: float, pull: float) -> float:
        """Normal force between cam and follower [N]; the force ``mass * pull`` draws the follower to the axis.

        The normal is inclined to the path of the follower; the guide carries the lateral force.
        """
        return mass * (pull + self.acceleration(time)) * self.radius / self._parts(time)[2]

    def leaves(self, pull: float) -> float:
        """First time [s] at which the cam falls away faster than ``pull`` [m/s^2]; inf if it never does."""
        return _first(lambda t: self.acceleration(t) + pull, np.linspace(0.0, 2.0 * np.pi / self.rate, 721))

    def lands(self, pull: float) -> float:
        """Time at which the separated follower lands on the cam again [s]."""
        left = self.leaves(pull)
        height, speed = self.lift(left), self.velocity(left)

        def above(t: float) -> float:
            flown = t - left
            return height + speed * flown - 0.5 * pull * flown**2 - self.lift(t)

        longest = 2.0 * (speed + np.sqrt(speed**2 + 4.0 * pull * self.eccentricity)) / pull
        return _first(above, left + np.linspace(0.01, 1.0, 1000) * longest)

    def limit(self, pull: float) -> float:
        """Angular velocity above which the follower leaves the top of the cam [rad/s]."""
        return float(np.sqrt(pull / (self.eccentricity * (1.0 + self.eccentricity / self.radius))))

    def _parts(self, time: float) -> tuple[float, float, float]:
        theta = self.angle + self.rate * time
        cosine = float(np.cos(theta))
        return float(np.sin(theta)), cosine, float(np.sqrt(self.radius**2 - (self.eccentricity * cosine) ** 2))


def _first(function: Callable[[float], float], times: Array) -> float:
    """Time at which a function first becomes negative; inf if it does not."""
    values = np.array([function(t) for t in times])
    below = np.flatnonzero(values < 0.0)
    if not len(below):
        return float("inf")
    k = below[0]
    return float(brentq(function, times[k - 1], times[k], xtol=1e-15))
