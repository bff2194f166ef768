"""D01: simple shear of a hypoelastic cell, for each of the objective rates against its closed form."""

import numpy as np
import pytest

import results
import softway as sw
from orders import order
from softway.typing import Array
from softway.verify.scenes.driving import RATES, sheared, square

YOUNGS, POISSON = 2.6, 0.3
"""Shear modulus 1."""
ROTATING = [name for name in RATES if name != "truesdell"]
NAMES = {"jaumann": "Jaumann", "green_naghdi": "Green-Naghdi", "log": "logarithmic", "truesdell": "Truesdell"}


def exact(rate: str, g: float) -> Array:
    """s11, s12 and s22 of unit shear modulus."""
    if rate == "truesdell":
        return np.array([g * g, g, 0.0])
    if rate == "green_naghdi":
        b = np.arctan(g / 2.0)
        c = np.log(np.cos(b))
        s12 = 2.0 * np.cos(2.0 * b) * (2.0 * b - 2.0 * np.tan(2.0 * b) * c - np.tan(b))
        s11 = 4.0 * (np.cos(2.0 * b) * c + b * np.sin(2.0 * b) - np.sin(b) ** 2)
    elif rate == "log":
        s12 = 4.0 * np.arcsinh(g / 2.0) / np.sqrt(4.0 + g * g)
        s11 = 0.5 * g * s12
    else:
        s11, s12 = 1.0 - np.cos(g), np.sin(g)
    return np.array([s11, s12, -s11])


def found(rate: str, g: float, steps: int = 200) -> Array:
    """Stress (3, 3) of one element driven in so many slabs."""
    memory = square(sw.Hypoelastic(E=YOUNGS, nu=POISSON, rate=RATES[rate])).history(sheared(g, steps))[-1]
    assert np.ptp(memory.stress, axis=0).max() < 1e-12
    return memory.stress[0]


def test_the_case() -> None:
    stress = {rate: found(rate, 5.0) for rate in NAMES}
    values = {f"{NAMES[rate]} s11, s12 at gamma=5": [s[0, 0], s[0, 1]] for rate, s in stress.items()}
    values["s33"] = max(abs(s[2, 2]) for s in stress.values())
    assert results.outside("D01", values) == set()


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("g", [1.0, 2.0, 4.0, 8.0])
def test_closed_forms(rate: str, g: float) -> None:
    """In 200 slabs, to four times the error that the case allows at gamma = 5."""
    s = found(rate, g)
    assert np.allclose([s[0, 0], s[0, 1], s[1, 1]], exact(rate, g), rtol=0.0, atol=1e-3)
    assert abs(s[2, 2]) < 1e-12
    table = results.case("D01")["reference"]["table"]
    for gamma, s11, s12 in table.get(rate, []):
        assert np.allclose(exact(rate, gamma)[:2], [s11, s12], rtol=1e-12)


@pytest.mark.parametrize("rate", ROTATING)
def test_the_error_is_of_second_order(rate: str) -> None:
    steps = np.array([50, 100, 200])
    errors = [np.abs(found(rate, 5.0, n)[[0, 0], [0, 1]] - exact(rate, 5.0)[:2]).max() for n in steps]
    assert order(errors, 1.0 / steps) == pytest.approx(2.0, abs=0.02)


def test_the_shear_of_truesdell_is_exact() -> None:
    """Its axes are those of the deformation: one slab is as good as many."""
    assert found("truesdell", 5.0, 1)[[0, 0, 1], [0, 1, 1]] == pytest.approx(exact("truesdell", 5.0), abs=1e-13)
