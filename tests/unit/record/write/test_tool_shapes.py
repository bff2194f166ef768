"""Rigid tools in a run folder: described, recovered, drawn where they stand."""

import json
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest

from softway.bodies.prescribed_motion import Sliding, Still, Swinging, Table, Translation, Turning
from softway.bodies.setup.motion_laws import Haversine, Spline
from softway.bodies.solid import Tool
from softway.meshes.generators import shapes
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cavity, Cylinder, Roller, Sphere, Torus
from softway.obstacles.signed_distance import SignedDistance
from softway.obstacles.triangulated import Facets, Surface
from softway.record.conduct import record_run
from softway.record.storage.run_folder import RunFolder
from softway.record.view.bodies.bodies import bodies
from softway.record.view.pictures import picture
from softway.record.view.plots.paths import paths
from softway.record.write.shapes.sampled_distance import sampled
from softway.record.write.shapes.tool_shapes import described, recovered

PYRAMID = np.array([[-1.0, -1.0, -0.1], [2.0, -1.0, -0.1], [2.0, 2.0, -0.1], [-1.0, 2.0, -0.1], [0.5, 0.5, -1.0]])
SIDES = np.array([[0, 1, 2], [0, 2, 3], [1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]])
FACETS = Facets(points=PYRAMID, cells=SIDES)
CORNER = Facets(points=np.array([[-1.0, 0.4], [-0.1, -0.2], [1.2, -0.1]]), cells=np.array([[1, 0], [2, 1]]))


def level(x):
    """Below z = -0.2, or below y in the plane."""
    return x[:, -1] + 0.2


SOLID = [
    HalfSpace(point=(0.1, 0.0, -0.2), normal=(0.0, 0.6, 0.8)),
    Sphere(centre=(0.5, 0.5, -0.7), radius=0.7),
    Roller(point=(0.0, 0.1, -0.5), axis=(1.0, 1.0, 0.3), radius=0.4),
    Cylinder(start=(0.5, 0.5, -1.0), end=(0.5, 0.5, -0.1), radius=0.6),
    Block(low=(-0.5, -0.4, -0.3), high=(0.5, 0.6, -0.1)),
    Torus(centre=(0.0, 0.1, -0.5), axis=(0.2, 0.0, 1.0), radius=0.8, tube=0.3),
    SignedDistance(function=level, dim=3),
    FACETS,
    Facets(points=PYRAMID, cells=SIDES[:2], smooth=True),
    Cavity(of=FACETS),
    Cavity(of=Sphere(centre=(0.1, -0.2, 0.3), radius=2.7)),
]
PLANE = [
    HalfSpace(point=(0.0, -0.1), normal=(0.1, 1.0)),
    Block(low=(-1.0, -0.5), high=(2.0, -0.1)),
    SignedDistance(function=level, dim=2),
    CORNER,
]
MOTIONS = [
    Still(),
    Translation(velocity=(0.0, 0.1, -0.2)),
    Table(times=(0.0, 1.0), displacements=((0.0, 0.0, 0.0), (0.1, 0.0, -0.1))),
    Turning(point=(0.5, 0.5, 0.0), axis=(0.0, 0.0, 1.0), rate=2.0),
    Sliding(direction=(1.0, 0.0, -2.0), travel=Spline(times=(0.0, 1.0, 2.0), points=(0.0, 0.3, 0.1), monotone=True)),
    Swinging(point=(0.5, 0.0, 0.0), axis=(0.0, 1.0, 1.0), angle=Haversine(height=0.2, duration=0.5)),
]


@dataclass(frozen=True)
class With:
    """A made-up run with another tool."""

    fake: object
    tool: Tool

    def run(self, out: Path):
        opening = self.fake.opening()
        scene = Scene(bodies={**opening.scene.bodies, "floor": self.tool}, contacts=opening.scene.contacts)
        return record_run(self.fake.steps(), replace(opening, scene=scene), RunFolder(out=out))


