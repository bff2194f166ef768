"""Initial displacement under supports: refused where it is fixed, kept where it is driven."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.setup.initial_fields import Affine, Uniform
from softway.bodies.solid import Driven, Fixed, Solid
from softway.errors import InputError
from softway.meshes.generators.shapes import rectangle
from softway.model import AsGiven, StaticStart
from softway.model.build import build
from softway.model.scene import Scene


def square(**changes: object) -> Solid:
    """Plate of 2 by 1."""
    given = {"mesh": rectangle((2.0, 1.0), (4, 2)), "material": sw.LinearElastic(E=2.0), "density": 3.0}
    return Solid(**{**given, **changes})


def sheared(x: Array) -> Array:
    """Displacement (n, 2) that is zero on the left, and along y on the bottom."""
    return 0.1 * np.stack([x[:, 0], x[:, 0] * x[:, 1]], axis=1)


@pytest.mark.parametrize("start", [AsGiven(), StaticStart()])
def test_displacement_under_a_support_is_refused_where_it_is_fixed_and_kept_where_it_is_driven(start: object) -> None:
    moved = Uniform(value=(0.1, 0.2))
    fixed = Fixed(on="bottom", components="y"), Fixed(on="left", components="x")
    with pytest.raises(
        InputError, match=r"0.2 m along y at node 0, which supports\[0\] on 'bottom' holds at zero; 5 in"
    ):
        build(Scene(bodies={"a": square(supports=fixed, displacement=moved)}, start=start))
    driven = tuple(Driven(on=s.on, components=s.components, velocity=0.0) for s in fixed)  # the remedy
    model = build(Scene(bodies={"a": square(supports=driven, displacement=moved)}, start=start))
    assert (model.displacement == [0.1, 0.2]).all() and not model.free.all()
    zero = build(Scene(bodies={"a": square(supports=fixed, displacement=sheared)}, start=start))  # the other one
    assert zero.displacement[zero.free].any() and not zero.displacement[~zero.free].any()


def test_driven_component_under_a_fixed_support_keeps_its_displacement() -> None:
    both = Fixed(on="left"), Driven(on="left", components="x", velocity=1.0)
    lifted = Affine(value=(0.1, 0.0), gradient=((0.5, 0.0), (0.0, 0.0)))
    model = build(Scene(bodies={"a": square(supports=both, displacement=lifted)}))
    assert model.displacement[model.meshes["a"].nodes("left")].tolist() == [[0.1, 0.0]] * 3


def test_rounding_of_a_displacement_under_a_support_is_taken_as_zero() -> None:
    nearly = Affine(value=(1e-15, 0.0), gradient=((0.5, 0.0), (0.0, 0.0)))
    model = build(Scene(bodies={"a": square(supports=(Fixed(on="left"),), displacement=nearly)}))
    assert not model.displacement[model.meshes["a"].nodes("left")].any()


def test_body_held_displaced_all_around_stays_so_without_inertia() -> None:
    """A sheet of one inner node; the displacement under the support was dropped."""
    mesh = rectangle((1.0, 1.0), (2, 2))
    pulled = Affine(gradient=((0.1, 0.0), (0.0, 0.0)))
    held = Driven(on="surface", velocity=0.0)
    body = square(mesh=mesh, material=sw.laws.Hypoelastic(E=1.0), supports=(held,), displacement=pulled)
    run = sw.run(sw.Scenario(bodies={"a": body}, time=sw.Time(end=1.0, step=0.5), inertia=sw.bodies.Off()))
    assert run.stop.reason == "done"
    last = run.fields[len(run.fields) - 1]
    assert last.displacement[:, 0] == pytest.approx(0.1 * mesh.points[:, 0], abs=1e-12)
    assert last.stress[:, 0].min() > 0.09  # about E times the strain
