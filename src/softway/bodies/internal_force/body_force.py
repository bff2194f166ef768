"""Interface of the internal force of a body, for every material."""

from typing import Protocol

from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Section
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.slab_average import SlabForce


class BodyForce(Protocol):
    """Internal force of a body as a function of its displacement u (n, d) [m] at the end of a time step (slab).

    A path-dependent body depends on its material state at the start of the slab too: :meth:`during` gives the force
    of a slab, :meth:`committed` the material state at its end.  An elastic body has no material state: its ``state`` is
    None, and :meth:`during` gives the force itself.  The body has n nodes, p quadrature points and e elements.
    """

    @property
    def section(self) -> Section:
        """Section of the elements."""
        ...

    @property
    def sampling(self) -> StrainOperator:
        """Strain operator between nodes and quadrature points."""
        ...

    @property
    def directions(self) -> Array:
        """(p, m, D) or (1, m, D) reference directions of the points."""
        ...

    @property
    def linear(self) -> bool:
        """True if the tangent is constant."""
        ...

    @property
    def path_dependent(self) -> bool:
        """True if the force depends on a material state."""
        ...

    @property
    def state(self) -> MaterialState | None:
        """Material state at the start of the slab; None for an elastic body."""
        ...

    def during(self, state: MaterialState | None, span: float) -> "BodyForce":
        """Force in a slab of length ``span`` [s] that starts from a state; the force itself without one."""
        ...

    def transferred(self, piece: "BodyForce", nodes: IntArray, points: IntArray) -> "BodyForce":
        """Force ``piece`` of some nodes (k,) and points (q,) of the body, in the slab of this force."""
        ...

    def energy(self, u: Array) -> float:
        """Energy of :meth:`energy_and_force` [J]."""
        ...

    def force(self, u: Array) -> Array:
        """Force of :meth:`energy_and_force`, (n, d) [N]."""
        ...

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy plus the energy dissipated in the slab [J], and the force (n, d) [N] at the end of the slab.

        The energy is infinite and the force ``nan`` where the material is inverted.
        """
        ...

    def end_force(self, u: Array) -> tuple[float, Array, Array | None]:
        """Energy [J] and force of :meth:`energy_and_force`, and the part of the force due to the mean rate of the slab,
        (n, d) [N], None without viscosity, in one evaluation.
        """
        ...

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force averaged along the chord from u0 to u1 by a rule, (n, d) [N]; None for rules without a chord."""
        ...

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]; number of a component: ``node * d + component``."""
        ...

    def secant(self, u: Array) -> csc_array:
        """Tangent at fixed viscosity where the law has such moduli, otherwise :meth:`tangent`, (n d, n d) [N/m]."""
        ...

    def viscous_tangent(self, u: Array) -> csc_array | None:
        """Derivative of the viscous part of the force on the pattern of the tangent, (n d, n d) [N/m]; None without."""
        ...

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent at u with a change w (n, d) [m] of the displacement."""
        ...

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        ...

    def committed(self, u: Array) -> MaterialState | None:
        """Material state at the end of the slab; None for an elastic body."""
        ...

    def stored_energy(self, state: MaterialState | None, energy: float) -> float:
        """Stored energy [J] in a committed state where :meth:`energy_and_force` gave ``energy`` [J]."""
        ...

    def dissipated_energy(self, state: MaterialState | None) -> float:
        """Energy dissipated from the start of the march up to a committed state [J]."""
        ...

    def stored_force(self, state: MaterialState | None, u: Array) -> tuple[float, Array, Array | None]:
        """Stored energy [J], force (n, d) and its viscous part (n, d) or None [N], of a committed state at u."""
        ...

    def stored_viscous_force(self, state: MaterialState | None) -> Array | None:
        """Viscous part of the force in a committed state, (n, d) [N]; None without viscosity."""
        ...

    def stress(self, u: Array, state: MaterialState | None = None) -> Array:
        """Cauchy stress (e, 3, 3) [Pa] at the end of the slab, or in a committed state, averaged over each element.

        The average is over the present volume; elements are in the order of the blocks.
        """
        ...

    def stored_scalars(self, state: MaterialState | None) -> dict[str, Array]:
        """Scalars (e,) of a committed state by name, averaged over the reference volume of each element."""
        ...

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where the material is inverted."""
        ...
