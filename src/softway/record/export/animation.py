"""Animation of a mechanism in the format glTF 2.0, which ParaView, Blender and viewers in browsers read.

A body is a bar from its centre to each of its joints, springs and stops, and the balls of its stops.  Planes of the
ground are drawn as far as they are used.  Places are those of the run in single precision.
"""

import json
from base64 import b64encode
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from softway.arrays import Array, IntArray
from softway.mechanisms.members.rows import in_space
from softway.record.export.solids import ball, bar, merged, plate
from softway.record.read.body_motion import BodyMotion
from softway.record.read.records import Records
from softway.record.view.mechanism.drawing import colours, radii
from softway.record.view.mechanism.pose import Poses, body_points, poses

THIN = 0.015
"""Thickness of the bars relative to the size of the mechanism."""
RIM = 1.03
"""Half length of the bars through a ball relative to its radius."""
GREY = "#888888"
FLOAT, UINT = 5126, 5125
"""Numbers of glTF for kinds of components."""
UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
"""Rotation of the scene in space: z points upwards, in glTF y does."""


@dataclass(frozen=True, slots=True, eq=False)
class Parts:
    """Content of a file as it grows: bytes, their views, meshes, materials and nodes."""

    data: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    meshes: list[dict[str, Any]] = field(default_factory=list)
    materials: list[dict[str, Any]] = field(default_factory=list)
    nodes: list[dict[str, Any]] = field(default_factory=list)

    def stored(self, values: Array | IntArray, kind: str) -> int:
        """Store an array as ``kind`` of accessor; its number."""
        whole = values.dtype.kind != "f"
        plain = np.ascontiguousarray(values, dtype="<u4" if whole else "<f4")
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": plain.nbytes})
        self.data.extend(plain.tobytes())
        rows = plain.reshape(len(plain), -1)
        ends = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        about = {"bufferView": len(self.views) - 1, "componentType": UINT if whole else FLOAT, "count": len(plain)}
        self.accessors.append({**about, "type": kind, **ends})
        return len(self.accessors) - 1

    def shown(self, name: str, shape: tuple[Array, IntArray], colour: str, alpha: float = 1.0) -> int:
        """Add a node with a mesh of points (n, 3) and triangles (t, 3); its number."""
        points, triangles = shape
        red, green, blue = (int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5))
        look = {"baseColorFactor": [red, green, blue, alpha], "metallicFactor": 0.0, "roughnessFactor": 0.8}
        mode = {} if alpha == 1.0 else {"alphaMode": "BLEND"}
        self.materials.append({"name": name, "pbrMetallicRoughness": look, "doubleSided": True, **mode})
        attributes = {"POSITION": self.stored(points, "VEC3")}
        mesh = {"attributes": attributes, "indices": self.stored(triangles.ravel(), "SCALAR")}
        self.meshes.append({"name": name, "primitives": [{**mesh, "material": len(self.materials) - 1}]})
        self.nodes.append({"name": name, "mesh": len(self.meshes) - 1})
        return len(self.nodes) - 1


def animation(run: Records, bodies: Mapping[str, BodyMotion]) -> str:
    """Text of a file of glTF with the motion of the bodies of a run.

    Raises
    ------
    InputError
        If a table of the run is missing or damaged.
    """
    shown, parts = poses(run), Parts()
    size = float(np.linalg.norm(np.ptp(np.vstack([body.place for body in bodies.values()]), axis=0))) + _reach(shown)
    colour, moving = colours(shown), {}
    for name in bodies:
        moving[name] = parts.shown(name, merged(_solid(shown, name, size)), colour[name])
    for name, corners in shown.floors.items():
        normal = next(stop["normal"] for stop in shown.parts["stops"] if stop["name"] == name)
        parts.shown(
            name,
            plate(np.array([in_space(corner) for corner in corners]), in_space(normal), 0.1 * size),
            "#888888",
            0.4,
        )
    channels, samplers = [], []
    time = parts.stored(run.motion["time"], "SCALAR")
    for name, node in moving.items():
        for path, values, kind in tracks(bodies[name].place, bodies[name].quaternion):
            samplers.append({"input": time, "output": parts.stored(values, kind), "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
    return text_of(run, parts, {"name": "motion", "channels": channels, "samplers": samplers}, shown.parts["dim"])


def text_of(run: Records, parts: Parts, moved: dict[str, Any], dim: int) -> str:
    """Text of the file; the bytes are in it."""
    root = {"name": str(run.provenance.get("title", "")) or "mechanism", "children": list(range(len(parts.nodes)))}
    nodes = [*parts.nodes, {**root, **({"rotation": UPRIGHT} if dim == 3 else {})}]
    address = "data:application/octet-stream;base64," + b64encode(bytes(parts.data)).decode()
    found = {
        "asset": {"version": "2.0", "generator": "softway"},
        "scene": 0,
        "scenes": [{"nodes": [len(nodes) - 1]}],
        "nodes": nodes,
        "meshes": parts.meshes,
        "materials": parts.materials,
        "animations": [moved],
        "accessors": parts.accessors,
        "bufferViews": parts.views,
        "buffers": [{"byteLength": len(parts.data), "uri": address}],
    }
    return json.dumps(found) + "\n"


def tracks(place: Array, quaternion: Array) -> Iterator[tuple[str, Array, str]]:
    """Places (t, 3) and quaternions (t, 4) over time, these with the scalar last and without jumps of their sign."""
    yield "translation", place, "VEC3"
    turns = np.roll(quaternion, -1, axis=1)
    jumps = np.where((turns[1:] * turns[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    yield "rotation", turns * np.concatenate([[1.0], np.cumprod(jumps)])[:, None], "VEC4"


def _solid(shown: Poses, name: str, size: float) -> Iterator[tuple[Array, IntArray]]:
    """Parts of a body around its centre at the start."""
    centre = in_space(shown.parts["bodies"][name])
    thick = THIN * size
    yield bar(np.zeros(3), np.array([thick, 0.0, 0.0]), 2.0 * thick)
    for point in body_points(shown.parts, name):
        if np.linalg.norm(in_space(point) - centre) > thick:
            yield bar(np.zeros(3), in_space(point) - centre, thick)
    for radius, start in radii(shown, name):
        middle = in_space(start) - centre
        yield ball(middle, radius)
        for way in RIM * radius * np.eye(3):  # ends that stand out show how the ball turns
            yield bar(middle - way, middle + way, 0.1 * radius)


def _reach(shown: Poses) -> float:
    """Greatest distance of a point of a body from its centre, or radius of a ball [m]."""
    found = [1e-9]
    for name, centre in shown.parts["bodies"].items():
        found += [float(np.linalg.norm(np.subtract(point, centre))) for point in body_points(shown.parts, name)]
        found += [radius for radius, _ in radii(shown, name)]
    return max(found)
