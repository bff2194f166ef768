"""The stability limit of a slab."""

from collections.abc import Callable
from math import inf, sqrt

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh

from softway.bodies.bulk_viscosity import BulkViscosity
from softway.bodies.inertia.mass_matrix import Consistent, Lumped
from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.laws.bulk import LinearElastic
from softway.meshes.generators.shapes import interval
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.model.time_weight import Collocation, EndPeaks, Momentum
from softway.solve import stable_step as stability
from softway.solve.methods.central_difference import Explicit
from softway.solve.stable_step import greatest_frequency, require_stable, stable_step


@pytest.mark.parametrize(("mass", "factor"), [(Consistent(), 2 * sqrt(3)), (Lumped(), 2.0)])
@pytest.mark.parametrize("cells", [5, 40])
def test_a_bar_of_equal_cells(bar: Callable[..., Model], mass: object, factor: float, cells: int) -> None:
    """Free bar: the highest mode is the zigzag, omega = 2 sqrt(3) c / dx consistent, 2 c / dx lumped."""
    model = bar(cells, mass=mass)
    assert greatest_frequency(model, model.displacement) == pytest.approx(factor * cells, rel=1e-12)


def test_massless_nodes_are_condensed(block: Callable[..., Model]) -> None:
    model = block()
    assert not model.massive.all()
    heavy = np.repeat(model.massive, 2)
    k = model.tangent(model.displacement).toarray()
    mass = sp.kron(model.mass, sp.eye_array(2)).toarray()[np.ix_(heavy, heavy)]
    cross = k[np.ix_(heavy, ~heavy)]
    condensed = k[np.ix_(heavy, heavy)] - cross @ np.linalg.solve(k[np.ix_(~heavy, ~heavy)], cross.T)
    expected = sqrt(eigh(condensed, mass, eigvals_only=True)[-1])
    assert greatest_frequency(model, model.displacement) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", ["bar", "block"])
def test_the_iterative_way_agrees_with_the_dense_one(
    name: str, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    make: Callable[..., Model] = request.getfixturevalue(name)
    model = make(30) if name == "bar" else make(6)
    dense = greatest_frequency(model, model.displacement)
    monkeypatch.setattr(stability, "DENSE", 0)
    assert greatest_frequency(model, model.displacement) == pytest.approx(dense, rel=1e-5)


def test_the_step_of_a_bar_is_the_courant_number_of_the_weight(bar: Callable[..., Model]) -> None:
    model = bar(10)
    assert stable_step(model, model.displacement, Momentum()) == pytest.approx(0.1, rel=1e-12)
    assert stable_step(model, model.displacement, Collocation()) == pytest.approx(0.1 * sqrt(2 / 3), rel=1e-12)
    assert stable_step(model, model.displacement, EndPeaks()) == inf


def test_the_most_viscous_body_shortens_the_step_of_central_differences() -> None:
    """By ``sqrt(1 + b^2) - b`` with its linear bulk viscosity b; two lumped bars of equal cells (Belytschko et al.)."""
    bars = {
        f"bar {b}": Solid(
            mesh=interval(1.0, 10), material=LinearElastic(E=1.0), density=1.0, mass=Lumped(),
            shock=BulkViscosity(linear=b),
        )
        for b in (0.1, 0.75, 0.2)
    }  # fmt: skip
    model = build(Scene(bodies=bars))
    assert stable_step(model, model.displacement, Explicit()) == pytest.approx(0.1 * (1.25 - 0.75), rel=1e-12)


def test_beyond_the_limit_of_central_differences_the_fixed_point_is_the_remedy(bar: Callable[..., Model]) -> None:
    model = bar(10, mass=Lumped())
    require_stable(model, model.displacement, Explicit(), 0.1)
    with pytest.raises(InputError, match="limit 0.1 s of Explicit") as error:
        require_stable(model, model.displacement, Explicit(), 0.101)
    assert "FixedPoint" in error.value.remedy


def test_a_step_beyond_the_limit_is_refused_by_its_number(bar: Callable[..., Model]) -> None:
    model = bar(10)
    require_stable(model, model.displacement, Momentum(), 0.1)
    require_stable(model, model.displacement, EndPeaks(), 1e6)
    with pytest.raises(InputError) as error:
        require_stable(model, model.displacement, Momentum(), 0.101)
    assert error.value.where == "time.step"
    assert "0.101 s" in error.value.problem
    assert "limit 0.1 s of Momentum" in error.value.problem
    assert "0.1 s" in error.value.remedy
    assert "EndPeaks" in error.value.remedy


def test_a_weight_that_always_grows_is_refused(bar: Callable[..., Model]) -> None:
    model = bar(2)
    with pytest.raises(InputError) as error:
        require_stable(model, model.displacement, Collocation(at=(0.4,)), 1e-9)
    assert error.value.where == "time.weight"
