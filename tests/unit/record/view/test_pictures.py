"""Pictures: that they are drawn from every kind of run, and the geometry behind them."""

import sys

import numpy as np
import pytest

from softway.bodies.solid import Tool
from softway.errors import InputError
from softway.obstacles.primitives import Sphere
from softway.record.conduct import record_run
from softway.record.read.cells import Cells
from softway.record.read.frames import Frame
from softway.record.read.surface_mesh import SHAPES, at_nodes, exaggeration, rigid, skin_of
from softway.record.storage.run_folder import RunFolder
from softway.record.view import pictures as view
from softway.record.view.bodies.body_placement import body_placement
from softway.record.view.bodies.colour_field import range_of
from softway.record.view.bodies.surroundings import camera, edges, strokes
from softway.record.view.pictures import pictures
from softway.record.view.style import scaled

PNG = b"\x89PNG"


@pytest.fixture
def run(fake, tmp_path):
    return record_run(fake.steps(), fake.opening(), RunFolder(out=tmp_path / "run"), title="Made up")


@pytest.mark.slow
@pytest.mark.few(5)
def test_pictures_of_every_kind_of_body(run):
    pytest.importorskip("matplotlib")
    files = pictures(run)
    assert [f.name for f in files] == ["bodies.png", "history.png"]
    assert all(f.read_bytes().startswith(PNG) and f.stat().st_size > 10_000 for f in files)


@pytest.mark.few(2)
def test_findings_stand_below_the_description(run, monkeypatch):
    pytest.importorskip("matplotlib")
    before = view.picture(run).figure.get_supxlabel()
    monkeypatch.setattr(view, "sentences", lambda _: ["ball overlaps floor by 1 mm"])
    assert view.picture(run).figure.get_supxlabel() == "\n".join(filter(None, [before, "ball overlaps floor by 1 mm"]))
    assert view.picture(run, "history").figure.get_supxlabel() == "ball overlaps floor by 1 mm"


def test_pictures_go_where_they_are_asked(bar, tmp_path):
    pytest.importorskip("matplotlib")
    run = record_run(bar.steps(), bar.opening(), RunFolder())
    files = pictures(run, tmp_path / "made" / "a.png")
    assert [f.name for f in files] == ["a.png", "a_history.png"] and all(f.exists() for f in files)
    with pytest.raises(InputError, match="cannot write"):
        pictures(run, tmp_path / "a.nonsense")


def test_without_matplotlib_the_error_names_it(bar, monkeypatch):
    run = record_run(bar.steps(), bar.opening(), RunFolder())
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(InputError, match="pip install matplotlib"):
        pictures(run)


@pytest.mark.parametrize("name", SHAPES)
def test_shape_functions_of_facets(name):
    """They sum to 1 and are 1 at their own node."""
    tri = [(0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5)]
    quad = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)]
    nodes = np.array((tri if name.startswith("tri") else quad)[: int(name[-1])], float)
    np.testing.assert_allclose(SHAPES[name](*nodes.T), np.eye(len(nodes)), atol=1e-15)
    np.testing.assert_allclose(SHAPES[name](*np.random.default_rng(0).random((2, 7))).sum(axis=1), 1.0, rtol=1e-14)


def test_small_triangles_cover_the_surface_and_face_outward(run):
    """Area 1 of the unit square, 6 of the unit cube; the volume by the divergence theorem is 1."""
    cells = run.fields.cells
    if cells.types.max() in (3, 21):
        pytest.skip("bars have no surface")
    skin = skin_of(cells)
    mesh, triangles = skin.mesh, skin.spread(cells.reference)
    normal = 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert np.linalg.norm(normal, axis=1).sum() == pytest.approx({2: 1.0, 3: 6.0}[mesh.dim], rel=1e-12)
    if mesh.dim == 3:
        assert np.einsum("ti,ti->", normal, triangles.mean(axis=1)) / 3.0 == pytest.approx(1.0, rel=1e-12)


def test_edges_of_a_cube_or_square(run):
    """A cube shows 9 of its edges to the eye, a square its 4 sides: lengths add up."""
    cells = run.fields.cells
    if cells.types.max() in (3, 21):
        pytest.skip("bars have no outline")
    skin = skin_of(cells)
    view = camera(cells, cells.reference, cells.obstacles(0.0))
    pieces = strokes(cells.reference, edges(skin, cells.reference, view), 0.05)
    length = np.linalg.norm(pieces[..., 1, :] - pieces[..., 0, :], axis=-1).sum()
    assert length == pytest.approx({2: 4.0, 3: 9.0}[skin.mesh.dim], rel=1e-12)


def test_colours_end_below_a_lonely_peak():
    """Above twice the 99th percentile the colours stop there; otherwise at the greatest value."""
    even = np.linspace(0.0, 1.0, 1001)
    peaked = range_of(np.append(even, 50.0))
    assert range_of(even).high == 1.0 and range_of(0.0 * even).high == 0.0
    assert peaked.high == pytest.approx(0.99, abs=2e-3) and peaked.peaked and peaked.low == 0.0


