"""C08: friction oscillator of SDND100 (Code_Aster), displaced at 45 degrees in the plane of the floor.

Stiff 3D block on a column with equal bending stiffness in both directions (``scenes/sprung.py``), with ten times the
weight and a tenth of the friction coefficient.
"""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes import sprung
from softway.record.view.plots.curves import Curve, Panel

HALF = np.pi / 100.0
"""Half a period [s]."""
AWAY = 0.00085
"""Initial distance [m]."""


@cache
def swung() -> sprung.Swing:
    """March four and a half half-periods of 40 slabs."""
    it = sprung.Sprung(dim=3, mass=1.0, stiffness=1e4, weight=100.0)
    place = AWAY / np.sqrt(2.0)
    scene = it.scene((-1e-9, -1e-9, 0.0), (place, place), sw.Coulomb(mu=0.01))
    return it.swing(scene, until=4.5 * HALF, step=HALF / 40.0)


def compute() -> Outcome:
    """Compute the turning points and the position of rest."""
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
