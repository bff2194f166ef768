"""Dead loads: gravity, and tractions on tagged parts of the boundary."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Axisymmetric, Section
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.initial_fields import components
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.meshes.element import element, exact_degree
from softway.meshes.mesh import Mesh
from softway.units import MetrePerSecondSquared, Pascal


@dataclass(frozen=True, slots=True, kw_only=True)
class Gravity:
    """Uniform acceleration of all bodies.

    Parameters
    ----------
    acceleration
        Vector; a number in one dimension [m/s^2].
    ramp
        Factor over time; constant by default.

    Examples
    --------
    >>> Gravity(acceleration=(0.0, 0.0, -9.81)).vector(3).round(12).tolist()
    [0.0, 0.0, -9.81]
    """

    acceleration: tuple[MetrePerSecondSquared, ...] | MetrePerSecondSquared
    ramp: Ramp = Ramp()

    def vector(self, dim: int) -> Array:
        """Acceleration (d,) [m/s^2]."""
        return components("acceleration", self.acceleration, dim)


@dataclass(frozen=True, slots=True, kw_only=True)
class Traction:
    """Dead load per reference area on the boundary facets of a tag, facets with all their nodes in the tag.

    Parameters
    ----------
    on
        ``body.tag``.
    value
        Force per area, of constant direction; a number in one dimension [Pa].
    ramp
        Factor over time; constant by default.

    Examples
    --------
    >>> load = Traction(on="bar.right", value=1e6)
    >>> load.body, load.tag
    ('bar', 'right')
    """

    on: str
    value: tuple[Pascal, ...] | Pascal
    ramp: Ramp = Ramp()

    @property
    def body(self) -> str:
        """Name of the loaded body."""
        return self.on.partition(".")[0]

    @property
    def tag(self) -> str:
        """Tag of the loaded nodes; the whole surface by default."""
        return self.on.partition(".")[2] or "surface"


Load = Gravity | Traction


def traction_force(mesh: Mesh, section: Section, tag: str, value: Sequence[float] | float) -> Array:
    """Consistent nodal forces (n, d) [N] of a traction on the boundary facets of a tag.

    The force of node a is the integral of N_a t over the facets; at the end nodes of bars it is the area times t.

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((2.0, 1.0), (2, 1))
    >>> force = traction_force(mesh, PlaneStrain(thickness=0.5), "top", (0.0, -1.0))
    >>> (force[mesh.nodes("top")].round(12) + 0.0).tolist()
    [[0.0, -0.25], [0.0, -0.5], [0.0, -0.25]]
    """
    if not mesh.facets_on(tag):
        raise InputError("on", f"tag {tag!r} contains no whole facet of the boundary", "a tag of a side")
    return traction_measure(mesh, section, tag)[:, None] * components("value", value, mesh.dim)


def traction_measure(mesh: Mesh, section: Section, tag: str) -> Array:
    """Area around each node: integrals (n,) of the shape functions over the facets of a tag [m^2]."""
    return facets_measure(mesh.points, section, mesh.facets_on(tag))


def facets_measure(points: Array, section: Section, facets: Mapping[str, IntArray]) -> Array:
    """Integrals (n,) [m^2] as :func:`traction_measure`, over ``facets`` (f, b) of nodes at ``points`` (n, d)."""
    measure = np.zeros(len(points))
    for name, nodes in facets.items():
        np.add.at(measure, nodes, facet_measures(points[nodes], section, name))
    return measure


def facet_measures(x: Array, section: Section, name: str) -> Array:
    """Integrals (f, b) of the shape functions over facets at x (f, b, d), times thickness, circumference or area."""
    if name == "point1":
        return np.asarray(section.measure(x))
    degree = exact_degree(name, curved=True) + (CELLS[name].order if isinstance(section, Axisymmetric) else 0)
    table = element(name, degree)
    jacobian = np.einsum("fbi,qbr->fqir", x, table.dN)
    gram = np.swapaxes(jacobian, -1, -2) @ jacobian
    weight = table.weights * np.sqrt(np.linalg.det(gram)) * section.measure(np.einsum("qb,fbi->fqi", table.N, x))
    return np.asarray(weight @ table.N)
