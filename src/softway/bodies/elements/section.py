"""Sections of elements: bar, plane strain, plane stress, axisymmetric, volume.

A section defines three properties of an element: the factor from its measure to its volume, the free lateral faces, and
the map from the sampled rows ``A = sum_a row_a u_a`` (k, d) of the nodal displacements to the displacement derivatives
H (m, D) along the reference directions.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive
from softway.laws.elasticity.elastic_constants import wave_modulus
from softway.laws.elasticity.free_faces import condensed
from softway.laws.law import Material, initial_moduli
from softway.meshes.mesh import Mesh
from softway.units import Metre, SquareMetre


@dataclass(frozen=True, slots=True, kw_only=True)
class Bar:
    """Bar under axial stress in 1D, 2D or 3D space; the lateral faces are free.

    Parameters
    ----------
    area
        Reference cross-section [m^2].

    Examples
    --------
    >>> Bar(area=2.0).measure(np.zeros((1, 1)))
    array([2.])
    """

    area: SquareMetre = 1.0

    def __post_init__(self) -> None:
        positive(area=self.area)

    def measure(self, points: Array) -> Array:
        """Cross-section [m^2] at reference points (..., d), (...,)."""
        return _uniform(self.area, points)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneStrain:
    """Slice of a body in plane strain: no displacement along z.

    Parameters
    ----------
    thickness
        Thickness of the slice [m].

    Examples
    --------
    >>> PlaneStrain(thickness=0.5).measure(np.zeros((1, 2)))
    array([0.5])
    """

    thickness: Metre = 1.0

    def __post_init__(self) -> None:
        positive(thickness=self.thickness)

    def measure(self, points: Array) -> Array:
        """Thickness [m] at reference points (..., 2), (...,)."""
        return _uniform(self.thickness, points)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneStress:
    """Thin plate in plane stress: the faces normal to z are free.

    Parameters
    ----------
    thickness
        Thickness of the undeformed plate [m].

    Examples
    --------
    >>> PlaneStress(thickness=0.5).measure(np.zeros((1, 2)))
    array([0.5])
    """

    thickness: Metre = 1.0

    def __post_init__(self) -> None:
        positive(thickness=self.thickness)

    def measure(self, points: Array) -> Array:
        """Thickness [m] at reference points (..., 2), (...,)."""
        return _uniform(self.thickness, points)


@dataclass(frozen=True, slots=True, kw_only=True)
class Axisymmetric:
    """Body of revolution about the y axis: x is the radius, y the axial coordinate; volumes are those of a full turn.

    Nodes on the axis must be fixed in x: ``Fixed(on="left", components="x")``.

    Examples
    --------
    >>> Axisymmetric().measure(np.array([[0.5, 0.0]])).round(6)
    array([3.141593])
    """

    def measure(self, points: Array) -> Array:
        """Circumference ``2 pi r`` [m] at reference points (..., 2), (...,)."""
        return 2.0 * pi * points[..., 0]


@dataclass(frozen=True, slots=True, kw_only=True)
class Volume:
    """Body with three-dimensional elements.

    Examples
    --------
    >>> Volume().measure(np.zeros((1, 3)))
    array([1.])
    """

    def measure(self, points: Array) -> Array:
        """Ones (...,) at reference points (..., 3)."""
        return _uniform(1.0, points)


Section = Bar | PlaneStrain | PlaneStress | Axisymmetric | Volume


def default_section(mesh: Mesh) -> Section:
    """Bar of unit area, plane strain of unit thickness, or volume, by the dimension of the elements.

    Examples
    --------
    >>> default_section(Mesh(points=np.array([[0.0], [1.0]]), blocks={"bar2": np.array([[0, 1]])}))
    Bar(area=1.0)
    """
    choice: dict[int, Section] = {1: Bar(), 2: PlaneStrain(), 3: Volume()}
    return choice[mesh.cell_dim]


def check_section(mesh: Mesh, section: Section) -> None:
    """Raise :class:`~softway.errors.InputError` if the section does not fit the mesh."""
    cell_dim = {Bar: 1, Volume: 3}.get(type(section), 2)
    name = type(section).__name__
    if mesh.cell_dim != cell_dim:
        problem = f"{name} needs elements of dimension {cell_dim}, the mesh has elements of dimension {mesh.cell_dim}"
        raise InputError("section", problem, type(default_section(mesh)).__name__)
    if isinstance(section, Axisymmetric) and mesh.points[:, 0].min() < -1e-12 * np.abs(mesh.points).max():
        raise InputError("section", f"radius x = {mesh.points[:, 0].min():g} m is negative", "a mesh with x >= 0")


def free_axes(section: Section) -> tuple[int, ...]:
    """Axes outside the element whose normal stress is zero; along its other outer axes the strain is zero."""
    match section:
        case Bar():
            return (1, 2)
        case PlaneStress():
            return (2,)
        case _:
            return ()


def sampled_rows(section: Section, gradients: Array, N: Array, points: Array) -> Array:
    """Rows (e, q, a, k) of the strain operator: gradients (e, q, a, r), and ``N/r`` for the hoop strain.

    ``N`` (q, a) are shape functions, ``points`` (e, q, d) the coordinates of the quadrature points [m].
    """
    match section:
        case Axisymmetric():
            hoop = N[None] / points[..., None, 0]
            return np.concatenate([gradients, hoop[..., None]], axis=-1)
        case _:
            return gradients


def derivatives(section: Section, A: Array) -> Array:
    """Displacement derivatives H (..., m, D) from the sampled rows A (..., k, d)."""
    match section:
        case Axisymmetric():
            H = np.zeros((*A.shape[:-2], 3, 3))
            H[..., :2, :2] = A[..., :2, :]
            H[..., 2, 2] = A[..., 2, 0]
            return H
        case _:
            return A


def row_flux(section: Section, Q: Array) -> Array:
    """Transpose of :func:`derivatives`: flux (..., k, d) of the sampled rows from the flux Q (..., m, D)."""
    match section:
        case Axisymmetric():
            q = np.zeros((*Q.shape[:-2], 3, 2))
            q[..., :2, :] = Q[..., :2, :2]
            q[..., 2, 0] = Q[..., 2, 2]
            return q
        case _:
            return Q


def row_moduli(section: Section, D: Array) -> Array:
    """Moduli (..., k, d, k, d) of the sampled rows from the moduli D (..., m, D, m, D)."""
    match section:
        case Axisymmetric():
            half = np.moveaxis(row_flux(section, D), (-2, -1), (-4, -3))
            return np.moveaxis(row_flux(section, half), (-2, -1), (-4, -3))
        case _:
            return D


def wave_speed(material: Material, density: float, section: Section) -> float:
    """Speed of the fastest small wave along the element [m/s].

    ``sqrt(E/rho)`` in a bar, ``sqrt(E/((1 - nu^2) rho))`` in a plate, ``sqrt((lambda + 2 mu)/rho)`` otherwise.

    Raises
    ------
    InputError
        If the moduli are so small that the speed is zero.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> steel = LinearElastic(E=4.0, nu=0.5 - 1e-9)
    >>> round(wave_speed(steel, 1.0, Bar()), 6), round(wave_speed(steel, 1.0, PlaneStress()), 6)
    (2.0, 2.309401)
    """
    free = free_axes(section)
    moduli = condensed(initial_moduli(material), 3 - len(free), free)
    speed = sqrt(max(0.0, wave_modulus(moduli)) / density)
    if not speed > 0.0:
        raise InputError("material", f"waves of the speed {speed:g} m/s: it has no stiffness", "larger moduli")
    return speed


def _uniform(value: float, points: Array) -> Array:
    """The same value at all points (..., d), (...,)."""
    return np.full(points.shape[:-1], value)
