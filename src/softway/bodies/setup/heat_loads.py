"""Boundary conditions and sources of heat: temperature, flux, convection, radiation, power per volume."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Section
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.loads import facet_measures
from softway.errors import InputError, positive
from softway.meshes.cells import CELLS
from softway.meshes.element import element, exact_degree
from softway.meshes.mesh import Mesh
from softway.units import Kelvin, Pure, WattPerCubicMetre, WattPerSquareMetre, WattPerSquareMetreKelvin


@dataclass(frozen=True, slots=True, kw_only=True)
class Temperature:
    """Prescribed temperature of the nodes of a tag.

    Of two surfaces that meet, the temperature that is declared last holds at their common nodes.

    Parameters
    ----------
    on
        ``body.tag``; the whole surface without a tag.
    value
        Temperature [K], positive.
    ramp
        Factor of the temperature over time; constant by default.

    Examples
    --------
    A wall that is heated from 300 K to 400 K within a second:

    >>> wall = Temperature(on="bar.left", value=1.0, ramp=Ramp(times=(0.0, 1.0), factors=(300.0, 400.0)))
    >>> wall.at(0.5)
    350.0
    """

    on: str
    value: Kelvin
    ramp: Ramp = Ramp()

    def __post_init__(self) -> None:
        _require_kelvin("value", self.value, self.ramp)

    def at(self, time: float) -> float:
        """Temperature [K] at a time [s]."""
        return self.value * self.ramp.at(time)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatFlux:
    """Heat that flows into a body per time and area of the boundary facets of a tag.

    Parameters
    ----------
    on
        ``body.tag``; the whole surface without a tag.
    value
        Heat flux [W/m^2]; negative for heat that leaves.
    ramp
        Factor over time; constant by default.

    Examples
    --------
    >>> HeatFlux(on="block.top", value=1e6).value
    1000000.0
    """

    on: str
    value: WattPerSquareMetre
    ramp: Ramp = Ramp()

    def __post_init__(self) -> None:
        _require_finite("value", self.value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Convection:
    """Heat exchange with a fluid: the heat flux into the body is ``coefficient (ambient - temperature)``.

    Parameters
    ----------
    on
        ``body.tag``; the whole surface without a tag.
    coefficient
        Coefficient of heat transfer [W/(m^2 K)], positive.
    ambient
        Temperature of the fluid [K], positive.
    ramp
        Factor of the temperature of the fluid over time; constant by default.

    Examples
    --------
    >>> air = Convection(on="bar", coefficient=10.0, ambient=293.15)
    >>> air.ambient
    293.15
    """

    on: str
    coefficient: WattPerSquareMetreKelvin
    ambient: Kelvin
    ramp: Ramp = Ramp()

    def __post_init__(self) -> None:
        positive(coefficient=self.coefficient)
        _require_kelvin("ambient", self.ambient, self.ramp)


@dataclass(frozen=True, slots=True, kw_only=True)
class Radiation:
    """Radiation of a grey surface to surroundings: the heat flux into the body is
    ``emissivity sigma (ambient^4 - temperature^4)`` with the constant sigma of Stefan and Boltzmann.

    Parameters
    ----------
    on
        ``body.tag``; the whole surface without a tag.
    emissivity
        Emissivity, above zero and up to one.
    ambient
        Temperature of the surroundings [K], positive.
    ramp
        Factor of the temperature of the surroundings over time; constant by default.

    Examples
    --------
    >>> Radiation(on="ball", emissivity=0.8, ambient=300.0).emissivity
    0.8
    """

    on: str
    emissivity: Pure
    ambient: Kelvin
    ramp: Ramp = Ramp()

    def __post_init__(self) -> None:
        if not 0.0 < self.emissivity <= 1.0:
            raise InputError("emissivity", f"{self.emissivity:g}", "above zero, up to 1 for a black surface")
        _require_kelvin("ambient", self.ambient, self.ramp)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatSource:
    """Power per volume in a body or in one of its regions.

    Parameters
    ----------
    of
        ``body``, or ``body.region``.
    value
        Power per volume [W/m^3]; negative for a sink.
    ramp
        Factor over time; constant by default.

    Examples
    --------
    >>> HeatSource(of="fuel", value=1e8).value
    100000000.0
    """

    of: str
    value: WattPerCubicMetre
    ramp: Ramp = Ramp()

    def __post_init__(self) -> None:
        _require_finite("value", self.value)

    @property
    def on(self) -> str:
        """Place of the source, as for loads on surfaces."""
        return self.of


SurfaceHeat = HeatFlux | Convection | Radiation
HeatLoad = Temperature | HeatFlux | Convection | Radiation | HeatSource


def place_of(load: HeatLoad) -> tuple[str, str]:
    """Body of a load, and its tag or region: the whole surface, or the whole body, by default.

    Examples
    --------
    >>> place_of(HeatFlux(on="bar", value=1.0)), place_of(HeatSource(of="bar", value=1.0))
    (('bar', 'surface'), ('bar', 'all'))
    """
    body, _, tag = load.on.partition(".")
    return body, tag or ("all" if isinstance(load, HeatSource) else "surface")


def surface_points(mesh: Mesh, section: Section, tag: str) -> tuple[sparse.csr_array, Array]:
    """Interpolation (p, n) from the nodes to points of the boundary facets of a tag, and the areas (p,) of the points.

    The points of linear facets are their nodes, so that heat exchange does not couple nodes; those of quadratic facets
    are the points of a quadrature.

    Raises
    ------
    InputError
        If the tag matches nothing, or contains no whole facet.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> from softway.meshes.generators.shapes import interval
    >>> points, areas = surface_points(interval(1.0, cells=2), Bar(area=3.0), "right")
    >>> points.toarray().tolist(), areas.tolist()
    ([[0.0, 0.0, 1.0]], [3.0])
    """
    facets = mesh.facets_on(tag)
    if not facets:
        raise InputError("", f"tag {tag!r} contains no whole facet of the boundary", "a tag of a side")
    tables, areas = zip(*(_points(mesh, section, name, nodes) for name, nodes in facets.items()), strict=True)
    return sparse.csr_array(sparse.vstack(tables, format="csr")), np.concatenate(areas)


def _points(mesh: Mesh, section: Section, name: str, facets: IntArray) -> tuple[sparse.csr_array, Array]:
    """Interpolation and areas of the points of facets (f, b) of one type."""
    x = mesh.points[facets]
    if CELLS[name].order == 1:
        N, areas = np.eye(facets.shape[1]), facet_measures(x, section, name)
    else:
        table = element(name, exact_degree(name, curved=True))
        N, jacobian = table.N, np.einsum("fbi,qbr->fqir", x, table.dN)
        stretch = np.sqrt(np.linalg.det(np.swapaxes(jacobian, -1, -2) @ jacobian))
        areas = table.weights * stretch * section.measure(np.einsum("qb,fbi->fqi", N, x))
    f, (q, b) = len(facets), N.shape
    columns = np.broadcast_to(facets[:, None, :], (f, q, b)).ravel()
    rows = np.repeat(np.arange(f * q), b)
    values = np.broadcast_to(N, (f, q, b)).ravel()
    found = sparse.csr_array((values, (rows, columns)), shape=(f * q, mesh.n_nodes))
    found.eliminate_zeros()
    return found, areas.ravel()


def _require_kelvin(where: str, value: float, ramp: Ramp) -> None:
    """Refuse temperatures that are not positive at some time."""
    least = min(value * factor for factor in ramp.factors)
    if not 0.0 < least < np.inf:
        problem = f"{least:g} K is not positive"
        raise InputError(where, problem, "a positive temperature in kelvin, 273.15 K above that in Celsius")


def _require_finite(where: str, value: float) -> None:
    """Refuse a value that is no finite number."""
    if not np.isfinite(value):
        raise InputError(where, f"{value}", "a finite number")
