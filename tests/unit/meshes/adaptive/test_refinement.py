"""Refinement by bisection: conforming, a function of the levels alone, of bounded shapes, with its tags."""

import numpy as np
import pytest
from adapted import (
    BASES,
    CONFORMING,
    adapted,
    cells_of,
    euler,
    facet_counts,
    integrals,
    irregular,
    shapes,
    some_levels,
    surface_measure,
)

from softway.errors import InputError
from softway.meshes.adaptive.leaves import DEPTH, finest, roots, same
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.generators.shapes import ball, box, disc, interval, rectangle
from softway.meshes.mesh import Mesh

EPS = np.finfo(float).eps


@pytest.fixture(scope="module", params=BASES)
def found(request: pytest.FixtureRequest) -> AdaptedMesh:
    return adapted(request.param, 3)


@pytest.mark.slow
def test_no_cell_is_coarser_than_wanted_and_the_leaves_cover_the_base(found: AdaptedMesh) -> None:
    want = some_levels(found.base.n_cells, 3)
    assert (found.leaves.level >= want[found.leaves.root]).all()
    ends = found.leaves.start + found.leaves.length
    assert np.array_equal(np.append(found.leaves.start, found.base.n_cells << DEPTH), np.append(0, ends))


@pytest.mark.parametrize("name", CONFORMING)
def test_facets_are_shared_whole(name: str) -> None:
    found = adapted(name, 3)
    counts = facet_counts(found.mesh)
    assert set(counts) <= {1, 2}
    assert (counts == 1).sum() == sum(len(f) for f in found.mesh.boundary().values())
    assert euler(found.mesh) == euler(found.base) == 1


def test_boundary_and_volume_stay(found: AdaptedMesh) -> None:
    whole = integrals(found.base)
    shares = integrals(found.mesh)
    scale = 64 * EPS * whole.max()
    assert np.bincount(found.leaves.root, shares) == pytest.approx(whole, abs=scale)


@pytest.mark.parametrize("name", [name for name in BASES if name[:3] != "bar" and "curved" not in name])
def test_the_boundary_keeps_its_measure(name: str) -> None:
    found = adapted(name, 3)
    assert surface_measure(found.mesh) == pytest.approx(surface_measure(found.base), rel=1e-13)


@pytest.mark.parametrize("name", CONFORMING)
def test_each_bisection_halves_the_volume(name: str) -> None:
    found = adapted(name, 3)
    volume = abs(np.linalg.det(found.place))
    assert volume == pytest.approx(np.ldexp(1.0, -found.leaves.level), rel=1e-12)


def test_nodes_of_the_base_keep_their_numbers(found: AdaptedMesh) -> None:
    n = found.base.n_nodes
    assert np.array_equal(found.mesh.points[:n], found.base.points)
    size = np.ptp(found.base.points, axis=0).max()
    distance = np.linalg.norm(found.mesh.points[:, None] - found.mesh.points[None], axis=2) + size * np.eye(
        found.mesh.n_nodes
    )
    assert distance.min() > 1e-3 * found.mesh.edge()


def test_no_wish_is_the_base(found: AdaptedMesh) -> None:
    plain = refined(found.base, np.zeros(found.base.n_cells, int))
    assert np.array_equal(plain.mesh.points, found.base.points)
    assert np.array_equal(cells_of(plain.mesh), cells_of(found.base))
    assert {k: v.tolist() for k, v in plain.mesh.tags.items()} == {k: v.tolist() for k, v in found.base.tags.items()}


def test_the_mesh_has_no_history(found: AdaptedMesh) -> None:
    want = some_levels(found.base.n_cells, 8)
    direct = refined(found.base, want)
    again = refined(found.base, want[found.leaves.root], found.leaves)
    assert same(direct.leaves, again.leaves)
    assert np.array_equal(direct.mesh.points, again.mesh.points)
    assert np.array_equal(cells_of(direct.mesh), cells_of(again.mesh))


@pytest.mark.slow
def test_levels_of_the_leaves_give_the_same_mesh(found: AdaptedMesh) -> None:
    again = refined(found.base, found.leaves.level, found.leaves)
    assert same(found.leaves, again.leaves)
    assert np.array_equal(found.mesh.points, again.mesh.points)
    assert np.array_equal(cells_of(found.mesh), cells_of(again.mesh))


