"""Rigid tools as plain data, stored in a run folder."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from softway.bodies.prescribed_motion import Still, Table, Translation, Turning
from softway.bodies.solid import Tool
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cavity, Cylinder, Roller, Sphere, Torus
from softway.obstacles.signed_distance import SignedDistance
from softway.obstacles.triangulated import Facets, Surface

SHAPES = (HalfSpace, Sphere, Roller, Cylinder, Block, Torus, Cavity, Facets, SignedDistance)
KINDS: dict[str, type] = {kind.__name__: kind for kind in (Tool, *SHAPES, Still, Translation, Table, Turning)}


def described(thing: Any) -> Any:
    """Convert a tool, shape or motion to plain data with its ``kind``; :func:`recovered` is the inverse.

    A surface from a file is described by its facets, so the file is not needed later.  A function is described by its
    importable name.

    Examples
    --------
    >>> described(HalfSpace(point=1.0, normal=-1.0))
    {'kind': 'HalfSpace', 'point': 1.0, 'normal': -1.0}
    """
    if isinstance(thing, Surface):
        return described(thing.facets)
    if isinstance(thing, np.ndarray):
        return thing.tolist()
    if callable(thing):
        return f"{thing.__module__}:{getattr(thing, '__qualname__', '')}"
    if is_dataclass(thing):
        values = {f.name: described(getattr(thing, f.name)) for f in fields(thing) if f.init}
        return {"kind": type(thing).__name__, **values}
    return thing


def recovered(data: Any) -> Any:
    """Restore a tool, shape or motion from the plain data of :func:`described`.

    Raises
    ------
    InputError
        If a function cannot be imported.

    Examples
    --------
    >>> recovered(described(Sphere(centre=(0.0, 1.0), radius=2.0)))
    Sphere(centre=(0.0, 1.0), radius=2.0)
    """
    if isinstance(data, Mapping):
        return KINDS[data["kind"]](**{name: recovered(value) for name, value in data.items() if name != "kind"})
    return tuple(recovered(value) for value in data) if isinstance(data, list) else data
