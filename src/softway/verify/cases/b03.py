"""B03: a cylinder on a rigid plane, Hertz's line contact in plane strain, from nodal forces without regularisation."""

from functools import cache

import numpy as np

from softway.record.view_curves import Curve, Panel
from softway.space.sources import GradedDisc
from softway.verify.case import Outcome
from softway.verify.exact.contact import LineContact, contact_modulus
from softway.verify.scenes.pressing import POISSON, YOUNGS, Footprint, loaded

LOAD = 0.01
MODULUS = contact_modulus(YOUNGS, POISSON)
HERTZ = LineContact(load=LOAD, radius=1.0, modulus=MODULUS)


@cache
def pressed(across: int, cell: str = "quad4", load: float = LOAD) -> Footprint:
    """A mesh with ``across`` elements in the half width of the contact."""
    width = LineContact(load=load, radius=1.0, modulus=MODULUS).half_width
    cells = round(1.3 * across)
    return loaded(load, GradedDisc(radius=1.0, focus=cells / across * width, cells=cells, part="quarter", cell=cell))


def compute() -> Outcome:
    """Ten elements across b; peak and half width of the ellipse that suits the nodal pressures best."""
    contact = pressed(10)
    peak, width = contact.fitted
    found = {"p0": peak, "b": width, "sum of nodal forces": 2.0 * float(contact.force.sum())}
    x = np.linspace(0.0, HERTZ.half_width, 200)
    curves = (
        Curve(x=contact.place, y=contact.pressure, kind="dots", label="nodes"),
        Curve(x=x, y=HERTZ.pressure(x), kind="exact", label="Hertz"),
    )
    return Outcome(values=found, panels=(Panel(title="Pressure", x="x / R", y="p / E", curves=curves),))
