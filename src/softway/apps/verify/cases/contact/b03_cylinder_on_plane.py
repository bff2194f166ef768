"""B03: cylinder on a rigid plane, Hertz line contact in plane strain, from nodal forces without regularisation."""

from functools import cache

import numpy as np

from softway.apps.verify.case import Outcome
from softway.apps.verify.exact.contact import LineContact, contact_modulus
from softway.apps.verify.scenes.pressing import POISSON, YOUNGS, Footprint, loaded
from softway.meshes.generators.recipes import GradedDisc
from softway.record.view.plots.curves import Curve, Panel

LOAD = 0.01
MODULUS = contact_modulus(YOUNGS, POISSON)
HERTZ = LineContact(load=LOAD, radius=1.0, modulus=MODULUS)


@cache
def pressed(across: int, cell: str = "quad4", load: float = LOAD) -> Footprint:
    """Solve with ``across`` elements in the half width of the contact."""
    width = LineContact(load=load, radius=1.0, modulus=MODULUS).half_width
    cells = round(1.3 * across)
    return loaded(load, GradedDisc(radius=1.0, focus=cells / across * width, cells=cells, part="quarter", cell=cell))


def compute() -> Outcome:
    """Compute with ten elements across b; peak and half width of the ellipse fitted to the nodal pressures."""
    contact = pressed(10)
    peak, width = contact.fitted
    found = {"p0": peak, "b": width, "sum of nodal forces": 2.0 * float(contact.force.sum())}
    x = np.linspace(0.0, HERTZ.half_width, 200)
    curves = (
        Curve(x=contact.place, y=contact.pressure, kind="dots", label="nodes"),
        Curve(x=x, y=HERTZ.pressure(x), kind="exact", label="Hertz"),
    )
    return Outcome(values=found, panels=(Panel(title="Pressure", x="x / R", y="p / E", curves=curves),))
