"""F10: a rod whose tip slides on a rough floor: between two angles its sliding has no continuous course (Painleve)."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.mechanisms import Mechanism, MechanismStep, PlaneStop, Rigid, march
from softway.record.view.plots.curves import Curve, Panel

ANGLES = (30.0, 61.8, 88.0)
"""Angles [deg] outside, within and outside the interval."""


def sliding_rod(angle: float, friction: float) -> Mechanism:
    """Rod of length 2 m that leans back, at an angle [deg] to the floor, pushed forward on its tip at 1 m/s."""
    along = np.array([-np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    ends = {"tip": (0.0, 0.0), "top": (float(2.0 * along[0]), float(2.0 * along[1]))}
    rod = Rigid(mass=1.0, centre=(float(along[0]), float(along[1])), inertia=1.0 / 3.0, velocity=(1.0, 0.0))
    stops = {
        end: PlaneStop(between=("ground", "rod"), point=at, plane=(0.0, 0.0), normal=(0.0, 1.0), friction=friction)
        for end, at in ends.items()
    }
    return Mechanism(bodies={"rod": rod}, stops=stops, gravity=(0.0, -9.81))


def jams(angle: float, friction: float) -> bool:
    """True if the tip jams at once."""
    steps = march(sliding_rod(angle, friction), until=1e-6, step=1e-6)
    return any(event.kind == "jam" for step in steps for event in step.events)


def interval(friction: float) -> list[float]:
    """Least and greatest angle [deg] at which the tip jams, to 1e-4 degrees."""
    found = []
    for outside in (ANGLES[0], ANGLES[2]):
        free, jammed = outside, ANGLES[1]
        while abs(free - jammed) > 1e-4:
            middle = 0.5 * (free + jammed)
            free, jammed = (free, middle) if jams(middle, friction) else (middle, jammed)
        found.append(0.5 * (free + jammed))
    return found


@cache
def fallen(friction: float) -> tuple[MechanismStep, ...]:
    """Steps of 2 s from within the interval."""
    return tuple(march(sliding_rod(ANGLES[1], friction), until=2.0, step=1e-3))


def compute() -> Outcome:
    """Compute the case."""
    low, high = 1.0, 2.0
    while high - low > 1e-6:  # the interval shrinks to one angle, tan^2 = 4
        middle = 0.5 * (low + high)
        low, high = (low, middle) if jams(float(np.degrees(np.arctan(2.0))), middle) else (middle, high)
    marches = [fallen(friction) for friction in (1.5, 2.0)]
    energy = [[step.energy_kinetic + step.energy_potential for step in steps] for steps in marches]
    found = {
        "mu_crit": 0.5 * (low + high),
        "interval, mu = 1.5 [deg]": interval(1.5),
        "interval, mu = 2 [deg]": interval(2.0),
        "marches that jam and end at rest": float(sum(_rests(steps) for steps in marches)),
        "greatest gain of energy [J]": float(max(np.diff(e).max() for e in energy)),
    }
    curves = tuple(
        Curve(x=np.array([s.time for s in steps]), y=np.array([float(s.bodies["rod"].velocity[0]) for s in steps]),
              label=f"mu = {friction}")
        for friction, steps in zip((1.5, 2.0), marches, strict=True)
    )  # fmt: skip
    return Outcome(
        values=found, panels=(Panel(title="Rod", x="t [s]", y="velocity of the centre [m/s]", curves=curves),)
    )


def _rests(steps: tuple[MechanismStep, ...]) -> bool:
    kinds = [event.kind for step in steps for event in step.events]
    return kinds[0] == "jam" and steps[-1].energy_kinetic < 1e-20 and len(steps[-1].closed) == 2
