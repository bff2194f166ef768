"""Shapes without a mesher: volumes, centroids, boundaries, quality."""

import numpy as np
import pytest

from softway.arrays import Array
from softway.errors import InputError
from softway.meshes.element import CELLS, element, exact_degree, tabulate
from softway.meshes.generators.shapes import KINDS, ball, box, cylinder, disc, interval, rectangle
from softway.meshes.mesh import Mesh

PLANE, SOLID = KINDS[2], KINDS[3]


def moments(mesh: Mesh) -> tuple[float, Array]:
    """Volume and centroid by quadrature that is exact for the given nodes."""
    volume, first = 0.0, np.zeros(mesh.dim)
    for name, cells in mesh.blocks.items():
        table = element(name, exact_degree(name, curved=True))
        x = mesh.points[cells]
        weight = table.weights * np.linalg.det(np.einsum("eai,qar->eqir", x, table.dN))
        volume += weight.sum()
        first += np.einsum("eq,eqi->i", weight, np.einsum("qa,eai->eqi", table.N, x))
    return volume, first / volume


def outflow(mesh: Mesh) -> float:
    """Integral of x . n over the boundary facets."""
    total = 0.0
    for name, facets in mesh.boundary().items():
        table = element(name, 6)
        x = mesh.points[facets]
        at, slope = np.einsum("qa,fai->fqi", table.N, x), np.einsum("fai,qar->fqir", x, table.dN)
        if mesh.dim == 2:
            normal = np.stack([slope[..., 1, 0], -slope[..., 0, 0]], axis=-1)
        else:
            normal = np.cross(slope[..., 0], slope[..., 1])
        total += np.einsum("q,fqi,fqi->", table.weights, at, normal)
    return total


def made(shape: str, cell: str, n: int) -> Mesh:
    """One of the shapes with about ``n`` cells across, away from zero."""
    match shape:
        case "rectangle":
            return rectangle((2.0, 1.0), (n, n + 1), origin=(1.0, 2.0), cell=cell)
        case "disc":
            return disc(0.5, n, centre=(1.0, 2.0), cell=cell)
        case "box":
            return box((2.0, 1.0, 0.5), (n, n + 1, n), origin=(1.0, 2.0, 3.0), cell=cell)
        case "cylinder":
            return cylinder(0.5, 2.0, (n, n), origin=(1.0, 2.0, 3.0), cell=cell)
        case _:
            return ball(0.5, n, centre=(1.0, 2.0, 3.0), cell=cell)


EXACT = {
    "rectangle": (2.0, (2.0, 2.5)),
    "disc": (np.pi / 4, (1.0, 2.0)),
    "box": (1.0, (2.0, 2.5, 3.25)),
    "cylinder": (np.pi / 2, (1.0, 2.0, 4.0)),
    "ball": (np.pi / 6, (1.0, 2.0, 3.0)),
}
CASES = [(shape, cell) for shape in ("rectangle", "disc") for cell in PLANE]
CASES += [(shape, cell) for shape in ("box", "cylinder", "ball") for cell in SOLID]


@pytest.mark.parametrize(("shape", "cell"), CASES)
def test_volume_centroid_and_closed_boundary(shape: str, cell: str) -> None:
    mesh = made(shape, cell, 4)
    volume, centroid = moments(mesh)
    exact, centre = EXACT[shape]
    assert np.abs(centroid - centre).max() < 1e-12
    assert abs(outflow(mesh) - mesh.dim * volume) < 1e-12 * volume
    if shape in ("rectangle", "box"):
        assert abs(volume - exact) < 1e-13
    else:
        coarse = {"hex20": 2e-2}.get(cell, 5e-3)  # a facet without a middle node is flatter than the ball
        assert abs(volume / exact - 1.0) < (0.3 if CELLS[cell].order == 1 else coarse)


@pytest.mark.parametrize(("shape", "cell"), [c for c in CASES if c[0] not in ("rectangle", "box")])
def test_round_volumes_converge(shape: str, cell: str) -> None:
    """Chords miss a circle by h^2; parabolas through three of its points enclose its area to h^4."""
    errors = [abs(moments(made(shape, cell, n))[0] / EXACT[shape][0] - 1.0) for n in (4, 8)]
    expected = 2.0 if CELLS[cell].order == 1 else 4.0
    assert np.log2(errors[0] / errors[1]) == pytest.approx(expected, abs=0.35)


