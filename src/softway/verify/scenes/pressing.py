"""Round bodies pressed on a rigid plane without friction: scenes, static solutions, and pressures from nodal forces.

In every scene the body is ``body``, the plane ``plane`` and the contact ``plane``. The radius is 1, E = 1, nu = 0.3.
"""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.bodies.loads import traction_force
from softway.bodies.section import Section
from softway.space.sources import GradedDisc
from softway.typing import Array, BoolArray

YOUNGS, POISSON = 1.0, 0.3
ELASTIC = sw.LinearElastic(E=YOUNGS, nu=POISSON)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Footprint:
    """Contact nodes in order of their place, the distance from the middle.

    Parameters
    ----------
    place, force, area
        (c,) distance, force of the plane, and the share of the surface: the integral of the shape function.
    """

    place: Array
    force: Array
    area: Array

    @property
    def closed(self) -> BoolArray:
        """(c,) nodes that touch; mortar rows leave a trace of force on the others."""
        return np.asarray(self.force > 1e-4 * self.force.max())

    @property
    def pressure(self) -> Array:
        """(c,) mean of the pressure weighted with the shape function."""
        return self.force / self.area

    @property
    def edge(self) -> tuple[float, float]:
        """Places of the last node that touches and of the first that does not."""
        return float(self.place[self.closed].max()), float(self.place[~self.closed].min())

    @property
    def fitted(self) -> tuple[float, float]:
        """Peak p0 and half width b of the p0 sqrt(1 - x^2/b^2) that suits best: p^2 is linear in x^2."""
        on, weight = self.closed, np.sqrt(self.area[self.closed])
        columns = np.column_stack([np.ones(on.sum()), -(self.place[on] ** 2)])
        square, slope = np.linalg.lstsq(columns * weight[:, None], self.pressure[on] ** 2 * weight, rcond=None)[0]
        return float(np.sqrt(square)), float(np.sqrt(square / slope))


def footprint(mesh: sw.Mesh, section: Section, force: Array) -> Footprint:
    """The footprint of a part x >= 0 from the forces (c,) on the nodes of its ``boundary``."""
    nodes = mesh.nodes("boundary")
    unit = traction_force(mesh, section, "boundary", (0.0, 1.0))[nodes, 1]
    order = np.argsort(mesh.points[nodes, 0])
    return Footprint(place=mesh.points[nodes, 0][order], force=force[order], area=unit[order])


def loaded(load: float, mesh: GradedDisc) -> Footprint:
    """A quarter of a cylinder under a uniform traction on the diameter, which makes the load ``load`` of the half.

    Nothing but the contact holds it.
    """
    traction = sw.Traction(on="body.diameter", value=(0.0, -0.5 * load))
    return _resting(mesh, sw.PlaneStrain(), (sw.Fixed(on="axis", components="x"),), -1.0, (traction,))


def approached(approach: float, mesh: GradedDisc, section: Section) -> Footprint:
    """A quarter (of a cylinder, or the section of a hemisphere) whose diameter comes nearer by ``approach``.

    The diameter stays and the plane stands so much higher, at the start inside the body, which is pressed out.
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
    """Static equilibrium on a plane; a slab is marched from it, in which nothing may move."""
    mesh = recipe.build()
    body = sw.Solid(mesh=mesh, material=ELASTIC, density=1.0, section=section, supports=supports)
    plane = sw.Tool(shape=sw.HalfSpace(point=(0.0, height), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("body.boundary", "plane"), name="plane", start="fit")
    bodies: dict[str, sw.Solid | sw.Tool] = {"body": body, "plane": plane}
    scene = sw.Scene(bodies=bodies, contacts=(contact,), loads=loads, start=sw.StaticStart())
    step = next(iter(sw.march(scene, until=1e-3, step=1e-3)))
    assert np.abs(step.after.velocity["body"]).max() < 1e-10
    return footprint(mesh, section, step.before.pressure["plane"])
