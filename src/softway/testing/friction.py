"""Checks of a friction law."""

import numpy as np

from softway.arrays import Array
from softway.laws.friction_law import FrictionLaw
from softway.testing.examination import Examination, require_all
from softway.testing.verdict import close, require

STEP = 1e-6
"""Relative step of the finite differences in speed and pressure."""


def check_friction(law: FrictionLaw) -> None:
    """Check a friction law; raise ``AssertionError`` with the first error found.

    Checked: array shapes, friction never drives the motion, the sticking limit is at least the resistance to slip,
    derivatives agree with finite differences, and all values are finite at rest.

    Examples
    --------
    >>> from softway.laws.friction import Coulomb
    >>> check_friction(Coulomb(mu=0.3))
    """
    require_all(law, FRICTION_LAW)


def _slips() -> tuple[Array, Array]:
    """Speeds [m/s] and pressures [Pa], arrays of the same shape."""
    speed, pressure = np.meshgrid([1e-3, 0.1, 0.37, 2.0], [0.1, 1.0, 30.0])
    return speed, pressure


def _shapes(law: FrictionLaw) -> float:
    (speed, pressure), worst = _slips(), 0.0
    answers = dict(zip(("resistance", "slope", "pressure slope"), law.resistance(speed, pressure), strict=True))
    one = (*law.resistance(speed[1, 2], pressure[1, 2]), law.limit(pressure[1, 2]))
    answers["limit"] = law.limit(pressure)
    for (name, found), single in zip(answers.items(), one, strict=True):
        require(np.shape(found) == speed.shape, law, f"{name} of speeds {speed.shape} has shape {np.shape(found)}")
        told = f"{name} of one place differs from {name} of an array"
        worst = max(worst, close(found[1, 2], single, 1e-14, law, told))
    return worst


def _opposes(law: FrictionLaw) -> float:
    speed, pressure = _slips()
    value = law.resistance(speed, pressure)[0]
    require(bool((value >= 0.0).all() and (law.limit(pressure) >= 0.0).all()), law, "it drives the motion")
    require(law.frictionless == (not value.any()), law, "frictionless contradicts the resistance")
    return 0.0


def _rests(law: FrictionLaw) -> float:
    speed, pressure = _slips()
    still = law.resistance(np.zeros_like(speed), pressure)[0]
    require(bool(np.isfinite(still).all()), law, "the resistance at rest is not finite")
    require(
        bool((law.limit(pressure) >= still * (1.0 - 1e-12)).all()),
        law,
        "the resistance to slip exceeds the limit at rest",
    )
    loose = law.resistance(np.zeros(1), np.zeros(1))[0]
    require(bool(np.isfinite(loose).all()), law, "the resistance at zero pressure is not finite")
    return 0.0


def _to_the_speed(law: FrictionLaw) -> float:
    speed, pressure = _slips()
    value, slope, _ = law.resistance(speed, pressure)
    up, down = (law.resistance(speed * (1.0 + d), pressure)[0] for d in (STEP, -STEP))
    told = "the derivative with respect to the speed is wrong"
    return close((up - down) / (2.0 * STEP), slope * speed, 1e-6, law, told, float(np.abs(value).max()))


def _to_the_pressure(law: FrictionLaw) -> float:
    speed, pressure = _slips()
    value, _, slope = law.resistance(speed, pressure)
    up, down = (law.resistance(speed, pressure * (1.0 + d))[0] for d in (STEP, -STEP))
    told = "the derivative with respect to the pressure is wrong"
    return close((up - down) / (2.0 * STEP), slope * pressure, 1e-6, law, told, float(np.abs(value).max()))


FRICTION_LAW = (
    Examination(name="single and array evaluation agree", look=_shapes, allowed=1e-14),
    Examination(name="friction opposes slip", look=_opposes),
    Examination(name="limit at rest is at least the resistance to slip", look=_rests),
    Examination(name="derivative with respect to the speed", look=_to_the_speed, allowed=1e-6),
    Examination(name="derivative with respect to the pressure", look=_to_the_pressure, allowed=1e-6),
)
