"""Laws and densities of a conductor by regions of its mesh."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.conductor import Conductor, conduction_laws
from softway.bodies.elements.section import Section
from softway.bodies.inertia.nodal_heat import heat_masses
from softway.bodies.internal_force.materials import owners
from softway.errors import InputError
from softway.laws.heat.conduction import Conduction
from softway.laws.heat.heat_content import ContentCurve, content_curve
from softway.laws.heat.mixed_content import MixedContent
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RegionalLaws:
    """Laws (k,) of a conductor of e cells.

    Parameters
    ----------
    laws
        Laws by regions; one law has an empty name.
    owner
        (e,) number of the law of each cell; None for one law.
    density
        Mass per volume [kg/m^3], one number or one for each cell (e,).
    """

    laws: Mapping[str, Conduction]
    owner: IntArray | None
    density: float | Array

    @property
    def first(self) -> Conduction:
        """The law, of several the first one that melts if any does."""
        laws = tuple(self.laws.values())
        return next((law for law in laws if law.latent is not None), laws[0])

    def cells(self, first: int, count: int) -> list[tuple[Conduction, IntArray | slice]]:
        """Laws of ``count`` cells from a ``first`` one, with their places among these; no law without cells."""
        if self.owner is None:
            return [(self.first, slice(None))]
        own = self.owner[first : first + count]
        found = [(law, np.flatnonzero(own == k)) for k, law in enumerate(self.laws.values())]
        return [(law, cells) for law, cells in found if len(cells)]

    def masses(self, mesh: Mesh, section: Section) -> tuple[Array, ...]:
        """Masses (n,) of the nodes for each law [kg]."""
        chosen: list[BoolArray | None] = [None]
        if self.owner is not None:
            chosen = [self.owner == k for k in range(len(self.laws))]
        return tuple(heat_masses(mesh, section, self.density, inside) for inside in chosen)

    def curve(self, masses: tuple[Array, ...], latent: bool) -> ContentCurve | MixedContent:
        """Specific content of the nodes, with the ``latent`` heat if it is held there."""
        curves = tuple(content_curve(law, latent=latent) for law in self.laws.values())
        return curves[0] if len(curves) == 1 else MixedContent(curves=curves, shares=np.array(masses) / sum(masses))

    def effusivity(self, mesh: Mesh, volume: Array) -> float | Array:
        """Root of conductivity, density and capacity, one number or the mean (n,) of the cells at each node, from their
        volumes (e,) [W s^(1/2)/(m^2 K)].
        """
        laws = tuple(self.laws.values())
        if self.owner is None and not isinstance(self.density, np.ndarray):
            return laws[0].effusivity(self.density)
        owner = np.zeros(mesh.n_cells, int) if self.owner is None else self.owner
        of_cell = np.array([law.effusivity(1.0) for law in laws])[owner] * np.sqrt(self.density)
        total, weight, first = np.zeros(mesh.n_nodes), np.zeros(mesh.n_nodes), 0
        for nodes in mesh.blocks.values():
            here = slice(first, first + len(nodes))
            np.add.at(weight, nodes, volume[here, None])
            np.add.at(total, nodes, (volume * of_cell)[here, None])
            first += len(nodes)
        return total / weight


def regional_laws(body: Conductor, mesh: Mesh) -> RegionalLaws:
    """Laws and densities of a conductor with a mesh.

    Raises
    ------
    InputError
        With the region: if it does not exist, shares cells with another one, or cells are in none; and of
        latent heat that several laws cannot share.

    Examples
    --------
    >>> import softway as sw
    >>> bar = sw.meshes.Interval(length=1.0, cells=2).build()
    >>> law = sw.heat.Conduction(conductivity=1.0, capacity=1.0)
    >>> regional_laws(Conductor(mesh=bar, law=law, density=3.0, temperature=300.0), bar).density
    3.0
    """
    laws = conduction_laws(body.law)
    owner = owners(mesh, tuple(laws), "law") if isinstance(body.law, Mapping) else None
    if owner is not None:
        _require_shared(laws, body.latent, mesh)
    return RegionalLaws(laws=laws, owner=owner, density=_density(body.density, mesh))


def _density(given: float | Mapping[str, float], mesh: Mesh) -> float | Array:
    """Density of the body, or of each cell (e,) [kg/m^3]."""
    if not isinstance(given, Mapping):
        return given
    return np.array(list(given.values()))[owners(mesh, tuple(given), "density", "density")]


def _require_shared(laws: Mapping[str, Conduction], latent: str, mesh: Mesh) -> None:
    """Refuse latent heat that nodes of several laws cannot hold, or not in all digits."""
    apart = "a conductor of its own for each, and a heat contact between them"
    melting = {region: law.latent for region, law in laws.items() if law.latent is not None}
    for region, melts in melting.items():
        if melts.half_range > 0.0:
            problem = "a mushy range, at nodes that several laws share"
            raise InputError(f"law.{region}.latent.half_range", problem, f"zero; or {apart}")
        first = next(iter(melting))
        if melts.melting != melting[first].melting:
            problem = f"{melts.melting:g} K, where {first!r} melts at {melting[first].melting:g} K"
            raise InputError(f"law.{region}.latent.melting", problem, f"one temperature of melting; or {apart}")
    if melting and latent == "node":
        raise InputError("latent", "'node', at nodes that several laws share", f"'cell'; or {apart}")
    if melting and "hex20" in mesh.blocks:
        problem = "latent heat in hex20, whose nodes several laws share"
        raise InputError("law", problem, f"hex27; or {apart}")
