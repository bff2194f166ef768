"""Description of heat: of a body that conducts it and does not move, of a solid that does move, and of a rigid body."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.section import Section
from softway.bodies.setup.initial_fields import Profile
from softway.errors import InputError, positive, real
from softway.laws.heat.conduction import Conduction
from softway.laws.heat.stiffness_table import StiffnessTable
from softway.meshes.generators.recipes import MeshSource
from softway.meshes.mesh import Mesh
from softway.units import (
    JoulePerKelvin,
    JoulePerKilogramKelvin,
    Kelvin,
    KilogramPerCubicMetre,
    PerKelvin,
    Pure,
    SquareMetre,
    WattPerMetreKelvin,
)

TemperatureField = Kelvin | Profile | Array | Callable[[Array], Array]
"""Uniform temperature, profile of numbers along an axis, nodal values (n,), or a function of the points (n, d)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Conductor:
    """Body with a temperature and no motion.

    Parameters
    ----------
    mesh
        Mesh, or recipe of a mesh.
    law
        Law of conduction; or laws by regions of the mesh.
    density
        Mass per volume [kg/m^3], positive; or one for each of some regions that contain all cells.
    section
        Section of the elements; by default bar of unit area, a slice of unit thickness, or volume.
    temperature
        Initial temperature [K]: a number, a profile of numbers, nodal values (n,), or a function of the points (n, d).
    latent
        Place of the latent heat: ``cell``, the liquid part of the cells that the temperature of melting cuts,
        ``node``, the nodes, or ``front``, in bars, a front between two nodes.  That of a mushy range is always at the
        nodes.

    Raises
    ------
    InputError
        If a density is not positive, there is no law, or no such place of latent heat.

    Examples
    --------
    >>> import softway as sw
    >>> steel = Conduction(conductivity=50.0, capacity=500.0)
    >>> bar = sw.meshes.Interval(length=0.1, cells=10)
    >>> Conductor(mesh=bar, law=steel, density=7800.0, temperature=293.15).latent
    'cell'
    """

    mesh: MeshSource | Mesh
    law: Conduction | Mapping[str, Conduction]
    density: KilogramPerCubicMetre | Mapping[str, KilogramPerCubicMetre]
    section: Section | None = None
    temperature: Annotated[TemperatureField, "K"]
    latent: Literal["cell", "node", "front"] = "cell"

    def __post_init__(self) -> None:
        _require_law(self.law)
        densities = self.density if isinstance(self.density, Mapping) else {"": self.density}
        for region, density in densities.items():
            positive(**{f"density.{region}" if region else "density": density})
        if self.latent not in ("cell", "node", "front"):
            raise InputError("latent", f"{self.latent!r}", "'cell', 'node' or, in bars, 'front'")


