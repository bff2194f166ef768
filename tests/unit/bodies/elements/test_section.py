"""Sections: measures, defaults, wave speeds, and what does not fit."""

from math import pi, sqrt

import numpy as np
import pytest

from softway.bodies.elements.section import (
    Axisymmetric,
    Bar,
    PlaneStrain,
    PlaneStress,
    Section,
    Volume,
    check_section,
    default_section,
    derivatives,
    row_flux,
    row_moduli,
    wave_speed,
)
from softway.errors import InputError
from softway.laws.bulk import LinearElastic, NeoHookean, StVenantKirchhoff
from softway.laws.law import StoredEnergy
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh


@pytest.mark.parametrize(
    ("section", "point", "measure"),
    [
        (Bar(area=2.0), (3.0,), 2.0),
        (PlaneStrain(thickness=0.5), (3.0, 1.0), 0.5),
        (PlaneStress(thickness=0.1), (3.0, 1.0), 0.1),
        (Axisymmetric(), (3.0, 1.0), 6.0 * pi),
        (Volume(), (3.0, 1.0, 2.0), 1.0),
    ],
)
def test_measure(section: Section, point: tuple[float, ...], measure: float) -> None:
    assert np.allclose(section.measure(np.array([[point, point]])), [[measure, measure]], rtol=1e-15)


@pytest.mark.parametrize(
    ("mesh", "section"),
    [
        (interval(1.0, cells=1), Bar()),
        (rectangle((1.0, 1.0), (1, 1), cell="tri3"), PlaneStrain()),
        (box((1.0, 1.0, 1.0), (1, 1, 1)), Volume()),
    ],
)
def test_default(mesh: Mesh, section: Section) -> None:
    assert default_section(mesh) == section


@pytest.mark.parametrize("kind", [LinearElastic, StVenantKirchhoff, NeoHookean])
@pytest.mark.parametrize(
    ("section", "modulus"),
    [(Bar(), 3.0), (PlaneStress(), 3.125), (PlaneStrain(), 10 / 3), (Axisymmetric(), 10 / 3), (Volume(), 10 / 3)],
)
def test_wave_speed(kind: type[StoredEnergy], section: Section, modulus: float) -> None:
    """E = 3, nu = 0.2: E/(1 - nu^2) = 3.125, lambda + 2 mu = E (1 - nu)/((1 + nu)(1 - 2 nu)) = 10/3."""
    assert wave_speed(kind(E=3.0, nu=0.2), 4.0, section) == pytest.approx(sqrt(modulus / 4.0), rel=1e-13)


@pytest.mark.parametrize(
    ("mesh", "section"),
    [
        (interval(1.0, cells=1), PlaneStrain()),
        (rectangle((1.0, 1.0), (1, 1), cell="quad4"), Bar()),
        (rectangle((1.0, 1.0), (1, 1), cell="quad4"), Volume()),
        (rectangle((1.0, 1.0), (1, 1), cell="quad4", origin=(-0.5, 0.0)), Axisymmetric()),
    ],
)
def test_what_does_not_fit_is_refused(mesh: Mesh, section: Section) -> None:
    with pytest.raises(InputError) as error:
        check_section(mesh, section)
    assert error.value.where == "section"
    assert error.value.remedy


@pytest.mark.parametrize(("kind", "field"), [(Bar, "area"), (PlaneStrain, "thickness"), (PlaneStress, "thickness")])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_impossible_measures_are_refused(kind: type, field: str, value: float) -> None:
    with pytest.raises(InputError) as error:
        kind(**{field: value})
    assert error.value.where == field


@pytest.mark.parametrize("section", [PlaneStrain(), Axisymmetric()])
def test_flux_and_moduli_are_transposed_to_the_derivatives(section: Section) -> None:
    rng = np.random.default_rng(7)
    A, B = rng.standard_normal((2, 4, 3 if isinstance(section, Axisymmetric) else 2, 2))
    H, G = derivatives(section, A), derivatives(section, B)
    Q, D = rng.standard_normal(H.shape), rng.standard_normal((*H.shape, *H.shape[1:]))
    assert np.sum(row_flux(section, Q) * A) == pytest.approx(np.sum(Q * H), rel=1e-13)
    sampled = np.einsum("prisj,pri,psj->p", row_moduli(section, D), A, B)
    assert np.allclose(sampled, np.einsum("prisj,pri,psj->p", D, H, G), rtol=1e-12)
