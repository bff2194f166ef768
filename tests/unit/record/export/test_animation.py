"""Animation in glTF: nodes move as the bodies do, and the file is well formed."""

import json
from base64 import b64decode
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.mechanisms import Rigid

FOLDER = Path(__file__).parents[4] / "scenarios"
WIDTH = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
KINDS = {5126: "<f4", 5125: "<u4"}


def numbers(found: dict[str, Any], accessor: int) -> Array:
    """Array of an accessor, with its limits checked."""
    about = found["accessors"][accessor]
    view, data = found["bufferViews"][about["bufferView"]], b64decode(found["buffers"][0]["uri"].partition(",")[2])
    assert view["byteOffset"] % 4 == 0 and found["buffers"][0]["byteLength"] == len(data)
    part = data[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    values = np.frombuffer(part, KINDS[about["componentType"]]).reshape(about["count"], WIDTH[about["type"]])
    assert values.min(axis=0).tolist() == about["min"] and values.max(axis=0).tolist() == about["max"]
    return values.astype(float)


def tracks(found: dict[str, Any], name: str) -> dict[str, Array]:
    """Times, places and rotations of a node over time."""
    node = next(k for k, one in enumerate(found["nodes"]) if one["name"] == name)
    made = found["animations"][0]
    out = {}
    for channel in made["channels"]:
        if channel["target"]["node"] == node:
            sampler = made["samplers"][channel["sampler"]]
            out["time"] = numbers(found, sampler["input"])[:, 0]
            out[channel["target"]["path"]] = numbers(found, sampler["output"])
    return out


def points(found: dict[str, Any], name: str) -> tuple[Array, Array]:
    """Points and triangles of the mesh of a node."""
    node = next(one for one in found["nodes"] if one["name"] == name)
    part = found["meshes"][node["mesh"]]["primitives"][0]
    return numbers(found, part["attributes"]["POSITION"]), numbers(found, part["indices"]).reshape(-1, 3)


@pytest.fixture(scope="module")
def top(tmp_path_factory) -> tuple[sw.Run, dict[str, Any]]:
    """Short run of the tippe top, which turns many times, and its animation."""
    folder = tmp_path_factory.mktemp("runs")
    run = sw.run(sw.load(FOLDER / "tippe_top.toml", ("time.end=0.1 s",)), folder / "run")
    return run, json.loads(run.export(folder / "top.gltf").read_text(encoding="utf-8"))


def test_a_node_moves_as_its_body(top):
    run, found = top
    track, body = tracks(found, "top"), run.bodies["top"]
    assert track["time"] == pytest.approx(run.motion["time"], rel=1e-6)
    assert track["translation"] == pytest.approx(body.place, abs=1e-7)
    turns = np.roll(track["rotation"], 1, axis=1)
    sign = np.sign((turns * body.quaternion).sum(axis=1))[:, None]
    assert turns * sign == pytest.approx(body.quaternion, abs=1e-6)
    assert (sign < 0.0).any()  # it turns more than once
    assert ((track["rotation"][1:] * track["rotation"][:-1]).sum(axis=1) > 0.9).all()  # and no sign jumps


def test_balls_and_floors_have_their_sizes(top):
    _, found = top
    place, triangles = points(found, "top")
    middle = np.array([0.005 * np.sin(0.1), 0.0, 0.005 * np.cos(0.1)])
    assert triangles.max() < len(place)
    distance = np.linalg.norm(place - middle, axis=1)
    assert (np.abs(distance - 0.025) < 1e-8).sum() > 500 and distance.max() < 1.05 * 0.025
    assert np.ptp(points(found, "floor")[0][:, 2]) == 0.0
    root = found["nodes"][found["scenes"][0]["nodes"][0]]
    assert root["children"] == [0, 1] and root["rotation"] == pytest.approx([-(0.5**0.5), 0.0, 0.0, 0.5**0.5])


def test_bars_reach_to_the_joints(tmp_path):
    run = sw.run(sw.load(FOLDER / "slider_crank.toml", ("time.end=5 ms",)), tmp_path / "run")
    found = json.loads(run.export(tmp_path / "crank.gltf").read_text(encoding="utf-8"))
    place, _ = points(found, "crank")
    assert place[:, 0].min() == pytest.approx(-0.05) and place[:, 0].max() == pytest.approx(0.05)
    assert {node["name"] for node in found["nodes"]} == {"crank", "rod", "slider", "Slider-crank"}


def test_a_single_body_without_parts(tmp_path):
    body = {"stone": Rigid(mass=1.0, centre=(0.0, 0.0), velocity=(1.0, 0.0))}
    run = sw.run(sw.Scenario(bodies=body, time=sw.Time(end=1.0, step=0.1)), tmp_path / "run")
    found = json.loads(run.export(tmp_path / "stone.gltf").read_text(encoding="utf-8"))
    assert tracks(found, "stone")["translation"][-1] == pytest.approx([1.0, 0.0, 0.0])


def test_vtk_reads_it(top, tmp_path):
    """The reader of ParaView places the body as the run does."""
    vtk = pytest.importorskip("vtkmodules.vtkIOGeometry")
    run, _ = top
    file = run.export(tmp_path / "top.gltf")
    reader = vtk.vtkGLTFReader()
    reader.SetFileName(str(file))
    reader.UpdateInformation()
    assert reader.GetNumberOfAnimations() == 1
    assert reader.GetAnimationDuration(0) == pytest.approx(0.1)
