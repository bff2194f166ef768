"""C08: the friction oscillator of SDND100 (Code_Aster), displaced at 45 degrees in the plane of the floor.

A stiff block in space on a column that bends both ways alike (``scenes/sprung.py``); ten times the weight and a tenth
of the friction.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.verify.case import Outcome
from softway.verify.scenes import sprung

HALF = np.pi / 100.0
"""Half a period [s]."""
AWAY = 0.00085
"""Distance at the start [m]."""


@cache
def swung() -> sprung.Swing:
    """Four and a half half-periods of 40 slabs."""
    it = sprung.Sprung(dim=3, mass=1.0, stiffness=1e4, weight=100.0)
    place = AWAY / np.sqrt(2.0)
    scene = it.scene((-1e-9, -1e-9, 0.0), (place, place), sw.Coulomb(mu=0.01))
    return it.swing(scene, until=4.5 * HALF, step=HALF / 40.0)


def compute() -> Outcome:
    """Where it turns, and where it stays."""
    swing = swung()
    turns = [float(swing.at(k * HALF)[1]) for k in (1, 2, 3)]
    found = {"DY at half periods": turns, "final rest amplitude": float(np.linalg.norm(swing.place[-1, :2]))}
    along = swing.place[:, :2].sum(axis=1) / np.sqrt(2.0)
    known = np.array([0.85, -0.65, 0.45, -0.25, 0.05])
    curves = (
        Curve(x=1e3 * swing.time, y=1e3 * along, label="softway"),
        Curve(x=1e3 * HALF * np.arange(5.0), y=known, kind="dots", label="turning points"),
    )
    panel = Panel(title="Along the diagonal", x="t [ms]", y="place [mm]", curves=curves)
    return Outcome(values=found, panels=(panel,))
