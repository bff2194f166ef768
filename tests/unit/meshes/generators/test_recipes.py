"""Recipes build what the shapes build."""

from pathlib import Path

import pytest

from softway.errors import InputError
from softway.meshes.generators.recipes import Ball, Box, Cylinder, Disc, Interval, MeshFile, Rectangle


def test_recipes_build() -> None:
    assert Interval(length=2.0, cells=2, origin=1.0).build().points.ravel().tolist() == [1.0, 2.0, 3.0]
    assert Interval(length=2.0, cells=1, direction=(0.0, 0.0, 1.0)).build().points.tolist() == [[0, 0, 0], [0, 0, 2]]
    assert Interval(length=2.0, cells=1, dim=2, origin=(1.0, 1.0)).build().points.tolist() == [[1, 1], [3, 1]]
    assert Rectangle(size=(1.0, 1.0), cells=(2, 2), cell="tri6").build().n_nodes == 25
    assert Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 1), origin=(1.0, 1.0, 1.0)).build().points.min() == 1.0
    assert Disc(radius=1.0, cells=4).build().n_nodes == 17
    assert Cylinder(radius=1.0, height=1.0, cells=(4, 1)).build().n_nodes == 34
    assert Ball(radius=1.0, cells=2, cell="tet4").build().n_nodes == 27
    assert MeshFile(path=Path(__file__).parents[4] / "scenarios" / "bracket.msh", unit="mm").build().edge() < 0.01


@pytest.mark.parametrize(
    ("recipe", "where"),
    [
        (Interval(length=-2.0, cells=2), "length"),
        (Rectangle(size=(1.0, -1.0), cells=(1, 1)), "size"),
        (Box(size=(1.0, 1.0, 1.0), cells=(1, 0, 1)), "cells"),
        (Disc(radius=0.0, cells=4), "radius"),
        (MeshFile(path="none.msh"), "path"),
        (MeshFile(path="none.msh", unit="parsec"), "unit"),
    ],
)
def test_wrong_recipes_name_the_field(recipe, where: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        recipe.build()
    assert caught.value.where == where