@pytest.mark.parametrize("name", ["tri3 irregular", "tet4 irregular", "tet4"])
def test_a_numbering_moved_by_rounding_gives_the_same_leaves(name: str) -> None:
    base = BASES[name]()
    moved = Mesh(points=base.points * (1.0 + 4 * EPS) + 4 * EPS, blocks=base.blocks)
    want = some_levels(base.n_cells, 5)
    assert same(refined(base, want).leaves, refined(moved, want).leaves)


@pytest.mark.parametrize("seed", range(6))
def test_tetrahedra_of_any_mesh_end(seed: int) -> None:
    base = irregular(3, 25, 10 + seed)
    want = np.zeros(base.n_cells, int)
    want[seed::17] = 9
    found = refined(base, want)
    assert set(facet_counts(found.mesh)) <= {1, 2}
    assert found.leaves.level.max() <= 9 + 8  # the neighbourhood of the wanted cells alone


@pytest.mark.parametrize(("dim", "most"), [(2, 4), (3, 72)])
def test_few_shapes(dim: int, most: int) -> None:
    base = irregular(dim, 8, 4)
    for level in (6, 8, 10) if dim == 2 else (6, 9, 13):
        found = refined(base, np.full(base.n_cells, level) * (np.arange(base.n_cells) < 3))
        for root in range(3):
            own = shapes(found.mesh)[found.leaves.root == root]
            assert len(np.unique(np.rint(own * 1e6), axis=0)) <= most


def test_the_least_angle_is_half_of_that_of_the_base_at_least() -> None:
    base = irregular(2, 40, 7)
    found = refined(base, some_levels(base.n_cells, 1, 10))

    def least(mesh: Mesh) -> float:
        x = mesh.points[cells_of(mesh)]
        a, b = np.roll(x, -1, axis=1) - x, np.roll(x, 1, axis=1) - x
        cosine = (a * b).sum(axis=2) / np.linalg.norm(a, axis=2) / np.linalg.norm(b, axis=2)
        return float(np.arccos(cosine.max()))

    assert least(found.mesh) >= 0.5 * least(base)


def test_levels_of_bars_differ_by_one() -> None:
    found = refined(interval(1.0, cells=4), np.array([0, 0, 7, 0]))
    assert abs(np.diff(found.leaves.level)).max() == 1
    assert found.leaves.level[found.leaves.root == 2].min() == 7


def test_a_network_of_bars() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]])
    base = Mesh(points=points, blocks={"bar2": np.array([[0, 1], [2, 0], [0, 3]])})
    found = refined(base, np.array([3, 0, 0]))
    assert np.bincount(found.leaves.root).tolist() == [8, 3, 3]


def test_curved_cells_keep_their_shape() -> None:
    base = disc(1.0, 2, cell="tri6")
    found = refined(base, np.full(base.n_cells, 4))
    facets, fine = base.boundary()["bar3"], found.mesh.boundary()["bar3"]
    assert len(fine) == 4 * len(facets)
    assert integrals(found.mesh).sum() == pytest.approx(integrals(base).sum(), rel=1e-14)
    rim = found.mesh.nodes("boundary")
    assert np.array_equal(np.unique(fine), rim)


@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8", "quad9"])
def test_sides_of_a_rectangle(cell: str) -> None:
    base = rectangle((1.0, 2.0), (3, 4), cell=cell)
    found = refined(base, some_levels(base.n_cells, 2))
    x, y = found.mesh.points.T
    for name, where in {"left": x == 0.0, "right": x == 1.0, "bottom": y == 0.0, "top": y == 2.0}.items():
        assert found.mesh.nodes(name).tolist() == np.flatnonzero(where).tolist(), name


@pytest.mark.parametrize("cell", ["tet4", "tet10", "hex8", "hex20", "hex27"])
def test_sides_of_a_box(cell: str) -> None:
    base = box((1.0, 2.0, 4.0), (2, 2, 2), cell=cell)
    found = refined(base, some_levels(base.n_cells, 2))
    sides = {
        "left": (0, 0.0),
        "right": (0, 1.0),
        "front": (1, 0.0),
        "back": (1, 2.0),
        "bottom": (2, 0.0),
        "top": (2, 4.0),
    }
    for name, (axis, place) in sides.items():
        assert found.mesh.nodes(name).tolist() == np.flatnonzero(found.mesh.points[:, axis] == place).tolist(), name
    assert np.array_equal(found.mesh.nodes("surface"), np.unique(np.concatenate(list(found.mesh.tags.values()))))


