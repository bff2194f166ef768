"""Round bodies pressed on a rigid plane without friction: scenes, static solutions, pressures from nodal forces.

In every scene the body is ``body``, the plane ``plane`` and the contact ``plane``. The radius is 1, E = 1, nu = 0.3.
"""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.arrays import Array, BoolArray
from softway.bodies.elements.section import Section
from softway.bodies.setup.loads import traction_force
from softway.meshes.generators.recipes import GradedDisc

YOUNGS, POISSON = 1.0, 0.3
ELASTIC = sw.LinearElastic(E=YOUNGS, nu=POISSON)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Footprint:
    """Contact nodes, ordered by their distance from the centre of contact.

    Parameters
    ----------
    place, force, area
        (c,) distance, force of the plane, and nodal area (integral of the shape function).
    """

    place: Array
    force: Array
    area: Array

    @property
    def closed(self) -> BoolArray:
        """Nodes (c,) in contact; mortar rows leave a small force on the others."""
        return np.asarray(self.force > 1e-4 * self.force.max())

    @property
    def pressure(self) -> Array:
        """Mean (c,) of the pressure, weighted with the shape function."""
        return self.force / self.area

    @property
    def edge(self) -> tuple[float, float]:
        """Distance of the last node in contact and of the first one without contact."""
        return float(self.place[self.closed].max()), float(self.place[~self.closed].min())

    @property
    def fitted(self) -> tuple[float, float]:
        """Peak p0 and half width b of the best fit p0 sqrt(1 - x^2/b^2), by least squares for p^2 over x^2."""
        on, weight = self.closed, np.sqrt(self.area[self.closed])
        columns = np.column_stack([np.ones(on.sum()), -(self.place[on] ** 2)])
        square, slope = np.linalg.lstsq(columns * weight[:, None], self.pressure[on] ** 2 * weight, rcond=None)[0]
        return float(np.sqrt(square)), float(np.sqrt(square / slope))


def footprint(mesh: sw.Mesh, section: Section, force: Array) -> Footprint:
    """Footprint of the part x >= 0 from the forces (c,) on the nodes of its ``boundary``."""
    nodes = mesh.nodes("boundary")
    unit = traction_force(mesh, section, "boundary", (0.0, 1.0))[nodes, 1]
    order = np.argsort(mesh.points[nodes, 0])
    return Footprint(place=mesh.points[nodes, 0][order], force=force[order], area=unit[order])


def loaded(load: float, mesh: GradedDisc) -> Footprint:
    """Footprint of a quarter cylinder under a uniform traction on the diameter; ``load`` is the load of the half.

    Only the contact supports the body.
    """
    traction = sw.Traction(on="body.diameter", value=(0.0, -0.5 * load))
    return _resting(mesh, sw.bodies.PlaneStrain(), (sw.Fixed(on="axis", components="x"),), -1.0, (traction,))


def approached(approach: float, mesh: GradedDisc, section: Section) -> Footprint:
    """Footprint of a quarter (of a cylinder, or the section of a hemisphere) whose diameter moves by ``approach``.

    The diameter is fixed and the plane is raised instead. It starts inside the body, and the overlap is removed.
    """
    supports = (sw.Fixed(on="axis", components="x"), sw.Fixed(on="diameter", components="y"))
    return _resting(mesh, section, supports, approach - 1.0)


def _resting(
    recipe: GradedDisc,
    section: Section,
    supports: tuple[sw.Fixed, ...],
    height: float,
    loads: tuple[sw.Traction, ...] = (),
) -> Footprint:
    """Static equilibrium on a plane, followed by one slab in which nothing may move."""
    mesh = recipe.build()
    body = sw.Solid(mesh=mesh, material=ELASTIC, density=1.0, section=section, supports=supports)
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, height), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("body.boundary", "plane"), name="plane", start="fit")
    bodies: dict[str, sw.Solid | sw.Tool] = {"body": body, "plane": plane}
    scene = sw.Scene(bodies=bodies, contacts=(contact,), loads=loads, start=sw.model.StaticStart())
    step = next(iter(sw.march(scene, until=1e-3, step=1e-3)))
    assert np.abs(step.after.velocity["body"]).max() < 1e-10
    return footprint(mesh, section, step.before.pressure["plane"])
