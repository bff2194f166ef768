"""Dead loads: gravity, and tractions on tagged parts of the boundary."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.bodies.amplitude import Ramp
from softway.bodies.fields import components
from softway.bodies.section import Axisymmetric, Section
from softway.errors import InputError
from softway.space.cells import CELLS
from softway.space.element import element, exact_degree
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray
from softway.units import MetrePerSecondSquared, Pascal


@dataclass(frozen=True, slots=True, kw_only=True)
class Gravity:
    """The same acceleration of every body.

    Parameters
    ----------
    acceleration
        A vector; a number in one dimension [m/s^2].
    ramp
        How it changes with time; constant by default.

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
    """Dead force per reference area on the boundary facets all of whose nodes are in a tag.

    Parameters
    ----------
    on
        ``body.tag``.
    value
        Force per area, its direction fixed; a number in one dimension [Pa].
    ramp
        How it changes with time; constant by default.

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
        """Tag of the loaded nodes; the whole surface when none is given."""
        return self.on.partition(".")[2] or "surface"


Load = Gravity | Traction


def traction_force(mesh: Mesh, section: Section, tag: str, value: Sequence[float] | float) -> Array:
    """Consistent nodal forces (n, d) [N] of a traction on the boundary facets of a tag.

    Force of node a: integral of N_a t over the facets; on bars the area times t at end nodes.

    Examples
    --------
    >>> from softway.bodies.section import PlaneStrain
    >>> from softway.space.shapes import rectangle
    >>> mesh = rectangle((2.0, 1.0), (2, 1))
    >>> force = traction_force(mesh, PlaneStrain(thickness=0.5), "top", (0.0, -1.0))
    >>> (force[mesh.nodes("top")].round(12) + 0.0).tolist()
    [[0.0, -0.25], [0.0, -0.5], [0.0, -0.25]]
    """
    if not mesh.facets_on(tag):
        raise InputError("on", f"tag {tag!r} holds no whole facet of the boundary", "a tag of a side")
    return traction_measure(mesh, section, tag)[:, None] * components("value", value, mesh.dim)


def traction_measure(mesh: Mesh, section: Section, tag: str) -> Array:
    """Integrals (n,) of the shape functions over the facets of a tag [m^2]: the area around each node."""
    return facets_measure(mesh.points, section, mesh.facets_on(tag))


def facets_measure(points: Array, section: Section, facets: Mapping[str, IntArray]) -> Array:
    """Integrals (n,) [m^2] as :func:`traction_measure`, over ``facets`` (f, b) of nodes at ``points`` (n, d)."""
    measure = np.zeros(len(points))
    for name, nodes in facets.items():
        np.add.at(measure, nodes, _facet_measure(points[nodes], section, name))
    return measure


def _facet_measure(x: Array, section: Section, name: str) -> Array:
    """Integrals (f, b) of the shape functions over facets at x (f, b, d), times thickness, circumference or area."""
    if name == "point1":
        return np.asarray(section.measure(x))
    degree = exact_degree(name, curved=True) + (CELLS[name].order if isinstance(section, Axisymmetric) else 0)
    table = element(name, degree)
    jacobian = np.einsum("fbi,qbr->fqir", x, table.dN)
    gram = np.swapaxes(jacobian, -1, -2) @ jacobian
    weight = table.weights * np.sqrt(np.linalg.det(gram)) * section.measure(np.einsum("qb,fbi->fqi", table.N, x))
    return np.asarray(weight @ table.N)
