"""A cube thrown at a plane: the problem on which other packages were measured."""

import softway as sw
from softway.bodies.mass import MassRule

END, STEP, ENERGY = 0.05, 5e-4, 12.5
"""End of the run, slab, energy at the start."""


def drop(cells: int, cell: str = "hex8", mass: MassRule = sw.Consistent()) -> sw.Scene:
    """A neo-Hookean cube of ``cells`` along each edge, thrown at a plane 0.05 below it."""
    cube = sw.Solid(
        mesh=sw.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells), cell=cell),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.Uniform(value=(0.0, 0.0, -5.0)),
        mass=mass,
    )
    floor = sw.Tool(shape=sw.HalfSpace(point=(0.0, 0.0, -0.05), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))
