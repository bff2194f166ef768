"""Mesh: tags, facets, and what it refuses."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.meshes.mesh import Mesh

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_tags() -> None:
    mesh = rectangle((1.0, 1.0), (2, 2)).with_tag("corner", lambda x: x.sum(axis=1) == 0.0)
    assert mesh.nodes("corner").tolist() == [0]
    assert mesh.nodes("all").tolist() == list(range(9))
    assert mesh.nodes("surface").tolist() == [0, 1, 2, 3, 5, 6, 7, 8]
    assert mesh.facets_on("top")["bar2"].tolist() == [[7, 6], [8, 7]]
    assert mesh.facets_on("corner") == {}
    with pytest.raises(InputError, match="'tip' matches nothing") as caught:
        mesh.nodes("tip")
    assert "corner" in caught.value.remedy and "surface" in caught.value.remedy
    with pytest.raises(InputError, match="'none' matches nothing"):
        mesh.with_tag("none", lambda x: x[:, 0] > 5.0).nodes("none")


def test_given_tag_stands_before_the_builtin_one() -> None:
    mesh = Mesh(points=SQUARE, blocks={"quad4": np.array([[0, 1, 2, 3]])}, tags={"surface": np.array([3, 1, 1])})
    assert mesh.nodes("surface").tolist() == [1, 3]


def test_mixed_cells_share_their_facets() -> None:
    points = np.vstack([SQUARE, [[2.0, 0.0]]])
    mesh = Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2]])})
    assert len(mesh.boundary()["bar2"]) == 5
    assert mesh.n_cells == 2


def test_measures() -> None:
    assert box((4.0, 2.0, 1.0), (2, 2, 2), cell="hex27").edge() == 0.5
    assert interval(1.0, 4).boundary()["point1"].tolist() == [[0], [4]]
    assert interval(1.0, 4).nearest(0.6) == 2
    assert rectangle((1.0, 1.0), (1, 1)).nearest((0.9, 0.2)) == 1
    with pytest.raises(InputError):
        interval(1.0, 4).nearest((0.0, 0.0))


def test_arrays_are_copies_and_read_only() -> None:
    points = SQUARE.copy()
    mesh = Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3]])})
    points[:] = 7.0
    assert mesh.points.max() == 1.0
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0, 0] = 1.0


def test_inverted_cell_is_named() -> None:
    cells = rectangle((2.0, 1.0), (2, 1)).blocks["quad4"].copy()
    cells[1] = cells[1, ::-1]
    with pytest.raises(InputError, match=r"inverted cell number 1 with its centre at \(1.5, 0.5\)") as caught:
        Mesh(points=rectangle((2.0, 1.0), (2, 1)).points, blocks={"quad4": cells})
    assert caught.value.where == "blocks.quad4[1]"


def test_degenerate_cell_is_named() -> None:
    with pytest.raises(InputError, match="degenerate cell number 0"):
        Mesh(points=np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), blocks={"tri3": np.array([[0, 1, 2]])})
    with pytest.raises(InputError, match="degenerate cell number 0"):
        Mesh(points=np.zeros((2, 3)), blocks={"bar2": np.array([[0, 1]])})


def test_thin_cells_are_allowed() -> None:
    assert box((1.0, 1.0, 1e-6), (1, 1, 1)).n_cells == 1


@pytest.mark.parametrize(
    ("points", "blocks", "tags", "where"),
    [
        (SQUARE, {}, {}, "blocks"),
        (SQUARE, {"quad8": [[0, 1, 2, 3]]}, {}, "blocks.quad8"),
        (SQUARE, {"tri3": [[0, 1, 2, 3]]}, {}, "blocks.tri3"),
        (SQUARE, {"quad4": [[0, 1, 2, 4]]}, {}, "quad4"),
        (SQUARE, {"tri3": [[0, 1, 2]]}, {}, "points"),
        (SQUARE, {"quad4": [[0, 1, 2, 3]]}, {"far": [9]}, "far"),
        (SQUARE, {"quad4": [[0, 1, 2, 3]], "bar2": [[0, 1]]}, {}, "blocks"),
        (np.pad(SQUARE, ((0, 0), (0, 1))), {"quad4": [[0, 1, 2, 3]]}, {}, "blocks"),
        (SQUARE * np.nan, {"quad4": [[0, 1, 2, 3]]}, {}, "points"),
    ],
)
def test_what_is_no_mesh_is_refused(points, blocks, tags, where: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        Mesh(points=points, blocks={k: np.array(v) for k, v in blocks.items()}, tags=tags)
    assert caught.value.where == where
