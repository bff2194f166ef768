"""B04: hemisphere on a rigid plane, with its flat face moved by the approach; Hertz point contact.

A ball is not a half-space. At the approach of the case, with a/R = 0.1, the force of the continuum is 5.7 percent above
Hertz; the series of ``exact/ball.py`` confirms this independently. The difference is proportional to a/R.
"""

from functools import cache

import numpy as np
from scipy.optimize import brentq

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact.ball import PressedBall, pressed_ball
from softway.apps.verify.exact.contact import CircleContact, contact_modulus
from softway.apps.verify.scenes.pressing import POISSON, YOUNGS, Footprint, approached
from softway.meshes.generators.recipes import GradedDisc
from softway.record.view.plots.curves import Curve, Panel

MODULUS = contact_modulus(YOUNGS, POISSON)
APPROACH = 0.01
SERIES = (0.0025, 0.005, 0.01)


def hertz(approach: float = APPROACH) -> CircleContact:
    """Hertz solution for the half-space."""
    return CircleContact(approach=approach, radius=1.0, modulus=MODULUS)


@cache
def pressed(approach: float, across: int = 10, cell: str = "quad4") -> Footprint:
    """Solve with ``across`` elements in the contact radius."""
    cells = round(1.3 * across)
    focus = cells / across * hertz(approach).half_width
    return approached(
        approach, GradedDisc(radius=1.0, focus=focus, cells=cells, part="quarter", cell=cell), sw.bodies.Axisymmetric()
    )


@cache
def ball() -> tuple[float, PressedBall]:
    """Contact radius and series solution of the ball at the approach of the case."""
    width = brentq(lambda a: pressed_ball(a, YOUNGS, POISSON, 1000).approach - APPROACH, 0.09, 0.11, rtol=1e-6)
    return float(width), pressed_ball(width, YOUNGS, POISSON)


def compute() -> Outcome:
    """Compute with ten elements across a; the exponent is from three approaches."""
    series = [pressed(approach) for approach in SERIES]
    forces = [float(contact.force.sum()) for contact in series]
    slope = np.polyfit(np.log(SERIES), np.log(forces), 1)[0]
    peak, _ = series[-1].fitted
    found = {
        "F": forces[-1],
        "p0": peak,
        "slope dlnF/dlndelta": float(slope),
        "F over that of a ball, by a series": forces[-1] / ball()[1].force,
    }
    x = np.linspace(0.0, hertz().half_width, 200)
    pressure = hertz().peak * np.sqrt(np.maximum(1.0 - (x / hertz().half_width) ** 2, 0.0))
    curves = (
        Curve(x=series[-1].place, y=series[-1].pressure, kind="dots", label="nodes"),
        Curve(x=x, y=pressure, kind="exact", label="Hertz, half-space"),
    )
    return Outcome(values=found, panels=(Panel(title="Pressure", x="r / R", y="p / E", curves=curves),))
