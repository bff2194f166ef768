"""Bodies that overlap at the start: which nodes are looked at, and from which depth on."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.marching.start.initial_state import initial_state
from softway.meshes.generators.shapes import rectangle

LAW = sw.LinearElastic(E=1.0, nu=0.3)


def pointed(depth: float, *, cell: str = "quad4", first: str = "low") -> sw.Scene:
    """A block of four by four cells whose lower corner is ``depth`` below the top, at 2, of a larger block."""
    turn = sw.bodies.Rotation(angle=0.25 * np.pi)  # about the centre of the block, at 0.5
    place = sw.bodies.Placement(rotations=(turn,), translation=(0.75, 0.0), bottom=2.0 - depth)
    low = sw.meshes.Rectangle(size=(2.0, 2.0), cells=(4, 4), cell=cell)
    high = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4))
    between = ("low", "high") if first == "low" else ("high", "low")
    return sw.Scene(
        bodies={
            "low": sw.Solid(mesh=low, material=LAW, density=1.0),
            "high": sw.Solid(mesh=high, material=LAW, density=1.0, place=place),
        },
        contacts=(sw.Contact(between=between),),
    )


def problem(scene: sw.Scene) -> str:
    """What a march says of its start; nothing if it begins."""
    try:
        next(iter(sw.march(scene, until=0.01, step=0.01)))
    except sw.InputError as refused:
        return refused.problem
    return ""


@pytest.mark.parametrize("first", ["low", "high"])
def test_a_corner_inside_a_face_is_found_whichever_body_comes_first(first: str) -> None:
    """The corner is the only node inside another body: the nodes beside it on the face are 0.25 away."""
    found = problem(pointed(0.1, first=first))
    assert "'high' starts 0.1 m inside 'low'" in found
    assert "(1.25, 1.9)" in found


@pytest.mark.parametrize(
    ("cell", "depth", "refused"),
    [
        ("quad4", 0.001, True),
        ("quad8", 0.006, True),
        ("quad9", 0.004, False),
        ("quad9", 0.006, True),
        ("tri6", 0.006, True),
    ],
)
def test_a_fiftieth_of_an_edge_is_no_overlap_where_facets_may_be_curved(cell: str, depth: float, refused: bool) -> None:
    """Of the edges of the block with the corner, 0.25: flat pieces stand for curved facets there."""
    assert ("'high' starts" in problem(pointed(depth, cell=cell))) == refused


@pytest.mark.parametrize(("dim", "depth"), [(1, 0.3), (1, 0.08), (2, 0.08)])
def test_a_press_fit_may_be_about_as_deep_as_the_cells(dim: int, depth: float) -> None:
    """Two bars of one metre and ten cells, each held at its far end, overlap: each gives way by the half."""
    law, supported = sw.LinearElastic(E=2.0, nu=0.0), {"one": "left", "two": "right"}
    bars = {
        name: sw.Solid(
            mesh=sw.meshes.Interval(length=1.0, cells=10)
            if dim == 1
            else sw.meshes.Rectangle(size=(1.0, 1.0), cells=(10, 10)),
            material=law,
            density=1.0,
            supports=(sw.Fixed(on=end),),
            place=sw.bodies.Placement(translation=(0.0 if name == "one" else 1.0 - depth,) + (0.0,) * (dim - 1)),
        )
        for name, end in supported.items()
    }
    contact = sw.Contact(between=("one.right", "two.left"), name="fit", start="fit")
    step = next(iter(sw.march(sw.Scene(bodies=bars, contacts=(contact,)), until=0.01, step=0.01)))
    moved = {name: u[:, 0] for name, u in step.before.displacement.items()}
    assert moved["one"].min() == pytest.approx(-0.5 * depth, rel=1e-9)
    assert moved["two"].max() == pytest.approx(0.5 * depth, rel=1e-9)
    assert step.before.pressure["fit"].sum() == pytest.approx(2.0 * 0.5 * depth, rel=1e-9)


def pressed_blocks(depth: float, cells: tuple[int, int], method: object, start: str = "fit") -> sw.Scene:
    """Two unit blocks between fixed plates, the upper one ``depth`` inside of the lower one."""

    def block(n: int, y: float, plate: str, *more: object) -> sw.Solid:
        mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(n, n), origin=(0.0, y))
        supports = more or (sw.Fixed(on=plate),)
        return sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0, nu=0.0), density=1.0, supports=supports)

    down = (sw.Driven(on="top", components="y", velocity=-0.3), sw.Driven(on="top", components="x", velocity=0.0))
    low = block(cells[0], 0.0, "bottom")
    high = block(cells[1], 1.0 - depth, "top", *(down if start == "apart" else ()))
    contact = sw.Contact(between=("high.bottom", "low.top"), start=start, method=method, name="c")
    return sw.Scene(bodies={"low": low, "high": high}, contacts=(contact,), inertia=sw.bodies.Off())


NODES = sw.contact.NodeToSurface()


@pytest.mark.parametrize(("method", "cells"), [(None, (4, 5)), (None, (8, 9)), (NODES, (2, 3)), (NODES, (8, 9))])
def test_a_press_fit_deeper_than_a_cell_is_refused(method: object, cells: tuple[int, int]) -> None:
    """Nodes in contact with facets gave a force of 0.126 in place of 0.15; mortar ended without equilibrium."""
    model = sw.build(pressed_blocks(0.3, cells, method))
    with pytest.raises(InputError, match=r"'fit' with '(low|high)' 0.3 m inside '(low|high)', in cells of") as caught:
        initial_state(model)
    assert caught.value.where == "contacts[0].start"
    assert "cells of 0.353 m or more" in caught.value.remedy


def test_remedies_of_a_deep_press_fit_give_the_right_force() -> None:
    coarse = sw.build(pressed_blocks(0.3, (2, 2), None))
    assert initial_state(coarse).pressure.sum() == pytest.approx(0.15, rel=1e-9)
    driven = sw.build(pressed_blocks(0.0, (4, 5), None, "apart"))
    *_, last = sw.march(driven, until=1.0, step=0.1)
    assert last.after.pressure["c"].sum() == pytest.approx(0.15, rel=1e-6)


def test_the_refusal_of_a_body_with_a_crack_names_it() -> None:
    """Two halves beside each other that share no nodes: their facets coincide, and inside is not defined."""
    scene = pointed(0.1)
    left, right = (rectangle((1.0, 2.0), (3, 4), origin=(x, 0.0)) for x in (0.0, 1.0))
    cells = np.concatenate([left.blocks["quad4"], right.blocks["quad4"] + len(left.points)])
    mesh = sw.meshes.Mesh(points=np.concatenate([left.points, right.points]), blocks={"quad4": cells})
    cracked = sw.Solid(mesh=mesh, material=LAW, density=1.0)
    with pytest.raises(InputError, match="facets coincide") as caught:
        initial_state(sw.build(replace(scene, bodies={**scene.bodies, "low": cracked})))
    assert caught.value.where == "bodies.low.mesh"
