"""Bodies that overlap at the start: which nodes are looked at, and from which depth on."""

import numpy as np
import pytest

import softway as sw

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
