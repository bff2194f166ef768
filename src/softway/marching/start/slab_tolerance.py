"""Tolerance by which slabs (time steps) grow: the given one, or that of slabs of automatic length."""

from typing import Literal

import numpy as np

from softway.errors import InputError
from softway.marching.rules.slab_rule import Method
from softway.model.model import Model
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.methods.central_difference import Explicit
from softway.units import Second

AUTO = 1e-3
"""Tolerance of slabs of automatic length: measured in docs/theory/time/control.md."""


def slab_tolerance(
    model: Model,
    step: Second | Literal["auto"],
    tolerance: float | Literal["auto", "off"],
    weight: TimeWeight,
    method: Method,
) -> float | None:
    """Tolerance of the slabs of a march; None if all have the requested length.

    ``auto`` is ``AUTO`` for slabs of automatic length in the plane and in space, where something estimates the error
    of a slab, and none for slabs of a given length.  Bars keep equal slabs: their waves do not spread, and the phase of
    what an impact leaves determines the next touch.

    Parameters
    ----------
    model, step, tolerance, weight, method
        As for :func:`~softway.marching.march.march`.

    Raises
    ------
    InputError
        If a tolerance is given and nothing estimates the error of a slab, or it is no tolerance.

    Examples
    --------
    >>> import softway as sw
    >>> mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2))
    >>> block = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0)
    >>> given = sw.build(sw.Scene(bodies={"block": block})), "auto", "auto", EndPeaks()
    >>> slab_tolerance(*given, sw.FixedPoint()), slab_tolerance(*given, sw.Explicit())
    (0.001, None)
    """
    if tolerance == "off":
        return None
    unknown = _unknown(model, weight, method)
    if tolerance == "auto":
        grows = step == "auto" and unknown is None and model.shape[1] > 1
        return AUTO if grows else None
    number = tolerance if isinstance(tolerance, float | int) else np.nan
    if not 0.0 < number <= 1.0:
        told = "a number above 0 and up to 1, such as 1e-2, 'auto' or 'off'"
        raise InputError("time.tolerance", f"{tolerance}", told)
    if unknown is not None:
        raise InputError("time.tolerance", *unknown)
    return float(number)


def _unknown(model: Model, weight: TimeWeight, method: Method) -> tuple[str, str] | None:
    """Problem and remedy where nothing estimates the error of a slab; None if it is estimated."""
    if isinstance(method, Explicit):
        return "with Explicit, whose stability limits the step", "FixedPoint, or omit it"
    if not model.inert:
        return "without inertia, where no acceleration tells the error", "omit it"
    if weight != EndPeaks():
        return f"with {weight}", "the weight EndPeaks with theta = 0.5"
    if model.rigid is not None:
        return "beside rigid bodies, whose error is not estimated", "omit it"
    if model.companions:
        names = ", ".join(c.field.name for c in model.companions)
        return f"with {names}, whose error is not estimated", "omit it"
    return None
