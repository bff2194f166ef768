"""Rigid tools as plain data, stored in a run folder."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.bodies.prescribed_motion import Sliding, Still, Swinging, Table, Translation, Turning
from softway.bodies.setup.motion_laws import Haversine, RatePolyline, Sine, SmoothSteps, Spline
from softway.bodies.solid import Tool
from softway.errors import InputError
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cavity, Cylinder, Roller, Sphere, Torus
from softway.obstacles.triangulated import Facets, Surface
from softway.record.write.shapes.sampled_distance import SampledDistance, sampled

SHAPES = (HalfSpace, Sphere, Roller, Cylinder, Block, Torus, Cavity, Facets, SampledDistance)
MOTIONS = (Still, Translation, Table, Turning, Sliding, Swinging, Spline, SmoothSteps, Sine, Haversine, RatePolyline)
KINDS: dict[str, type] = {kind.__name__: kind for kind in (Tool, *SHAPES, *MOTIONS)}


def stored(tool: Tool, points: Array) -> dict[str, Any]:
    """Plain data of a tool near the bodies with reference positions ``points`` (n, d).

    A shape that is no plain data (a function, or a class outside of softway) is stored by its gaps at the points of a
    grid, which reaches beyond the bodies by their size.
    """
    found: dict[str, Any] = described(tool)
    return found if _plain(tool.shape) else {**found, "shape": described(sampled(tool.shape, _around(points)))}


def _plain(shape: Any) -> bool:
    if isinstance(shape, Cavity):
        return _plain(shape.of)
    return type(shape) in SHAPES or isinstance(shape, Surface)


def _around(points: Array) -> Array:
    low, high = points.min(axis=0), points.max(axis=0)
    margin = max(float(np.linalg.norm(high - low)), np.finfo(float).tiny)
    return np.array([low - margin, high + margin])


def described(thing: Any) -> Any:
    """Convert a tool, shape or motion to plain data with its ``kind``; :func:`recovered` is the inverse.

    A surface from a file is described by its facets, so the file is not needed later.

    Examples
    --------
    >>> described(HalfSpace(point=1.0, normal=-1.0))
    {'kind': 'HalfSpace', 'point': 1.0, 'normal': -1.0}
    """
    if isinstance(thing, Surface):
        return described(thing.facets)
    if isinstance(thing, np.ndarray):
        return thing.tolist()
    if is_dataclass(thing):
        values = {f.name: described(getattr(thing, f.name)) for f in fields(thing) if f.init}
        return {"kind": type(thing).__name__, **values}
    return thing


def recovered(data: Any) -> Any:
    """Restore a tool, shape or motion from the plain data of :func:`described`; no data lead to code.

    Raises
    ------
    InputError
        If a kind is unknown, or values do not fit it.

    Examples
    --------
    >>> recovered(described(Sphere(centre=(0.0, 1.0), radius=2.0)))
    Sphere(centre=(0.0, 1.0), radius=2.0)
    """
    if not isinstance(data, Mapping):
        return tuple(recovered(value) for value in data) if isinstance(data, list) else data
    kind = KINDS.get(str(data.get("kind")))
    if kind is None:
        raise InputError("tools", f"the kind {data.get('kind')!r}", f"one of {', '.join(KINDS)}")
    given = {name: value if name == "values" else recovered(value) for name, value in data.items() if name != "kind"}
    try:
        return kind(**given)
    except (TypeError, ValueError) as error:
        raise InputError("tools", f"{kind.__name__} with {', '.join(given)}: {error}", "a file of softway") from error
