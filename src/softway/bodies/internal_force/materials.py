"""Materials of a body: one law with its density, or several by regions of the mesh."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Section, wave_speed
from softway.errors import InputError, within
from softway.laws.law import Material
from softway.meshes.mesh import Mesh
from softway.meshes.topology import described

Laws = Material | Mapping[str, Material]
"""One law, or laws by regions of the mesh."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Materials:
    """Laws and densities of a body with e elements.

    Parameters
    ----------
    regions
        (k,) names of the regions; one empty name for a body of one material.
    laws
        (k,) material laws.
    densities
        (k,) masses per reference volume [kg/m^3].
    owner
        (e,) number of the material of each element; None for a body of one material.
    """

    regions: tuple[str, ...]
    laws: tuple[Material, ...]
    densities: tuple[float, ...]
    owner: IntArray | None = None

    @property
    def density(self) -> float | Array:
        """Mass per reference volume, one number or one for each element (e,) [kg/m^3]."""
        return self.densities[0] if self.owner is None else np.array(self.densities)[self.owner]

    def speeds(self, section: Section, factor: float = 1.0) -> tuple[float, ...]:
        """Speeds (k,) of the fastest waves in the materials with their masses times a ``factor`` [m/s].

        Raises
        ------
        InputError
            If a material has no stiffness.
        """
        if self.owner is None:
            return (wave_speed(self.laws[0], self.densities[0] * factor, section),)
        found = []
        for name, law, density in zip(self.regions, self.laws, self.densities, strict=True):
            try:
                found.append(wave_speed(law, density * factor, section))
            except InputError as error:
                raise InputError(f"material.{name}", error.problem, error.remedy) from None
        return tuple(found)

    def stiffest(self, section: Section) -> tuple[float, float]:
        """Density [kg/m^3] and wave speed [m/s] of the material with the greatest modulus of plane waves."""
        pairs = zip(self.densities, self.speeds(section), strict=True)
        return max(pairs, key=lambda pair: pair[0] * pair[1] ** 2)

    def impedance(self, section: Section) -> float:
        """Least impedance ``rho c`` of the materials [kg/m^2/s]."""
        return min(density * c for density, c in zip(self.densities, self.speeds(section), strict=True))

    def part(self, cells: IntArray) -> "Materials":
        """Materials of some elements (k,)."""
        return self if self.owner is None else replace(self, owner=self.owner[cells])


def laws_of(material: Laws) -> tuple[Material, ...]:
    """Laws of a material given as one law or by regions.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> len(laws_of({"core": LinearElastic(E=1.0), "skin": LinearElastic(E=2.0)}))
    2
    """
    return tuple(material.values()) if isinstance(material, Mapping) else (material,)


def materials_of(mesh: Mesh, material: Laws, density: float | Mapping[str, float]) -> Materials:
    """Materials of a body with the elements of a mesh.

    Raises
    ------
    InputError
        With the region: if it does not exist, shares elements with another one, or elements have no law.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> from softway.meshes.generators.shapes import interval
    >>> bar = interval(1.0, cells=2).with_region("end", lambda x: x[:, 0] > 0.5)
    >>> laws = {"end": LinearElastic(E=1.0), "start": LinearElastic(E=2.0)}
    >>> materials_of(bar.with_region("start", lambda x: x[:, 0] < 0.5), laws, 3.0).owner
    array([1, 0])
    """
    if not isinstance(material, Mapping):
        if isinstance(density, Mapping):
            raise TypeError("densities by regions for one law, which Solid refuses")
        return Materials(regions=("",), laws=(material,), densities=(density,))
    names = tuple(material)
    return Materials(
        regions=names,
        laws=tuple(material.values()),
        densities=tuple(density[n] for n in names) if isinstance(density, Mapping) else (density,) * len(names),
        owner=owners(mesh, names),
    )


def owners(mesh: Mesh, names: tuple[str, ...], place: str = "material", what: str = "law") -> IntArray:
    """Number (e,) of the region of each element among the ``names``, which have a ``what`` at a ``place`` of the body.

    Raises
    ------
    InputError
        With the region: if it does not exist, shares elements with another one, or elements are in none.
    """
    owner = np.full(mesh.n_cells, -1)
    for k, name in enumerate(names):
        with within(f"{place}.{name}"):
            cells = mesh.cells(name)
        taken = cells[owner[cells] >= 0]
        if len(taken):
            other, where = names[int(owner[taken[0]])], described(mesh.centres()[taken[0]])
            problem = f"{len(taken)} cells have the {what} of {other!r} too, the first at {where}"
            raise InputError(f"{place}.{name}", problem, f"regions without common cells, or no {what} for {other!r}")
        owner[cells] = k
    left = np.flatnonzero(owner < 0)
    if len(left):
        of = [name for name, cells in mesh.regions.items() if np.isin(left, cells).all()]
        inside = [name for name, cells in mesh.regions.items() if np.isin(left, cells).any()]
        where = described(mesh.centres()[left[0]])
        problem = f"{len(left)} of {mesh.n_cells} cells have no {what}, the first at {where}"
        told = f"; they lie in {', '.join(inside[:6])}" if inside else ", in no region"
        remedy = "a region for these cells: a mesh of kind Divided with rest, or Mesh.with_region"
        raise InputError(place, problem + told, f"a {what} for {of[0]}" if of else remedy)
    return owner
