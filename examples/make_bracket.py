"""The mounting bracket of the drop scenario, modelled and meshed with Gmsh.

The bracket is an L of steel sheet, 80 mm x 40 mm at its base, 60 mm high and 10 mm thick. Its inner edge is filleted,
its outer corners are rounded, and each leg has a bolt hole. The program needs the package ``gmsh``::

    python examples/make_bracket.py scenarios/bracket.msh
"""

import sys
from collections.abc import Callable

import gmsh

LENGTH, WIDTH, HEIGHT, THICKNESS = 80.0, 40.0, 60.0, 10.0  # mm
FILLET, CORNER, HOLE = 8.0, 8.0, 6.0  # radii, mm
BASE_HOLE = (55.0, 20.0)  # x, y of the hole through the flat leg
WALL_HOLE = (20.0, 38.0)  # y, z of the hole through the upright leg
SIZE, SIZE_ROUND = 6.5, 5.0  # edge lengths of the cells: general, on the round faces


def model() -> None:
    """Build the solid in the current Gmsh model."""
    make = gmsh.model.occ
    flat = make.addBox(0.0, 0.0, 0.0, LENGTH, WIDTH, THICKNESS)
    upright = make.addBox(0.0, 0.0, 0.0, THICKNESS, WIDTH, HEIGHT)
    make.fuse([(3, flat)], [(3, upright)])
    make.synchronize()
    rounded(FILLET, lambda x, y, z: near(x, THICKNESS) and near(z, THICKNESS))
    rounded(CORNER, lambda x, y, z: near(x, LENGTH) and near(z, 0.5 * THICKNESS))
    rounded(CORNER, lambda x, y, z: near(z, HEIGHT) and near(x, 0.5 * THICKNESS))
    drills = [
        (3, make.addCylinder(*BASE_HOLE, -1.0, 0.0, 0.0, THICKNESS + 2.0, HOLE)),
        (3, make.addCylinder(-1.0, *WALL_HOLE, THICKNESS + 2.0, 0.0, 0.0, HOLE)),
    ]
    make.cut(gmsh.model.getEntities(3)[:1], drills)
    make.synchronize()


def near(value: float, wanted: float) -> bool:
    """True if two lengths are equal within the tolerance of the modeller."""
    return abs(value - wanted) < 1e-3


def rounded(radius: float, where: Callable[[float, float, float], bool]) -> None:
    """Round the edges of the solid whose centre of mass satisfies ``where(x, y, z)``."""
    make = gmsh.model.occ
    edges = [tag for dim, tag in gmsh.model.getEntities(1) if where(*make.getCenterOfMass(dim, tag))]
    make.fillet([tag for _, tag in gmsh.model.getEntities(3)], edges, [radius])
    make.synchronize()


def groups() -> None:
    """Define physical groups, which become tags (volume, underside, walls of the holes), and the mesh size."""
    faces = gmsh.model.getEntities(2)
    at = {tag: gmsh.model.occ.getCenterOfMass(2, tag) for _, tag in faces}
    round_ = [tag for _, tag in faces if gmsh.model.getType(2, tag) == "Cylinder"]
    base = [tag for _, tag in faces if tag not in round_ and near(at[tag][2], 0.0)]
    holes = [
        tag
        for tag in round_
        if near(at[tag][0], BASE_HOLE[0]) and near(at[tag][1], BASE_HOLE[1])
        or near(at[tag][1], WALL_HOLE[0]) and near(at[tag][2], WALL_HOLE[1])
    ]  # fmt: skip
    assert len(base) == 1 and len(holes) == 2, (base, holes)
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="bracket")
    gmsh.model.addPhysicalGroup(2, base, name="base")
    gmsh.model.addPhysicalGroup(2, holes, name="holes")
    field = gmsh.model.mesh.field
    distance, size = field.add("Distance"), field.add("Threshold")
    field.setNumbers(distance, "SurfacesList", round_)
    for option, value in (
        ("InField", distance),
        ("SizeMin", SIZE_ROUND),
        ("SizeMax", SIZE),
        ("DistMin", 2.0),
        ("DistMax", 15.0),
    ):
        field.setNumber(size, option, value)
    field.setAsBackgroundMesh(size)


def mesh(path: str) -> None:
    """Mesh with optimised second-order tetrahedra and write a binary Gmsh 4.1 file."""
    options = {
        "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.Algorithm": 6, "Mesh.Algorithm3D": 10, "Mesh.Optimize": 1, "Mesh.OptimizeNetgen": 1,
        "Mesh.ElementOrder": 2, "Mesh.HighOrderOptimize": 2, "Mesh.MshFileVersion": 4.1, "Mesh.Binary": 1,
        "General.NumThreads": 1,
    }  # fmt: skip
    for name, value in options.items():
        gmsh.option.setNumber(name, value)
    gmsh.model.mesh.generate(3)
    gmsh.write(path)


def main() -> None:
    """Build the model, mesh it and write the file."""
    gmsh.initialize(["make_bracket", "-v", "2"])
    try:
        gmsh.model.add("bracket")
        model()
        groups()
        mesh(sys.argv[1] if len(sys.argv) > 1 else "bracket.msh")
    finally:
        gmsh.finalize()


if __name__ == "__main__":
    main()