@pytest.fixture
def volume(bar):
    return replace(bar, mesh=shapes.box((1.0, 1.0, 1.0), (2, 2, 2)), probes=())


@pytest.fixture
def plane(bar):
    return replace(bar, mesh=shapes.rectangle((1.0, 1.0), (2, 2)), probes=())


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: type(m).__name__)
@pytest.mark.parametrize(
    "shape", [s for s in SOLID if not isinstance(s, SignedDistance)], ids=lambda s: type(s).__name__
)
def test_a_description_gives_the_tool_back(shape, motion):
    tool = Tool(shape=shape, motion=motion)
    again = recovered(json.loads(json.dumps(described(tool))))
    x = np.random.default_rng(0).uniform(-1.0, 1.0, (40, 3))
    assert again.motion == motion and type(again.shape) is type(shape)
    assert np.array_equal(again.at(0.3).gap(x), tool.at(0.3).gap(x))
    assert np.array_equal(again.at(0.3).normal_at(x), tool.at(0.3).normal_at(x))


def test_a_surface_survives_its_file(volume, tmp_path):
    file = tmp_path / "die.obj"
    meshio.write(file, meshio.Mesh(PYRAMID, [("triangle", SIDES)]))
    run = With(volume, Tool(shape=Surface(file=file, smooth=True), motion=MOTIONS[1])).run(tmp_path / "run")
    file.unlink()
    kept = run.fields.cells.tools["floor"]
    assert kept.shape.smooth and np.array_equal(kept.shape.points[kept.shape.cells], PYRAMID[SIDES])
    assert run.fields.cells.obstacles(2.0)["floor"].pose.shift.tolist() == [0.0, 0.2, -0.4]


@pytest.mark.slow
@pytest.mark.few(5)
@pytest.mark.parametrize("shape", SOLID, ids=lambda s: type(s).__name__)
def test_every_shape_is_drawn_moving(shape, volume, tmp_path):
    pytest.importorskip("matplotlib")
    run = With(volume, Tool(shape=shape, motion=MOTIONS[3])).run(tmp_path / "run")
    assert picture(run).save(tmp_path / "bodies.png").stat().st_size > 10_000


@pytest.mark.slow
@pytest.mark.parametrize("shape", PLANE, ids=lambda s: type(s).__name__)
def test_every_shape_is_drawn_in_the_plane(shape, plane, tmp_path):
    pytest.importorskip("matplotlib")
    run = With(plane, Tool(shape=shape, motion=Turning(point=(0.5, 0.0), rate=0.2))).run(tmp_path / "run")
    assert picture(run).save(tmp_path / "bodies.png").stat().st_size > 10_000


def test_facets_are_drawn_where_they_stand(volume, tmp_path):
    """A pyramid that rises by one length a second stands 0.5 higher at the instant of greatest strain energy."""
    pytest.importorskip("matplotlib")
    tops = []
    for speed in (0.0, 1.0):
        tool = Tool(shape=FACETS, motion=Translation(velocity=(0.0, 0.0, speed)))
        axis = bodies(With(volume, tool).run(tmp_path / f"run{speed}")).axes[0]
        drawn = next(c for c in axis.collections if c.get_zorder() == 0)
        tops.append(max(path.vertices[:, 1].max() for path in drawn.get_paths()))
    assert tops[1] - tops[0] == pytest.approx(0.5 * np.cos(np.radians(18.0)), rel=1e-9)


def test_a_moving_wall_is_a_line_in_the_picture_of_a_bar(bar, tmp_path):
    pytest.importorskip("matplotlib")
    ram = Tool(shape=HalfSpace(point=-0.5, normal=1.0), motion=Translation(velocity=0.25))
    (left, *_, right) = paths(With(bar, ram).run(tmp_path / "run")).axes
    line = next(k for k in left.lines if k.get_label() == "floor")
    np.testing.assert_allclose(line.get_ydata(), -0.5 + 0.25 * line.get_xdata() / 1e0, atol=1e-12)
    assert len(right.lines) >= 2


