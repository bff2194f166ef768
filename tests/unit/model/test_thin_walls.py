"""Scenes with walls one cell thick: what the model is made of, ties and supports, and runs from a scenario file."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from records import differences
from softway.bodies import Fixed, OnTag
from softway.meshes.generators.shapes import rectangle
from softway.obstacles import HalfSpace

TEXT = """
[bodies.frame]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1, 0.1], cells = [8, 1], origin = [0, 0.02] }
material = { kind = "NeoHookean", E = 10, nu = 0.3 }
density = 1
velocity = [0, -0.2]

[bodies.glass]
kind = "Solid"
mesh = { kind = "Rectangle", size = [0.8, 0.1], cells = [10, 1], origin = [0.1, 0.12] }
material = { kind = "NeoHookean", E = 20, nu = 0.3 }
density = 2
velocity = [0, -0.2]

[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0], normal = [0.1, 1] }

[[contacts]]
between = "all"
friction = { kind = "Coulomb", mu = 0.2 }
TIES
[time]
end = 0.6
step = 0.02
"""
FREE = TEXT.replace("TIES", "")
TIED = TEXT.replace("TIES", '[[ties]]\nbetween = ["frame.top", "glass.bottom"]\n')
TIED = TIED.replace("[10, 1]", "[8, 1]").replace(
    "cells = [8, 1], origin = [0, 0.02]", "cells = [10, 1], origin = [0, 0.02]"
)


def scene(solid: sw.Solid, between: str = "a", timing: object = None, **changes: object) -> sw.Scene:
    contact = sw.Contact(between=(between, "floor"), **({} if timing is None else {"timing": timing}))
    floor = sw.Tool(shape=HalfSpace(point=(0.0, -1.0), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"a": solid, "floor": floor}, contacts=(contact,), **changes)


def strip(**changes: object) -> sw.Solid:
    given = {"mesh": rectangle((2.0, 0.1), (8, 1)), "material": sw.LinearElastic(E=1.0, nu=0.3), "density": 3.0}
    return sw.Solid(**{**given, **changes})


@pytest.mark.parametrize(
    "whole",
    [
        scene(strip(), timing=sw.contact.Impulse()),
        scene(strip(supports=(Fixed(on="left"),)), inertia=sw.bodies.Off()),
        scene(strip(), between="a.left"),
        sw.Scene(bodies={"a": strip()}),
        scene(strip(mesh=rectangle((2.0, 0.1), (8, 1), cell="quad9"))),
    ],
    ids=["nodes with mass", "no inertia", "one end", "no contact", "quadratic"],
)
def test_meshes_stay_where_no_mass_is_in_the_way(whole: sw.Scene) -> None:
    solid = whole.bodies["a"]
    assert isinstance(solid, sw.Solid) and isinstance(solid.mesh, sw.Mesh)
    assert sw.build(whole).meshes["a"].n_nodes == solid.mesh.n_nodes


def test_nodes_between_start_like_the_faces() -> None:
    """Fields by formula, by tag or by nodes; supports hold the nodes between those that they hold."""
    mesh = rectangle((2.0, 0.1), (8, 1)).with_tag("half", lambda x: x[:, 0] > 0.9)
    expected = None
    for velocity in (
        OnTag(tag="half", value=(0.0, 2.0)),
        np.where(mesh.points[:, :1] > 0.9, [[0.0, 2.0]], 0.0),
        lambda x: np.where(x[:, :1] > 0.9, [[0.0, 2.0]], 0.0),
    ):
        model = sw.build(scene(strip(mesh=mesh, velocity=velocity, supports=(Fixed(on="left"),))))
        expected = model.velocity if expected is None else expected
        np.testing.assert_array_equal(model.velocity, expected)
        assert not model.free[model.points[:, 0] == 0.0].any()
    assert (model.velocity[model.points[:, 0] > 0.9] == [0.0, 2.0]).all()


def test_inner_nodes_of_a_tag_cannot_touch() -> None:
    """Nodes of a tag inside the body, such as those between the faces in ``all``, are no contact nodes."""
    model = sw.build(scene(strip(), between="a.all"))
    assert set(model.touchable) == set(model.meshes["a"].nodes("surface"))


def test_a_glued_face_keeps_its_mass() -> None:
    """Glue and its neighbours keep their inertia; the wall is divided all the same, as its other face may touch."""
    low, high = (strip(mesh=rectangle((2.0, 0.1), (8, 1), origin=(0.0, y))) for y in (0.0, 0.1))
    whole = scene(low, between="a.bottom")
    tied = sw.Scene(
        bodies={**whole.bodies, "b": high}, contacts=whole.contacts, ties=(sw.Tie(between=("a.top", "b.bottom")),)
    )
    model = sw.build(tied)
    y = model.points[:, 1]
    assert model.meshes["a"].n_nodes == 27 and model.meshes["b"].n_nodes == 18
    assert not model.massive[y < 0.04].any() and model.massive[y > 0.04].all()
    assert model.mass.sum() == pytest.approx(2 * 0.6, rel=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("text", [FREE, TIED], ids=["free", "tied"])
def test_a_run_holds_its_balances_and_is_resumed_with_the_same_bits(text: str, tmp_path: Path) -> None:
    whole = sw.run(sw.loads(text), tmp_path / "whole")
    assert not any(whole.events["finding"])
    assert abs(whole.history["energy_error"]).max() < 1e-12
    assert whole.history["momentum_y"][-1] > whole.history["momentum_y"][0]
    left = iter(range(60))
    with pytest.raises(sw.Cancelled):
        sw.run(sw.loads(text), tmp_path / "run", cancel=lambda: next(left, None) is None)
    assert 0 < sw.Run(tmp_path / "run").summary["slabs"] < whole.summary["slabs"]
    assert differences(sw.resume(tmp_path / "run").path, whole.path) == []


def test_the_check_says_that_walls_are_divided() -> None:
    found = sw.check(sw.loads(FREE))
    notes = [note for note in found.notes if "one cell thick" in note.problem]
    assert [note.where for note in notes] == ["bodies.frame.mesh", "bodies.glass.mesh"]
    assert "9 more nodes at half their thickness" in notes[0].problem
    assert "with 16 cells in place of 8" in notes[0].problem
    assert notes[0].problem.endswith("moments of inertia are 0.99 times those of the body")
    assert found.bodies["frame"].cells == 16
    twice = FREE.replace("cells = [8, 1]", "cells = [8, 2]").replace("cells = [10, 1]", "cells = [10, 2]")
    assert not [note for note in sw.check(sw.loads(twice)).notes if "one cell thick" in note.problem]