@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8", "quad9"])
def test_two_sides_do_not_take_the_diagonal_between_them(cell: str) -> None:
    base = rectangle((1.0, 1.0), (3, 3), cell=cell).with_tag("rim", lambda x: (x % 1.0 == 0.0).any(axis=1))
    found = refined(base, np.full(base.n_cells, 3))
    x = found.mesh.points
    assert found.mesh.nodes("rim").tolist() == np.flatnonzero((x % 1.0 == 0.0).any(axis=1)).tolist()


def test_volumes_lines_and_points_of_nodes() -> None:
    base = box((1.0, 1.0, 1.0), (4, 4, 4), cell="tet4")
    base = base.with_tag("slab", lambda x: x[:, 0] >= 0.5).with_tag("axis", lambda x: (x[:, 1:] == 0.5).all(axis=1))
    base = base.with_tag("rim", lambda x: (x[:, 1:] == 0.0).all(axis=1)).with_tag(
        "point", lambda x: (x == 0.5).all(axis=1)
    )
    found = refined(base, np.full(base.n_cells, 3))
    x = found.mesh.points
    assert found.mesh.nodes("slab").tolist() == np.flatnonzero(x[:, 0] >= 0.5).tolist()
    assert found.mesh.nodes("axis").tolist() == np.flatnonzero((x[:, 1:] == 0.5).all(axis=1)).tolist()
    assert found.mesh.nodes("rim").tolist() == np.flatnonzero((x[:, 1:] == 0.0).all(axis=1)).tolist()
    assert len(found.mesh.nodes("point")) == 1


def test_tagged_facets_stay_complete() -> None:
    base = ball(1.0, 2, cell="tet10").with_tag("cap", lambda x: (x[:, 2] > 0.4) & (np.linalg.norm(x, axis=1) > 0.99))
    found = refined(base, some_levels(base.n_cells, 4, 4))
    count = {}
    for name, mesh in {"base": base, "fine": found.mesh}.items():
        (facets,) = mesh.facets_on("cap").values()
        legs = mesh.points[facets[:, 1:3]] - mesh.points[facets[:, :1]]
        count[name] = len(facets), np.linalg.norm(np.cross(legs[:, 0], legs[:, 1]), axis=1).sum() / 2
    assert count["fine"][0] > count["base"][0]
    assert count["base"][1] < count["fine"][1] < 1.2 * count["base"][1]  # flat triangles of curved facets


@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_regions_stay_with_their_cells(cell: str) -> None:
    base = rectangle((1.0, 1.0), (4, 4), cell=cell).with_region("low", lambda x: x[:, 1] < 0.5)
    found = refined(base, some_levels(base.n_cells, 6))
    assert found.mesh.cells("low").tolist() == np.flatnonzero(found.mesh.centres()[:, 1] < 0.5).tolist()


def test_the_greatest_level_of_a_cell_counts() -> None:
    given = refined(interval(1.0, cells=1), np.array([2])).leaves
    assert finest(roots(1), given, np.array([0, 3, 1, 0])).tolist() == [3]
    found = refined(interval(1.0, cells=1), np.array([0, 3, 1, 0]), given)
    assert found.leaves.level.tolist() == [2, 3, 3, 2, 2]


def test_the_greatest_level_is_reached_at_one_end() -> None:
    found = refined(interval(1.0, cells=1), np.array([0]))
    for level in range(1, DEPTH + 1):
        found = refined(found.base, np.append(level, found.leaves.level[1:]), found.leaves)
    assert found.leaves.level.tolist() == [DEPTH, *range(DEPTH, 0, -1)]
    assert found.mesh.edge() == np.ldexp(1.0, -DEPTH)


def both() -> Mesh:
    """A quadrilateral and a triangle."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.5]])
    return Mesh(points=points, blocks={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2]])})


@pytest.mark.parametrize(
    ("mesh", "want", "place"),
    [
        (both(), np.zeros(2, int), "mesh"),
        (interval(1.0, cells=2), np.zeros(3, int), "want"),
        (interval(1.0, cells=2), np.array([0, DEPTH + 1]), "want"),
        (interval(1.0, cells=2), np.array([0, -1]), "want"),
        (interval(1.0, cells=2), np.array([0.0, 1.0]), "want"),
    ],
)
def test_refusals(mesh: Mesh, want: np.ndarray, place: str) -> None:
    with pytest.raises(InputError) as refusal:
        refined(mesh, want)
    assert refusal.value.where == place
    assert refusal.value.remedy