@pytest.mark.parametrize(("shape", "cell"), [c for c in CASES if c[0] not in ("rectangle", "box")])
def test_no_cell_is_badly_shaped(shape: str, cell: str) -> None:
    """Determinant of the Jacobian over the product of the lengths of its columns, at the nodes of every cell."""
    mesh = made(shape, cell, 6)
    x = mesh.points[mesh.blocks[cell]]
    jacobian = np.einsum("eai,qar->eqir", x, tabulate(cell, CELLS[cell].nodes)[1])
    quality = np.linalg.det(jacobian) / np.prod(np.linalg.norm(jacobian, axis=-2), axis=-1)
    assert quality.min() > (0.12 if CELLS[cell].simplex else 0.6)


@pytest.mark.parametrize(("shape", "cell"), CASES)
def test_neighbours_agree_on_their_facets(shape: str, cell: str) -> None:
    """Boundary nodes are those of the shape's boundary: a facet split in two ways would leave inner ones."""
    mesh = made(shape, cell, 4)
    x = mesh.points - np.array(EXACT[shape][1])
    radius = np.linalg.norm(x if shape == "ball" else x[:, :2], axis=1)
    match shape:
        case "rectangle" | "box":
            half = np.ptp(mesh.points, axis=0) / 2
            outer = (np.abs(x) > half * (1 - 1e-12)).any(axis=1)
        case "cylinder":
            outer = (radius > 0.5 - 1e-12) | (np.abs(x[:, 2]) > 1 - 1e-12)
        case _:
            outer = radius > 0.5 - 1e-12
            assert np.abs(radius[mesh.nodes("boundary" if shape == "disc" else "surface")] - 0.5).max() < 1e-14
            assert len(mesh.nodes("centre")) == 1
    boundary = np.unique(np.concatenate([f.ravel() for f in mesh.boundary().values()]))
    assert boundary.tolist() == np.flatnonzero(outer).tolist()


@pytest.mark.parametrize("cell", KINDS[1])
def test_interval(cell: str) -> None:
    mesh = interval(2.0, 4, origin=-1.0, cell=cell)
    assert mesh.points[mesh.nodes("left")].tolist() == [[-1.0]]
    assert mesh.points[mesh.nodes("right")].tolist() == [[1.0]]
    assert moments(mesh)[0] == pytest.approx(2.0, abs=1e-14)
    leaning = interval(5.0, 2, origin=(1.0, 1.0), direction=(3.0, 4.0), cell=cell)
    assert np.abs(leaning.points[leaning.nodes("right")] - [4.0, 5.0]).max() < 1e-14
    assert leaning.cell_dim == 1 and leaning.dim == 2
    assert interval(1.0, 2, dim=3, cell=cell).dim == 3


def test_sides_of_a_box() -> None:
    for cell in SOLID:
        mesh = box((1.0, 2.0, 3.0), (1, 2, 3), cell=cell)
        for axis, sides in enumerate((("left", "right"), ("front", "back"), ("bottom", "top"))):
            for value, side in zip((0.0, axis + 1.0), sides, strict=True):
                assert mesh.nodes(side).tolist() == np.flatnonzero(mesh.points[:, axis] == value).tolist()


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: interval(-1.0, 2), "length"),
        (lambda: interval(1.0, 0), "cells"),
        (lambda: interval(1.0, 1, cell="tri3"), "cell"),
        (lambda: interval(1.0, 1, direction=(0.0, 0.0)), "direction"),
        (lambda: interval(1.0, 1, origin=(0.0, 0.0), dim=3), "origin"),
        (lambda: rectangle((1.0, 0.0), (1, 1)), "size"),
        (lambda: rectangle((1.0, 1.0), (1, 1, 1)), "cells"),  # type: ignore[arg-type]
        (lambda: box((1.0, 1.0), (1, 1, 1)), "size"),  # type: ignore[arg-type]
        (lambda: disc(1.0, 3), "cells"),
        (lambda: disc(1.0, 2, cell="quad4"), "cells"),
        (lambda: cylinder(1.0, -1.0, (4, 1)), "height"),
        (lambda: cylinder(1.0, 1.0, (4, 0)), "cells"),
        (lambda: ball(float("nan"), 4), "radius"),
    ],
)
def test_what_cannot_be_built_is_refused(make, where: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.where == where