def test_other_obstacles_of_a_bar_are_drawn_where_they_cut_its_line(bar, tmp_path):
    pytest.importorskip("matplotlib")
    wall = SignedDistance(function=level, dim=1)
    (left, *_, right) = paths(With(bar, Tool(shape=wall)).run(tmp_path / "run")).axes
    found = [axis.collections[-1].get_paths()[0].vertices for axis in (left, right)]
    np.testing.assert_allclose(found[0][:, 1], -0.2, atol=1e-12)
    np.testing.assert_allclose(found[1][:, 0], -0.2, atol=1e-12)


@dataclass(frozen=True)
class Ridge:
    """A shape outside of the package: below the roof z = -|y| / 2 - 0.2."""

    dim: int = 3

    def gap(self, x):
        return (x[..., 2] + 0.2 + 0.5 * np.abs(x[..., 1])) / np.sqrt(1.25)

    def normal_at(self, x):
        return np.stack([0.0 * x[..., 0], 0.5 * np.sign(x[..., 1]), 1.0 + 0.0 * x[..., 2]], axis=-1) / np.sqrt(1.25)


@pytest.mark.parametrize(
    "shape",
    [
        SignedDistance(function=lambda x: x[:, 2] + 0.2, dim=3),
        Cavity(of=SignedDistance(function=level, dim=3)),
        Ridge(),
    ],
    ids=["lambda", "cavity", "own"],
)
def test_a_shape_that_is_no_data_is_stored_by_its_gaps(shape, volume, tmp_path):
    pytest.importorskip("matplotlib")
    run = With(volume, Tool(shape=shape)).run(tmp_path / "run")
    kept = run.fields.cells.tools["floor"]
    x = np.random.default_rng(0).uniform(-1.0, 2.0, (200, 3))
    spacing = (1.0 + 2.0 * np.sqrt(3.0)) / 40.0
    np.testing.assert_allclose(kept.shape.gap(x), shape.gap(x), atol=0.3 * spacing)
    away = np.abs(x[:, 1]) > 2.0 * spacing
    np.testing.assert_allclose(kept.shape.normal_at(x)[away], shape.normal_at(x)[away], atol=1e-6)
    assert picture(run).save(tmp_path / "bodies.png").stat().st_size > 10_000


def test_far_places_of_a_stored_shape_stay_far():
    shape = sampled(Sphere(centre=(0.0, 0.0), radius=1.0), np.array([[-2.0, -2.0], [2.0, 2.0]]))
    assert shape.gap(np.array([5.0, 0.0])) == pytest.approx(4.0, abs=1e-3)
    assert shape.normal_at(np.array([[5.0, 0.0]]))[0] == pytest.approx([1.0, 0.0], abs=1e-2)


@pytest.mark.parametrize(
    "shape",
    [
        {"kind": "SignedDistance", "function": "subprocess:getoutput", "dim": 3, "gradient": None, "step": 1e-6},
        {"kind": "builtins:eval"},
        {"kind": "Sphere", "centre": [0.0, 0.0], "radius": 1.0, "function": "os:system"},
        {"kind": "Sphere"},
        {},
    ],
    ids=["function", "kind", "more", "less", "none"],
)
def test_a_file_runs_no_code(shape, volume, tmp_path, monkeypatch):
    """A run folder that was sent may hold anything: what is no data of ours is named and not drawn."""
    pytest.importorskip("matplotlib")
    run = With(volume, Tool(shape=Sphere(centre=(0.5, 0.5, -0.7), radius=0.7))).run(tmp_path / "run")
    with h5py.File(tmp_path / "run" / "fields.vtkhdf", "r+") as file:
        del file["tools"]
        file["tools"] = json.dumps({"floor": {"kind": "Tool", "shape": shape, "motion": {"kind": "Still"}}})
    monkeypatch.setattr(subprocess, "getoutput", lambda *given: pytest.fail("code of the file was run"))
    assert run.fields.cells.lost == ("floor",) and not run.fields.cells.tools
    assert "Not drawn: floor." in bodies(run).get_supxlabel()
