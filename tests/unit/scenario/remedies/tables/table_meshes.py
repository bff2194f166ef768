"""Refusals of meshes, of their generators, and of laws and densities by regions."""

from collections.abc import Callable
from typing import Any

import numpy as np
from try_it import BAR, PLANE, Call, Table, Try

import softway as sw
from softway.meshes.element import element
from softway.meshes.generators.graded import geometric, graded_disc, grid, ring
from softway.meshes.generators.shapes import rectangle
from softway.meshes.mesh import Mesh

MESH = "bodies.b.mesh"
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
QUAD = np.array([[0, 1, 2, 3]])


def made(kind: str, wrong: str, remedy: str, follow: str, text: str = PLANE) -> Try:
    """Generator with an argument that is wrong, of a body without contact."""
    return Try(text, f"contacts=[] & {MESH}={{kind='{kind}', {wrong}}}", remedy, f"{MESH}.{follow}")


def mesh(remedy: str, points: object = SQUARE, *, right: Mesh | None = None, **blocks: object) -> Call:
    """Mesh from arrays that is wrong, and a right one."""
    return Call(
        lambda _: Mesh(points=points, blocks=blocks),
        remedy,
        lambda _: right or Mesh(points=SQUARE, blocks={"quad4": QUAD}),
    )  # type: ignore[arg-type]


def call(wrong: Callable[[], object], remedy: str, right: Callable[[], object]) -> Call:
    """Call of a generator that is wrong, and one that is right."""
    return Call(lambda _: wrong(), remedy, lambda _: right())


HALVES = BAR.replace(
    'mesh = { kind = "Interval", length = 1, cells = 4, origin = 0.01 }',
    'mesh = { kind = "Divided", mesh = { kind = "Interval", length = 1, cells = 4, origin = 0.01 }, '
    'regions = { a = { kind = "InBox", high = [0.5] } }, rest = "b" }',
).replace(
    'material = { kind = "LinearElastic", E = 1, nu = 0.3 }',
    'material = { a = { kind = "LinearElastic", E = 1 }, b = { kind = "LinearElastic", E = 2 } }',
)
B = "bodies.b"
SOFT = "{kind='LinearElastic', E=1}"
CENTRED = "{kind='InBall', centre=[0.2], radius=0.4}"


def built(**given: Any) -> object:
    """Bar of two halves."""
    line = sw.meshes.Interval(length=1.0, cells=4)
    mesh = sw.meshes.Divided(mesh=line, regions={"a": sw.meshes.InBox(high=(0.5,))}, rest="b")
    laws = {"a": sw.LinearElastic(E=1.0), "b": sw.LinearElastic(E=2.0)}
    solid = sw.Solid(**{"mesh": mesh, "material": laws, "density": 1.0, **given})
    return sw.build(sw.Scene(bodies={"bar": solid}))


def overlapping(start: float) -> Mesh:
    """Bar whose region ``b`` begins at ``start``; region ``a`` ends in the middle."""
    line = sw.meshes.Interval(length=1.0, cells=4).build()
    return line.with_region("a", lambda x: x[:, 0] < 0.5).with_region("b", lambda x: x[:, 0] > start)


