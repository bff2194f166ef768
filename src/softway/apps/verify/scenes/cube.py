"""Cube thrown at a plane: the problem used to measure other packages."""

import softway as sw
from softway.bodies.inertia.mass_matrix import MassRule

END, STEP, ENERGY = 0.05, 5e-4, 12.5
"""End time, slab length, initial energy."""


def drop(cells: int, cell: str = "hex8", mass: MassRule = sw.bodies.Consistent()) -> sw.Scene:
    """Scene of a neo-Hookean cube with ``cells`` along each edge, thrown at a plane 0.05 below it."""
    cube = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells), cell=cell),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -5.0)),
        mass=mass,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.05), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))
