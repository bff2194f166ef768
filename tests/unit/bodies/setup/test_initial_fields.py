"""Initial fields at the nodes."""

import numpy as np
import pytest

from softway.bodies.setup.initial_fields import Affine, FieldSum, OnTag, Profile, Uniform, sample
from softway.errors import InputError
from softway.meshes.generators.shapes import box, interval, rectangle

PLATE = rectangle((2.0, 1.0), (2, 1))


def test_uniform() -> None:
    assert sample(Uniform(), box((1.0, 1.0, 1.0), (1, 1, 1))).tolist() == [[0.0] * 3] * 8
    assert sample(Uniform(value=(1.0, 2.0)), PLATE).tolist() == [[1.0, 2.0]] * 6
    assert sample(Uniform(value=(3.0,)), interval(1.0, 1)).tolist() == [[3.0], [3.0]]


def test_affine() -> None:
    spin = Affine(value=(5.0, 0.0), gradient=((0.0, -2.0), (2.0, 0.0)), origin=(1.0, 0.5))
    x = PLATE.points
    assert np.abs(sample(spin, PLATE) - np.column_stack([5 - 2 * (x[:, 1] - 0.5), 2 * (x[:, 0] - 1)])).max() < 1e-15


def test_profile() -> None:
    scalar = sample(Profile(axis="y", at=(0.0, 1.0), values=(1.0, 3.0)), PLATE)
    assert scalar.tolist() == [[0.0, 1.0]] * 3 + [[0.0, 3.0]] * 3
    vector = sample(Profile(axis="x", at=(0.0, 1.0), values=((0.0, 1.0), (2.0, 1.0))), PLATE)
    assert vector[:3].tolist() == [[0.0, 1.0], [2.0, 1.0], [2.0, 1.0]]


def test_tag_and_sum() -> None:
    both = FieldSum(terms=(Uniform(value=(1.0, 0.0)), OnTag(tag="top", value=(0.0, 2.0))))
    assert sample(both, PLATE).tolist() == [[1.0, 0.0]] * 3 + [[1.0, 2.0]] * 3


def test_arrays_and_functions() -> None:
    values = np.arange(12.0).reshape(6, 2)
    found = sample(values, PLATE)
    assert found.tolist() == values.tolist() and found is not values
    assert sample(lambda x: 2.0 * x, PLATE).tolist() == (2.0 * PLATE.points).tolist()
    assert sample(np.array([1.0, -2.0]), PLATE).tolist() == [[1.0, -2.0]] * 6


@pytest.mark.parametrize(
    ("field", "where"),
    [
        (Uniform(value=1.0), "value"),
        (Uniform(value=(1.0, 2.0, 3.0)), "value"),
        (Uniform(value=(1.0, float("nan"))), "value"),
        (Affine(gradient=1.0), "gradient"),
        (Affine(origin=(1.0,)), "origin"),
        (Profile(axis="z", at=(0.0,), values=(1.0,)), "axis"),
        (Profile(at=(0.0, 0.0), values=(1.0, 2.0)), "at"),
        (Profile(at=(0.0, 1.0), values=(1.0,)), "at"),
        (Profile(at=(0.0,), values=((1.0,),)), "values[0]"),
        (OnTag(tag="tip", value=(0.0, 0.0)), "tag"),
        (np.zeros((2, 2)), ""),
        (lambda x: np.full_like(x, np.inf), ""),
    ],
)
def test_wrong_fields_name_the_place(field, where: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        sample(field, PLATE)
    assert caught.value.where == where
