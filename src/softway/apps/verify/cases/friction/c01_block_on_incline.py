"""C01: elastic block thrown up an incline of 20 degrees; it returns with mu = 0.2 and stays with mu = 0.5.

The block is 0.2 by 0.1 and stiff, E = 1e9 for rho = 1000, so its deflections are 1e-7 of the distance.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes import sliding
from softway.arrays import Array
from softway.marching.results.step import Step
from softway.record.view.plots.curves import Curve, Panel

MASS, SPEED = 20.0, 3.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Way:
    """March of n slabs: ``time`` at their ends, mean ``place`` up the incline, place of the ``feet``, ``speed``."""

    time: Array
    place: Array
    feet: Array
    speed: Array
    steps: tuple[Step, ...]

    @property
    def turn(self) -> float:
        """Time of the first turning point."""
        return float(self.time[int(np.argmax(self.place > self.place.max() - 1e-9))])

    @property
    def back(self) -> tuple[float, float]:
        """Time at which the block passes its start downwards, and its velocity there."""
        down = self.time > self.turn + 0.05
        time = np.interp(0.0, -self.place[down], self.time[down])
        return float(time), float(np.interp(time, self.time, self.speed))


@cache
def thrown(mu: float) -> Way:
    """March with slabs of 0.01 until the return (mu = 0.2), or of 0.05 for ten seconds after the stop (mu = 0.5)."""
    until, step = (1.8, 0.01) if mu < np.tan(np.deg2rad(20.0)) else (10.4, 0.05)
    march = list(sliding.travelled(sw.march(sliding.incline(20.0, mu, SPEED), until=until, step=step)))
    time, place = np.array([(t, x) for t, x, _ in march]).T
    return Way(
        time=time,
        place=place,
        feet=np.array([s.after.displacement["b"][:9, 0].mean() for _, _, s in march]),
        speed=np.array([s.ledger.momentum[0] for _, _, s in march]) / MASS,
        steps=tuple(s for _, _, s in march),
    )


def creep(way: Way) -> float:
    """Greatest change of the mean place of the feet after the stop."""
    return float(np.ptp(way.feet[way.time > way.turn + 0.01]))


def compute() -> Outcome:
    """Compute both friction coefficients."""
    smooth, rough = thrown(0.2), thrown(0.5)
    found = {
        "t_stop mu=.2": smooth.turn,
        "distance up mu=.5": float(rough.place[-1]),
        "creep after stop (mu=.5), 10 s": creep(rough),
        "v_return mu=.2": -smooth.back[1],
    }
    t = np.linspace(0.0, 1.8, 200)
    slope = np.deg2rad(20.0)
    up, down = (9.81 * (np.sin(slope) + sign * 0.2 * np.cos(slope)) for sign in (1.0, -1.0))
    stop = SPEED / up
    exact = np.where(t < stop, SPEED * t - 0.5 * up * t**2, 0.5 * SPEED * stop - 0.5 * down * (t - stop) ** 2)
    first = rough.time < 1.8
    curves = (
        Curve(x=smooth.time, y=smooth.place, label="mu = 0.2"),
        Curve(x=rough.time[first], y=rough.place[first], label="mu = 0.5"),
        Curve(x=t, y=exact, kind="exact", label="closed form, mu = 0.2"),
    )
    panel = Panel(title="The way up", x="t [s]", y="place [m]", curves=curves)
    return Outcome(values=found, panels=(panel,))