def test_a_uniform_temperature_has_one_colour():
    """Half a kelvin below and above it: differences in the last digits are not drawn."""
    found = range_of(313.5 + 1e-12 * np.arange(9.0), "temperature")
    assert (found.low, found.high) == pytest.approx((313.0, 314.0))


def test_colours_of_both_signs_are_alike_around_zero():
    found = range_of(np.linspace(-3.0, 1.0, 101))
    assert found.low == -found.high and found.high == pytest.approx(3.0, rel=0.02) and found.map == "RdBu_r"


def test_nodal_means(run):
    cells = run.fields.cells
    np.testing.assert_allclose(at_nodes(cells, np.full(len(cells.types), 3.0)), 3.0, rtol=1e-15)


def test_rigid_motion_is_taken_out():
    rng = np.random.default_rng(1)
    reference = rng.random((20, 3))
    turn, _ = np.linalg.qr(rng.random((3, 3)))
    turn *= np.linalg.det(turn)
    moved = reference @ turn.T + [1.0, 2.0, 3.0]
    np.testing.assert_allclose(rigid(reference, moved), moved, atol=1e-14)


@pytest.mark.parametrize(("strain", "factor"), [(0.2, 1.0), (1.1e-3, 50.0), (1.1e-5, 5000.0), (0.0, 1.0)])
def test_exaggeration_is_a_round_number(strain, factor):
    """A bar of length 1 stretched by e moves its ends by e/2 from the rigid shape; 0.05 of the size is aimed at."""
    assert exaggeration(1.0, 0.5 * strain) == factor


def two_squares(gap: float, squeeze: float) -> tuple[Cells, Frame]:
    """Two unit squares whose touching sides are pushed in, and the second moved by ``gap``; one node is the slave."""
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    reference = np.concatenate([square, square + [2.0, 0.0, 0.0]])
    real = np.concatenate([square, square + [1.0 + gap, 0.0, 0.0]])
    real[[1, 2], 0] -= squeeze
    real[[4, 7], 0] -= squeeze
    cells = Cells(
        bodies=("a", "b"), tools={}, lost=(), dimension=2, reference=reference, connectivity=np.arange(8),
        offsets=np.array([0, 4, 8]), types=np.array([9, 9]), body=np.array([0, 1]),
    )  # fmt: skip
    empty, force = np.zeros(0), np.zeros(8)
    force[[1, 2]] = float(gap == 0.0)
    moved = real - cells.reference
    frame = Frame(
        time=0.0, points=real, displacement=moved, velocity=empty, contact_force=force, stress=empty, von_mises=empty
    )
    return cells, frame


def test_enlarged_bodies_touch_what_they_touch():
    """The squares deform by the same at the common side; enlarged, their sides still coincide."""
    cells, frame = two_squares(gap=0.0, squeeze=1e-3)
    placed = body_placement(cells, frame, {})
    assert placed.factor > 10.0 and placed.shaped.all()
    assert np.allclose(placed.points[[1, 2]], placed.points[[4, 7]], atol=1e-12)
    assert placed.points[1, 0] < frame.points[1, 0] - 1e-3


def test_bodies_apart_are_enlarged_where_they_are():
    cells, frame = two_squares(gap=0.5, squeeze=1e-3)
    placed = body_placement(cells, frame, {})
    assert placed.factor > 10.0 and np.abs(placed.shape - frame.points).max() <= 1e-3 + 1e-12
    assert np.allclose(placed.points - placed.shape, placed.factor * (frame.points - placed.shape), atol=1e-12)


def test_an_enlarged_body_keeps_its_gap_to_a_round_obstacle():
    cells, frame = two_squares(gap=0.0, squeeze=1e-3)
    ball = Tool(shape=Sphere(centre=(0.5, -3.0), radius=2.9)).at(0.0)
    placed = body_placement(cells, frame, {"ball": ball})
    real, drawn = (float(ball.gap(x[:4, :2]).min()) for x in (frame.points, placed.points))
    assert placed.factor > 10.0 and abs(drawn - real) < 0.02


def test_strongly_deformed_bodies_are_not_enlarged():
    cells, frame = two_squares(gap=0.5, squeeze=0.9)
    placed = body_placement(cells, frame, {})
    assert placed.factor == 1.0 and not placed.shaped.any() and (placed.points == frame.points).all()


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [(2.1e11, "Pa", "GPa"), (3e-4, "s", "µs"), (0.0, "N", "N"), (1.3, "m", "m"), (20.0, "s", "s"), (4e3, "N", "kN")],
)
def test_prefixes(value, unit, expected):
    factor, found = scaled(value, unit)
    assert found == expected and 1.0 <= factor * value < 1000.0 or value == 0.0


def test_a_supported_body_is_not_turned():
    """The rigid shape of a body whose axis cannot move across it keeps that axis."""
    reference = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]])
    points = reference + np.array([[0.0, 0.3, 0.0], [0.2, 0.1, 0.0], [0.0, 0.2, 0.0], [0.1, 0.2, 0.0]])
    assert np.allclose(rigid(reference, points), reference + [0.0, 0.2, 0.0], atol=1e-15)
