"""C02: mass on a spring on a rough floor comes to rest away from the neutral position of the spring.

Stiff block on a thin bending column (``scenes/sprung.py``), with ten times the weight and a tenth of the friction
coefficient; the product is that of the case.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes import sprung
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

SLOW = 1e-3
"""Mean speed of a slab [m/s] above which the block is moving; its greatest speed is 1.7."""


@cache
def swung() -> sprung.Swing:
    """March 1.2 s in slabs of 0.002 s; the block starts in slip, at 1e-9 m/s."""
    it = sprung.Sprung(dim=2, mass=1.0, stiffness=100.0, weight=98.1)
    return it.swing(it.scene((-1e-9, 0.0), (0.2,), sw.Coulomb(mu=0.03)), until=1.2, step=2e-3)


def rest(time: Array, place: Array) -> float:
    """End of the last slab in which the block moves."""
    speed = np.diff(place) / np.diff(time)
    return float(time[1 + int(np.flatnonzero(np.abs(speed) > SLOW)[-1])])


def compute() -> Outcome:
    """Compute position and time of rest."""
    swing = swung()
    time, place = swing.time, swing.place[:, 0]
    found = {"final rest position": float(place[-1]), "time of rest": rest(time, place)}
    half = np.pi / 10.0
    t = np.linspace(0.0, 3.0 * half, 300)
    turns, shift = np.floor(t / half - 1e-12).clip(0.0), 0.3 * 9.81 / 100.0
    side = np.where(turns % 2.0 == 0.0, 1.0, -1.0)
    exact = side * shift + (0.2 - (2.0 * turns + 1.0) * shift) * np.cos(10.0 * t)
    curves = (Curve(x=time, y=place, label="softway"), Curve(x=t, y=exact, kind="exact", label="half swings"))
    return Outcome(values=found, panels=(Panel(title="Down to rest", x="t [s]", y="place [m]", curves=curves),))
