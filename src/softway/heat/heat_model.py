"""Discretised conductors: nodes of all bodies in one numbering, capacities, cells, boundary conditions."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.vector_space import LocalSpace, VectorSpace
from softway.bodies.conductor import Conductor
from softway.bodies.elements.following_heat import FollowingHeat
from softway.bodies.elements.front_cells import FrontCells
from softway.bodies.setup.heat_loads import HeatLoad, HeatSource, SurfaceHeat, Temperature
from softway.heat.heat_contact import HeatContact, HeatExchange
from softway.kernels.assembly.assembler import Assembler
from softway.laws.heat.conduction import Conduction
from softway.laws.heat.heat_content import ContentCurve
from softway.laws.heat.mixed_content import MixedContent
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatScene:
    """Conductors, and the boundary conditions and sources of their heat: an immutable description.

    Parameters
    ----------
    bodies
        Conductors by name.
    loads
        Temperatures, heat fluxes, convection, radiation and sources.  Surfaces without any are insulated.  Where two
        temperatures meet in a node, the later one holds.
    contacts
        Exchange of heat between surfaces that touch; other bodies do not exchange heat.

    Examples
    --------
    >>> HeatScene(bodies={}).loads
    ()
    """

    bodies: Mapping[str, Conductor]
    loads: tuple[HeatLoad, ...] = ()
    contacts: tuple[HeatContact, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatPart:
    """Discretised conductor.

    Parameters
    ----------
    name
        Name in the scene.
    mesh
        Its mesh.
    nodes, cells
        Its nodes and cells among those of all bodies; hanging nodes have no heat, and are not among them.
    kept
        (k,) the nodes among those of the mesh.
    places
        All nodes of the mesh among those of all bodies.
    law
        Law of conduction, of several by regions the first one that melts if any does.
    curve
        Specific content of a node, with the latent heat if it is held at the nodes.
    at_nodes
        True if the unknowns of the nodes are contents: latent heat is at the nodes.
    zero
        Temperature from which the unknowns of the nodes are counted where they are temperatures [K].
    mixed
        True if a cell conducts like the mixture at its nodes, False if it does by the part that is above melting.
    volume
        (e,) volumes of the cells [m^3].
    """

    name: str
    mesh: Mesh
    nodes: slice
    kept: IntArray
    places: slice
    cells: slice
    law: Conduction
    curve: ContentCurve | MixedContent
    at_nodes: bool
    zero: float
    mixed: bool
    volume: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Lump:
    """Rigid body with one temperature: a node without cells.

    Parameters
    ----------
    name
        Name in the scene.
    capacity, initial
        Heat capacity [J/K], and initial temperature [K].
    effusivity
        Root of conductivity, density and capacity [W s^(1/2)/(m^2 K)]; None if unknown.
    area, volume
        Surface [m^2] and volume [m^3] on which loads of heat act; None if unknown.
    """

    name: str
    capacity: float
    initial: float
    effusivity: float | None = None
    area: float | None = None
    volume: float | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatCells:
    """Cells of one type of a body: nodes (e, a), which may hang, functions N (q, a), gradients (e, q, a, r) [1/m],
    volumes (e, q) [m^3] of the points, and numbers (e,) among all cells.
    """

    law: Conduction
    nodes: IntArray
    N: Array
    gradients: Array
    volume: Array
    numbers: IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Simplices:
    """Simplices that the temperature of melting may cut: nodes (s, k), which may hang, masses (s,) [kg], shares (s,) of
    their cells, numbers (s,) of these among all cells; their latent heat [J/kg] is zero where it is at the nodes, and
    matter melts from the temperature of melting over a ``width`` [K].
    """

    nodes: IntArray
    mass: Array
    share: Array
    numbers: IntArray
    width: float
    heat: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatSurface:
    """Heat exchange at points of a surface: interpolation (p, n) and areas (p,) [m^2]."""

    load: SurfaceHeat
    points: sp.csr_array
    areas: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatModel:
    """Discretised conductors of n nodes and E cells; the last nodes are those of rigid bodies.

    Parameters
    ----------
    parts
        Bodies.
    cells
        Their cells by type.
    hanging
        Heat of hanging nodes, which are not among the n; None without.
    simplices
        Simplices of the bodies that melt.
    mass
        (n,) lumped masses [kg]; of rigid bodies their capacities [J/K].
    pattern
        Assembly of cell matrices.
    surfaces
        Heat exchange at surfaces.
    sources
        Sources with their nodal volumes (n,) [m^3].
    held
        Prescribed temperatures with their nodes.
    exchanges
        Exchange of heat between bodies, for each contact.
    ordered
        Loads with their numbers in the scene, in the order of the ledger: surfaces, sources, prescribed temperatures.
    initial
        (n,) initial temperatures [K].
    linear
        True if the content is linear in the temperature, and the heat flow too.
    latent
        (n,) latent heats of the nodes in cut cells when all around them is liquid [J].
    n_cells
        Number E of cells.
    fronts
        Cells of bars that have fronts between their nodes; None without.
    conduction, capacity
        If all laws are constant: (n, n) derivative of the heat that flows out of the nodes by conduction [W/K], and
        (n,) their capacities [J/K].
    lumps
        Rigid bodies.
    space, free_space
        Sums over the nodes, and over those without a prescribed temperature.
    """

    parts: tuple[HeatPart, ...]
    cells: tuple[HeatCells, ...]
    simplices: tuple[Simplices, ...]
    mass: Array
    pattern: Assembler
    surfaces: tuple[HeatSurface, ...]
    sources: tuple[tuple[HeatSource, Array], ...]
    held: tuple[tuple[Temperature, IntArray], ...]
    exchanges: tuple[HeatExchange, ...]
    ordered: tuple[tuple[int, HeatLoad], ...]
    initial: Array
    linear: bool
    latent: Array
    n_cells: int
    fronts: FrontCells | None = None
    conduction: sp.csr_array | None = None
    capacity: Array | None = None
    lumps: tuple[Lump, ...] = ()
    hanging: FollowingHeat | None = None
    space: VectorSpace = LocalSpace(())
    free_space: VectorSpace = LocalSpace(())

    @property
    def whole(self) -> bool:
        """True if this process has all nodes."""
        return isinstance(self.space, LocalSpace)

    @property
    def n_nodes(self) -> int:
        """Number n of nodes."""
        return len(self.mass)

    @property
    def loads(self) -> tuple[HeatLoad, ...]:
        """Loads in the order of the scene."""
        return tuple(load for _, load in sorted(self.ordered, key=lambda item: item[0]))

    def everywhere(self, values: Array) -> Array:
        """Temperatures (N,) of all nodes, hanging ones among them, from those (n,)."""
        return values if self.hanging is None else np.asarray(self.hanging.follow @ values)

    def held_by(self, values: Array) -> Array:
        """Values (N,) at all nodes by which their heat tells its melting, from those (n,)."""
        return values if self.hanging is None else np.asarray(self.hanging.spread @ values)

    def owned(self, heat: Array) -> Array:
        """Heat (n,) of the nodes from that (N,) held by all nodes."""
        return heat if self.hanging is None else np.asarray(self.hanging.spread.T @ heat)

    def ledger_places(self) -> tuple[int, ...]:
        """Place of each load of the scene, in its order, among the heats of the ledger."""
        return tuple(sorted(range(len(self.ordered)), key=lambda place: self.ordered[place][0]))

    def free_nodes(self) -> BoolArray:
        """Nodes (n,) without a prescribed temperature."""
        free = np.ones(self.n_nodes, dtype=bool)
        for _, nodes in self.held:
            free[nodes] = False
        return free

    @property
    def some_free(self) -> bool:
        """True if a node has no prescribed temperature."""
        return self.space.total(self.free_nodes()) > 0.0