@dataclass(frozen=True, slots=True, kw_only=True)
class Thermal:
    """Heat of a solid, whose temperature and motion are solved together.

    Parameters
    ----------
    law
        Law of conduction, or laws by regions of the mesh, which need not be those of the material.  The capacity is
        that at constant strain.  Latent heat is in the cells that the temperature of melting cuts, or at the nodes over
        a mushy range.
    temperature
        Initial temperature [K]: a number, a profile of numbers, nodal values (n,), or a function of the points (n, d).
    expansion
        Coefficient of linear thermal expansion [1/K].
    melting_strain
        Strain along each axis of the liquid at melting relative to the solid: a third of the relative change of volume,
        negative for water.
    reference
        Temperature without thermal stress [K]; the initial temperature by default.
    stiffness
        Factor of the elastic moduli by the temperature, with their thermal stress: of laws with a stored energy, and of
        ``J2``, ``Maxwell``, ``Kelvin`` and ``Hypoelastic``.
    heating
        Share of the dissipation of the material that heats, from zero to one; by default .9 of the plastic work of
        ``J2``, and all of viscous laws.

    Raises
    ------
    InputError
        If the reference is not positive, the share is not between zero and one, or nothing melts that expands on
        melting.

    Examples
    --------
    >>> steel = Conduction(conductivity=50.0, capacity=500.0)
    >>> Thermal(law=steel, temperature=293.15, expansion=12e-6).reference is None
    True
    """

    law: Conduction | Mapping[str, Conduction]
    temperature: Annotated[TemperatureField, "K"]
    expansion: PerKelvin = 0.0
    melting_strain: Pure = 0.0
    reference: Kelvin | None = None
    stiffness: StiffnessTable | None = None
    heating: Pure | None = None

    def __post_init__(self) -> None:
        real(self.expansion, "expansion")
        real(self.melting_strain, "melting_strain")
        _require_law(self.law)
        melts = any(law.latent is not None for law in conduction_laws(self.law).values())
        if self.melting_strain and not melts:
            raise InputError("melting_strain", "of matter that does not melt", "law.latent, or no melting_strain")
        if self.reference is not None:
            positive(reference=self.reference)
        if self.heating is not None and not 0.0 <= self.heating <= 1.0:
            raise InputError("heating", f"{self.heating:g}", "a share from 0 to 1")


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidThermal:
    """Heat of a rigid body beside solids with heat: it has one temperature, and exchanges heat through its contacts.

    Parameters
    ----------
    temperature
        Initial temperature [K].
    specific_heat
        Heat capacity per mass [J/(kg K)]; that of the body is its mass times this.
    capacity
        Heat capacity of the whole body [J/K], in place of ``specific_heat``.
    conductivity
        Conductivity [W/(m K)], for the effusivity, by which the heat of friction is shared; the body needs a density
        then.  By default contacts with friction name their ``heat.share``.
    area
        Area of the surface on which loads of heat act [m^2]; none by default.

    Raises
    ------
    InputError
        If a number is not positive, or there is not one of the two capacities.

    Examples
    --------
    >>> RigidThermal(temperature=293.15, specific_heat=500.0).capacity_of(2.0)
    1000.0
    """

    temperature: Kelvin
    specific_heat: JoulePerKilogramKelvin | None = None
    capacity: JoulePerKelvin | None = None
    conductivity: WattPerMetreKelvin | None = None
    area: SquareMetre | None = None

    def __post_init__(self) -> None:
        if (self.specific_heat is None) == (self.capacity is None):
            given = "no heat capacity" if self.capacity is None else "two heat capacities"
            raise InputError("specific_heat", given, "either specific_heat, per mass, or capacity, of the body")
        positive(temperature=self.temperature)
        for name in ("specific_heat", "capacity", "conductivity", "area"):
            if getattr(self, name) is not None:
                positive(**{name: getattr(self, name)})

    def capacity_of(self, mass: float) -> float:
        """Heat capacity [J/K] of a body of this ``mass`` [kg]."""
        if self.capacity is not None:
            return self.capacity
        assert self.specific_heat is not None
        return mass * self.specific_heat

    def effusivity(self, mass: float, density: float | None) -> float | None:
        """Root of conductivity, density and capacity [W s^(1/2)/(m^2 K)]; None without conductivity or density."""
        if self.conductivity is None or density is None:
            return None
        return float(np.sqrt(self.conductivity * density * self.capacity_of(mass) / mass))


def conduction_laws(law: Conduction | Mapping[str, Conduction]) -> Mapping[str, Conduction]:
    """Laws by regions; one law has an empty name.

    Examples
    --------
    >>> list(conduction_laws(Conduction(conductivity=1.0, capacity=1.0)))
    ['']
    """
    return law if isinstance(law, Mapping) else {"": law}


def _require_law(law: Conduction | Mapping[str, Conduction]) -> None:
    """Refuse a table of no law."""
    if not conduction_laws(law):
        raise InputError("law", "no law", "one law, or a law for each region of the mesh")


def sample_temperature(field: TemperatureField, mesh: Mesh) -> Array:
    """Nodal temperatures (n,) [K] of a field.

    Raises
    ------
    InputError
        If the temperatures are not positive and finite, or their number is not that of the nodes.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> sample_temperature(Profile(at=(0.0, 1.0), values=(300.0, 400.0)), interval(1.0, cells=2)).tolist()
    [300.0, 350.0, 400.0]
    """
    if isinstance(field, Profile):
        found = _profile(field, mesh)
    elif callable(field):
        found = np.array(field(mesh.points), dtype=float)
    else:
        found = np.array(field, dtype=float)
        found = np.full(mesh.n_nodes, float(found)) if found.ndim == 0 else found
    if found.shape != (mesh.n_nodes,):
        raise InputError(
            "", f"temperatures of shape {found.shape}", f"one number, or numbers of shape ({mesh.n_nodes},)"
        )
    if not ((found > 0.0) & (found < np.inf)).all():
        raise InputError("", f"{found.min():g} K", "positive temperatures in kelvin, 273.15 K above those in Celsius")
    return found


def _profile(field: Profile, mesh: Mesh) -> Array:
    """Nodal values (n,) of a profile of numbers."""
    at, values = np.asarray(field.at, float), np.asarray(field.values, float)
    axis = "xyz".find(field.axis)
    fits = len(field.axis) == 1 and 0 <= axis < mesh.dim
    if not fits or values.ndim != 1 or at.shape != values.shape or not (np.diff(at) > 0.0).all() or not at.size:
        problem = f"a profile along {field.axis!r} of {len(field.values)} values at {len(field.at)} coordinates"
        raise InputError("", problem, "an axis of the mesh, increasing coordinates, and a number for each")
    return np.asarray(np.interp(mesh.points[:, axis], at, values))
