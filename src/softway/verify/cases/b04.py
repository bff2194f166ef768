"""B04: a hemisphere on a rigid plane, its flat face moved by the approach; Hertz's contact on a circle.

A ball is not a half-space: at the approach of the case, where a/R = 0.1, the force of the continuum is 5.7 percent
above Hertz's. The series of ``exact/ball.py`` says so independently; the difference falls like a/R.
"""

from functools import cache

import numpy as np
from scipy.optimize import brentq

import softway as sw
from softway.record.view_curves import Curve, Panel
from softway.space.sources import GradedDisc
from softway.verify.case import Outcome
from softway.verify.exact.ball import PressedBall, pressed_ball
from softway.verify.exact.contact import CircleContact, contact_modulus
from softway.verify.scenes.pressing import POISSON, YOUNGS, Footprint, approached

MODULUS = contact_modulus(YOUNGS, POISSON)
APPROACH = 0.01
SERIES = (0.0025, 0.005, 0.01)


def hertz(approach: float = APPROACH) -> CircleContact:
    """The half-space."""
    return CircleContact(approach=approach, radius=1.0, modulus=MODULUS)


@cache
def pressed(approach: float, across: int = 10, cell: str = "quad4") -> Footprint:
    """A mesh with ``across`` elements in the contact radius."""
    cells = round(1.3 * across)
    focus = cells / across * hertz(approach).half_width
    return approached(
        approach, GradedDisc(radius=1.0, focus=focus, cells=cells, part="quarter", cell=cell), sw.Axisymmetric()
    )


@cache
def ball() -> tuple[float, PressedBall]:
    """Contact radius and contact of the ball of the series at the approach of the case."""
    width = brentq(lambda a: pressed_ball(a, YOUNGS, POISSON, 1000).approach - APPROACH, 0.09, 0.11, rtol=1e-6)
    return float(width), pressed_ball(width, YOUNGS, POISSON)


def compute() -> Outcome:
    """Ten elements across a, three approaches for the exponent."""
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
