"""Examination of a law of friction."""

import numpy as np

from softway.laws.friction_law import FrictionLaw
from softway.testing.verdict import close, require

STEP = 1e-6


def check_friction(law: FrictionLaw) -> None:
    """Raise ``AssertionError`` saying what is wrong with a law of friction; return quietly if nothing is.

    Examined: shapes, that it never drives, that a place at rest is held at least as well as one that begins to slip,
    derivatives against differences, and that nothing becomes infinite at rest.

    Examples
    --------
    >>> from softway.laws.friction import Coulomb
    >>> check_friction(Coulomb(mu=0.3))
    """
    speed, pressure = np.meshgrid([1e-3, 0.1, 0.37, 2.0], [0.1, 1.0, 30.0])
    value, slope, share = law.resistance(speed, pressure)
    for name, found in (("resistance", value), ("slope", slope), ("share", share), ("limit", law.limit(pressure))):
        require(found.shape == speed.shape, law, f"{name} of speeds {speed.shape} has shape {found.shape}")
    require(bool((value >= 0.0).all() and (law.limit(pressure) >= 0.0).all()), law, "it drives")
    still = law.resistance(np.zeros_like(speed), pressure)[0]
    require(bool(np.isfinite(still).all()), law, "the resistance at rest is not finite")
    require(bool((law.limit(pressure) >= still - 1e-12).all()), law, "slip is resisted more than rest")
    require(law.frictionless == (not value.any()), law, "frictionless is not told")
    up, down = (law.resistance(speed * (1.0 + d), pressure)[0] for d in (STEP, -STEP))
    close((up - down) / (2.0 * STEP * speed), slope, 1e-6, law, "the derivative to the speed is off", scale=1.0)
    up, down = (law.resistance(speed, pressure * (1.0 + d))[0] for d in (STEP, -STEP))
    close((up - down) / (2.0 * STEP * pressure), share, 1e-6, law, "the derivative to the pressure is off", scale=1.0)