REGIONS: Table = {
    "no such region": Try(
        HALVES, f"{B}.material={{a={SOFT}, c={SOFT}}}", "one of: a, b, all", f"{B}.material={{a={SOFT}, b={SOFT}}}"
    ),
    "cells without a law": Try(HALVES, f"{B}.material={{a={SOFT}}}", "a law for b", f"{B}.material.b={SOFT}"),
    "cells in no region": Try(
        HALVES, f"{B}.mesh.rest='' & {B}.material={{a={SOFT}}}", "Divided with rest", f"{B}.mesh.rest=a"
    ),
    "cells with two laws": call(
        lambda: built(mesh=overlapping(0.2)), "regions without common cells", lambda: built(mesh=overlapping(0.5))
    ),
    "no law": call(lambda: built(material={}), "a law for each region", lambda: built()),
    "soft region": Try(HALVES, f"{B}.material.a.E=1e-300", "larger moduli", f"{B}.material.a.E=1"),
    "density of a region": Try(HALVES, f"{B}.density={{a=1, b=0}}", "7850 kg/m^3", f"{B}.density.b=7850 kg/m^3"),
    "missing density": Try(HALVES, f"{B}.density={{a=1}}", "a density for each region", f"{B}.density.b=1"),
    "one density for the body": Try(HALVES, f"{B}.density={{a=1}}", "or one for the body", f"{B}.density=1"),
    "density of no region": Try(
        HALVES, f"{B}.density={{a=1, b=1, c=1}}", "densities of: a, b", f"{B}.density={{a=1, b=1}}"
    ),
    "densities of one law": Try(BAR, f"{B}.density={{a=1}}", "one density", f"{B}.density=1"),
    "zone without cells": Try(
        HALVES, f"{B}.mesh.regions.a.high=[-1]", "a larger zone", f"{B}.mesh.regions.a.high=[0.5]"
    ),
    "zone of all space": Try(
        HALVES, f"{B}.mesh.regions.a={{kind='InBox'}}", "low, high, or both", f"{B}.mesh.regions.a.high=[0.5]"
    ),
    "zone of other dimension": Try(
        HALVES, f"{B}.mesh.regions.a.low=[0, 0]", "up to 1 coordinates", f"{B}.mesh.regions.a.low=[0]"
    ),
    "ball of other dimension": Try(
        HALVES,
        f"{B}.mesh.regions.a={{kind='InBall', centre=[0, 0], radius=0.5}}",
        "1 coordinates",
        f"{B}.mesh.regions.a={CENTRED}",
    ),
    "region of a mesh": call(
        lambda: sw.Mesh(points=[[0.0], [1.0]], blocks={"bar2": [[0, 1]]}, regions={"a": [1]}),
        "0 to 0",
        lambda: sw.Mesh(points=[[0.0], [1.0]], blocks={"bar2": [[0, 1]]}, regions={"a": [0]}),
    ),
}
TABLE: Table = {
    "size": made("Rectangle", "size=[0, 1], cells=[2, 2]", "a positive number", "size=[1, 1]"),
    "counts": made("Rectangle", "size=[1, 1], cells=[0, 2]", "1 or more", "cells=[1, 2]"),
    "cell": made("Rectangle", "size=[1, 1], cells=[2, 2], cell='hex8'", "quad4", "cell=quad4"),
    "many cells": made("Rectangle", "size=[1, 1], cells=[1000000, 1000000]", "fewer cells", "cells=[2, 2]"),
    "bar": made("Interval", "length=1, cells=2, direction=[0]", "another vector", "direction=[1]", BAR),
    "origin": made("Interval", "length=1, cells=2, origin=[0, 0], direction=[1]", "1 coordinates", "origin=[0]", BAR),
    "grid": made("Grid", "x=[0, 0], y=[0, 1]", "two or more increasing", "x=[0, 1]"),
    "ring": made("Ring", "inner=2, outer=1, cells=[2, 6]", "inner < outer", "outer=3"),
    "ring angle": made("Ring", "inner=1, outer=2, cells=[2, 6], angle=7", "up to a full turn", "angle=6"),
    "ring cells": made("Ring", "inner=1, outer=2, cells=[2, 2]", "three or more", "cells=[2, 3]"),
    "disc": made("Disc", "radius=1, cells=3", "an even number, 4 or more", "cells=4"),
    "graded radius": made("GradedDisc", "radius=0, focus=0.1, cells=4", "a positive number", "radius=1"),
    "graded part": made("GradedDisc", "radius=1, focus=0.1, cells=4, part='half'", "lower", "part=lower"),
    "graded focus": made("GradedDisc", "radius=1, focus=2, cells=4", "up to the radius", "focus=0.1"),
    "graded cells": made("GradedDisc", "radius=1, focus=0.1, cells=1", "2 or more", "cells=2"),
    "graded cell": made("GradedDisc", "radius=1, focus=0.1, cells=2, cell='tri3'", "quad8", "cell=quad8"),
    "graded centre": call(
        lambda: ring(1.0, 2.0, (2, 6), centre=(0.0,)), "two finite", lambda: ring(1.0, 2.0, (2, 6), centre=(0.0, 0.0))
    ),
    "lines": call(lambda: grid((0.0, 1.0)), "x, y and z", lambda: grid((0.0, 1.0), (0.0, 1.0))),
    "nan": mesh("finite coordinates", SQUARE * np.nan, quad4=QUAD),
    "beyond all places": mesh("coordinates up to", SQUARE * 1e60, quad4=QUAD),
    "four dimensions": mesh("d = 1, 2 or 3", np.zeros((4, 4)), quad4=QUAD),
    "no cells": mesh("at least one block"),
    "unknown cell": mesh("quad4", quad5=QUAD),
    "rows": mesh("(e, 4) node numbers", quad4=np.array([[0, 1, 2]])),
    "mixed": mesh("bars alone", quad4=QUAD, bar2=np.array([[0, 1]])),
    "numbers": mesh("0 to 3", quad4=QUAD + 1),
    "unused": mesh("remove unused points", np.concatenate([SQUARE, [[2.0, 2.0]]]), quad4=QUAD),
    "inverted": mesh("positive volume", quad4=QUAD[:, ::-1]),
    "twice": mesh("once", quad4=np.concatenate([QUAD, QUAD])),
    "in the same place": mesh("once", np.tile(SQUARE, (2, 1)), quad4=np.concatenate([QUAD, QUAD + 4])),
    "three at a facet": mesh(
        "at most two at a facet",
        np.concatenate([SQUARE[:3], [[0.5, -1.0], [0.5, -2.0]]]),
        tri3=np.array([[0, 1, 2], [3, 1, 0], [4, 1, 0]]),
    ),
    "edge of no length": Try(
        PLANE,
        f"contacts=[] & {MESH}={{kind='MeshFile', path='collapsed.inp'}}",
        "without coincident nodes",
        f"{MESH}.path=tagged.inp",
    ),
    "sizes": call(lambda: rectangle((1.0,), (1, 1)), "2 lengths", lambda: rectangle((1.0, 1.0), (1, 1))),  # type: ignore[arg-type]
    "numbers of cells": call(
        lambda: rectangle((1.0, 1.0), (1,)), "2 numbers of cells", lambda: rectangle((1.0, 1.0), (1, 1))
    ),  # type: ignore[arg-type]
    "ratio": call(lambda: geometric(0.0, 1.0, 0, 2.0), "one cell or more", lambda: geometric(0.0, 1.0, 1, 2.0)),
    "part": call(
        lambda: graded_disc(1.0, 0.1, 4, part="half"), "lower", lambda: graded_disc(1.0, 0.1, 4, part="lower")
    ),  # type: ignore[arg-type]
    "point": call(
        lambda: rectangle((1.0, 1.0), (1, 1)).nearest(0.0),
        "2 coordinates",
        lambda: rectangle((1.0, 1.0), (1, 1)).nearest((0.0, 0.0)),
    ),
    "element": call(lambda: element("quad5"), "quad4", lambda: element("quad4")),
    "tags": call(
        lambda: rectangle((1.0, 1.0), (1, 1)).nodes("tpo"),
        "top, or one of",
        lambda: rectangle((1.0, 1.0), (1, 1)).nodes("top"),
    ),
}
TABLE |= REGIONS
