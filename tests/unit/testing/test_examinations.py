"""The examinations pass what is right and name what is wrong."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.laws.strain_measures import Green, Small
from softway.meshes.cells import CELLS
from softway.meshes.element import element, tabulate
from softway.testing import check_element, check_law
from softway.testing.elements import irregular_patch


@pytest.mark.parametrize("cell", [name for name, cell in CELLS.items() if cell.dim > 0])
def test_elements_pass(cell: str) -> None:
    check_element(cell)


@pytest.mark.parametrize("cell", ["bar3", "tri6", "hex8"])
def test_patch_is_irregular(cell: str) -> None:
    mesh = irregular_patch(cell)
    corners = mesh.points[mesh.blocks[cell][:, : CELLS[cell].corners]]
    assert np.std(np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)) > 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Altered:
    """A neo-Hookean law with one mistake."""

    mistake: str
    measure: ClassVar[Green] = Green()
    linear: ClassVar[bool] = False

    def energy(self, E: Array) -> Array:
        W = NeoHookean(E=1.0, nu=0.3).energy(E)
        return W + 1.0 if self.mistake == "offset" else W

    def stress(self, E: Array) -> Array:
        S = NeoHookean(E=1.0, nu=0.3).stress(E)
        return 1.001 * S if self.mistake == "stress" else S

    def tangent(self, E: Array) -> Array:
        C = NeoHookean(E=1.0, nu=0.3).tangent(E)
        return {"tangent": 1.001 * C, "shape": C[..., 0]}.get(self.mistake, C)

    def wave_speed(self, density: float) -> float:
        return NeoHookean(E=1.0, nu=0.3).wave_speed(density) * (2.0 if self.mistake == "speed" else 1.0)

    def youngs(self) -> float:
        return 2.0 if self.mistake == "youngs" else 1.0


@pytest.mark.parametrize(
    ("mistake", "complaint"),
    [
        ("offset", "energy of the undeformed state is 1"),
        ("stress", "stress is not the derivative of the energy"),
        ("tangent", "tangent is not the derivative of the stress"),
        ("shape", "tangent of strains"),
        ("speed", "wave_speed contradicts the tangent"),
        ("youngs", "youngs contradicts the tangent"),
    ],
)
def test_mistakes_are_named(mistake: str, complaint: str) -> None:
    with pytest.raises(AssertionError, match=complaint):
        check_law(Altered(mistake=mistake))


def test_altered_without_mistake_passes() -> None:
    check_law(Altered(mistake=""))


@dataclass(frozen=True, slots=True, kw_only=True)
class Digitless:
    """Logarithmic energy of a volume change, correct but written as a difference of numbers near one."""

    measure: ClassVar[Green] = Green()
    linear: ClassVar[bool] = False

    def energy(self, E: Array) -> Array:
        C = np.eye(3) + 2.0 * E
        return 0.5 * (tensors.trace(C) - 3.0 - np.log(tensors.determinant(C)))

    def stress(self, E: Array) -> Array:
        return np.eye(3) - tensors.symmetric_inverse(np.eye(3) + 2.0 * E)

    def tangent(self, E: Array) -> Array:
        return 2.0 * tensors.square_symmetric(tensors.symmetric_inverse(np.eye(3) + 2.0 * E))

    def wave_speed(self, density: float) -> float:
        return float(np.sqrt(2.0 / density))

    def youngs(self) -> float:
        return 2.0


def test_lost_digits_are_named() -> None:
    with pytest.raises(AssertionError, match="is inaccurate"):
        check_law(Digitless())


@dataclass(frozen=True, slots=True, kw_only=True)
class Renamed:
    """Hooke's law that claims another strain measure or linearity."""

    measure: Small | Green
    linear: bool

    def energy(self, E: Array) -> Array:
        return LinearElastic(E=1.0, nu=0.3).energy(E)

    def stress(self, E: Array) -> Array:
        return LinearElastic(E=1.0, nu=0.3).stress(E)

    def tangent(self, E: Array) -> Array:
        return LinearElastic(E=1.0, nu=0.3).tangent(E)

    def wave_speed(self, density: float) -> float:
        return LinearElastic(E=1.0, nu=0.3).wave_speed(density)

    def youngs(self) -> float:
        return 1.0


def test_a_linear_law_in_greens_strain_is_named() -> None:
    with pytest.raises(AssertionError, match="a linear law must use the small strain as its measure"):
        check_law(Renamed(measure=Green(), linear=True))
    check_law(Renamed(measure=Small(), linear=True))
    check_law(Renamed(measure=Green(), linear=False))


@pytest.mark.parametrize(
    ("values", "slopes", "complaint"),
    [
        (1.001, 1.0, "shape functions do not add up to one"),
        (1.0, 1.001, "gradients along coordinate 0"),
    ],
)
def test_wrong_tables_are_named(monkeypatch: pytest.MonkeyPatch, values: float, slopes: float, complaint: str) -> None:
    def wrong(cell: str, points: Array) -> tuple[Array, Array]:
        N, dN = tabulate(cell, points)
        return values * N, slopes * dN

    monkeypatch.setattr("softway.testing.elements.tabulate", wrong)
    with pytest.raises(AssertionError, match=complaint):
        check_element("quad4")


def test_too_weak_a_quadrature_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """One point in a quad4 leaves hourglasses without energy and squares without their integral."""
    monkeypatch.setattr("softway.testing.elements.element", lambda cell, degree=None: element(cell, 1))
    with pytest.raises(AssertionError, match="not integrated exactly"):
        check_element("quad4")
    monkeypatch.undo()
    monkeypatch.setattr("softway.bodies.elements.quadrature.stiffness_degree", lambda cell: 1)
    with pytest.raises(AssertionError, match="zero-energy modes"):
        check_element("quad4")
