"""The examinations of friction name what is wrong."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from softway.testing import check_law, examine_law
from softway.units import Pure


@dataclass(frozen=True, slots=True, kw_only=True)
class Altered:
    """Friction that grows with the speed, with one mistake."""

    mu: Pure = 0.3
    mistake: str = ""
    frictionless: ClassVar[bool] = False

    def limit(self, pressure):
        return (0.5 if self.mistake == "weak" else 1.0) * self.mu * pressure

    def resistance(self, speed, pressure):
        speed, pressure = (np.asarray(a, float) for a in np.broadcast_arrays(speed, pressure))
        sign = -1.0 if self.mistake == "drives" else 1.0
        value = sign * self.mu * pressure * (1.0 + speed)
        slope = sign * self.mu * pressure * (2.0 if self.mistake == "speed" else 1.0)
        pressure_slope = sign * self.mu * (1.0 + speed) * (2.0 if self.mistake == "pressure" else 1.0)
        if self.mistake == "shape":
            return value, slope, pressure_slope[..., None]
        if self.mistake == "infinite":
            return value + np.where(speed > 0.0, 0.0, np.inf), slope, pressure_slope
        return value, slope, pressure_slope


@pytest.mark.parametrize(
    ("mistake", "complaint"),
    [
        ("drives", "it drives"),
        ("weak", "the resistance to slip exceeds the limit at rest"),
        ("speed", "the derivative with respect to the speed is wrong"),
        ("pressure", "the derivative with respect to the pressure is wrong"),
        ("shape", "pressure slope of speeds .3, 4. has shape"),
        ("infinite", "the resistance at rest is not finite"),
    ],
)
def test_mistakes_are_named(mistake: str, complaint: str) -> None:
    with pytest.raises(AssertionError, match=complaint):
        check_law(Altered(mistake=mistake))
    assert sum(not found.passed for found in examine_law(Altered(mistake=mistake))) >= 1


def test_without_a_mistake_it_passes() -> None:
    check_law(Altered())
