"""Refusals of tools and bodies from files."""

import numpy as np
from try_it import PLANE, SPACE, Call, Table, Try

from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Sphere
from softway.obstacles.triangulated import Facets

SHAPE, MESH = "bodies.w.shape", "bodies.b.mesh"
POINTS = np.eye(3)
CELL = np.array([[0, 1, 2]])


def surface(wrong: str, remedy: str, follow: str = "box.stl") -> Try:
    """Tool of a file that is wrong, and the file that follows the remedy."""
    return Try(SPACE, f"{SHAPE}={{kind='Surface', file='{wrong}'}}", remedy, f"{SHAPE}.file={follow}")


def body(wrong: str, remedy: str, follow: str = "path=tagged.inp", more: str = "", then: str = "") -> Try:
    """Body of a file that is wrong, and the change that follows the remedy."""
    return Try(
        PLANE, f"contacts=[] & {MESH}={{kind='MeshFile', path='{wrong}'{more}}}", remedy, f"{MESH}.{follow}", then
    )


def facets(points: object, cells: object, remedy: str) -> Call:
    """Facets from arrays that are wrong, and right ones."""
    return Call(lambda _: Facets(points=points, cells=cells), remedy, lambda _: Facets(points=POINTS, cells=CELL))  # type: ignore[arg-type]


TABLE: Table = {
    "inside out": surface("inside_out.stl", "turn all facets around"),
    "opposite": surface("mixed.stl", "turn all facets to one side"),
    "thin facets": surface("thin.stl", "mesh the surface again"),
    "coincident": surface("wall.stl", "a wall with a thickness"),
    "no thickness": surface("hollow.stl", "a wall with a thickness"),
    "three at an edge": surface("fin.stl", "remove the inner facets"),
    "no file": surface("none.stl", "relative to the scenario"),
    "ending": surface("tool.step", ".stl"),
    "empty": surface("empty.stl", "a mesh file of up to"),
    "PLY": surface("bad.ply", "save the mesh again"),
    "damaged": surface("bad.stl", "save the mesh again"),
    "no facets": surface("points.msh", "a file with triangles"),
    "no facets of an OBJ": surface("points.obj", "a file with triangles"),
    "pentagon": surface("pentagon.obj", "triangles and quadrangles"),
    "damaged OBJ": surface("bad.obj", "save the mesh again"),
    "flat point": surface("flat.obj", "three coordinates of each point"),
    "pentagon of a PLY": surface("pentagon.ply", "mesh with: "),
    "pieces": surface("pieces.vtu", "a file with one piece"),
    "lines": surface("lines.msh", "lines in one plane, or facets"),
    "scale": Try(
        SPACE, f"{SHAPE}={{kind='Surface', file='box.stl', scale=0}}", "a positive length", f"{SHAPE}.scale=1"
    ),
    "facets of another space": Try(
        PLANE,
        f"{SHAPE}={{kind='Surface', file='box.stl'}}",
        "2 coordinates",
        f"{SHAPE}={{kind='HalfSpace', point=[0, 0], normal=[0, 1]}}",
    ),
    "points": facets(np.zeros((3, 4)), CELL, "finite coordinates (n, 2 or 3)"),
    "no cells": facets(POINTS, np.zeros((0, 3), int), "at least one facet"),
    "vertices": facets(POINTS, CELL + 1, "0 to 2"),
    "facets of no size": facets(np.ones((3, 3)), CELL, "a size greater than zero"),
    "gap of facets": Call(
        lambda _: Facets(points=POINTS, cells=CELL).gap(np.zeros((1, 2))),
        "a shape of that dimension",
        lambda _: Facets(points=POINTS[:, :2], cells=CELL[:, :2]).gap(np.zeros((1, 2))),
    ),
    "gap of a half-space": Call(
        lambda _: HalfSpace(point=0.0, normal=1.0).gap(np.zeros((1, 2))),
        "2 coordinates",
        lambda _: HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)).gap(np.zeros((1, 2))),
    ),
    "gap of a sphere": Call(
        lambda _: Sphere(centre=(0.0, 0.0), radius=1.0).gap(np.zeros((1, 3))),
        "a shape of that dimension",
        lambda _: Sphere(centre=(0.0, 0.0, 0.0), radius=1.0).gap(np.zeros((1, 3))),
    ),
    "sheet": body("sheet.inp", "such as C3D8 or C3D4, or plane ones such as CPE4"),
    "hanging": body("hanging.inp", "", "path=tagged.inp"),
    "overlapping": body("overlapping.inp", "cells that do not overlap"),
    "undefined": body("undefined.inp", "define the node by *NODE"),
    "wedge": body("wedge.inp", "mesh with: "),
    "lost include": body("lost.inp", "correct the path"),
    "include of itself": body("itself.inp", "remove the *INCLUDE line"),
    "include of nothing": body("no_input.inp", "INPUT=FILE"),
    "no keyword": body("no_keyword.inp", "such as *NODE"),
    "no instance": body("no_instance.inp", "one of: I"),
    "no cells of a deck": body("tagged.inp", "tri3", "cells=['quad4']", ", cells=['tri3']"),
    "none of a deck": body("tagged.inp", "one of: ALL", "only=ALL", ", only='steel'"),
    "pyramid": body("pyramid.msh", "mesh with: "),
    "no group": body("square.msh", "one of: steel", "only=steel", ", only='glass'"),
    "no cells of a mesh": body("square.msh", "quad4", "cells=['quad4']", ", cells=['tri3']"),
    "points of a mesh": body("points.msh", "a file with triangles"),
    "damaged mesh": body("bad.msh", "save the mesh again"),
    "unit": body("tagged.inp", "in, ft", "unit=in", ", unit='mil'"),
}
