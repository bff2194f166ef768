"""Internal force of path-dependent laws with a mean dilatation of each element: force by kernels, tangent by NumPy."""

from dataclasses import dataclass

from scipy.sparse import csc_array

from softway.arrays import Array
from softway.bodies.internal_force.inelastic.array_evaluation import RateArrayEvaluation
from softway.bodies.internal_force.inelastic.kernel_evaluation import RateKernelEvaluation
from softway.bodies.internal_force.material_state import MaterialState


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RateMeanEvaluation:
    """Evaluation of a slab by kernels and arrays; arguments as for :class:`RateArrayEvaluation`.

    Parameters
    ----------
    kernels
        Evaluation of forces and material states.
    arrays
        Evaluation of tangents.
    """

    kernels: RateKernelEvaluation
    arrays: RateArrayEvaluation

    def energy_and_force(self, u: Array, state: MaterialState, span: float) -> tuple[float, Array]:
        """Stored energy plus the energy dissipated in the slab [J], and the force (n, d) [N] at the end of the slab."""
        return self.kernels.energy_and_force(u, state, span)

    def stored_force(self, state: MaterialState) -> tuple[float, Array, Array | None]:
        """Stored energy [J] and force (n, d) [N] of a committed state; None for the viscous part."""
        return self.kernels.stored_force(state)

    def end_force(self, u: Array, state: MaterialState, span: float) -> tuple[float, Array, Array | None]:
        """:meth:`energy_and_force`, and None: the law has no viscosity."""
        return self.kernels.end_force(u, state, span)

    def committed(self, u: Array, state: MaterialState, span: float) -> MaterialState:
        """Material state at the end of the slab."""
        return self.kernels.committed(u, state, span)

    def tangent(self, u: Array, state: MaterialState, span: float) -> csc_array:
        """Derivative of the force, made symmetric, (n d, n d) [N/m]."""
        return self.arrays.tangent(u, state, span)

    def secant(self, u: Array, state: MaterialState, span: float) -> csc_array:
        """:meth:`tangent` (n d, n d) [N/m]: the law has no viscosity."""
        return self.arrays.tangent(u, state, span)

    def tangent_product(self, u: Array, state: MaterialState, span: float, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return self.arrays.tangent_product(u, state, span, w)

    def tangent_diagonal_blocks(self, u: Array, state: MaterialState, span: float) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        return self.arrays.tangent_diagonal_blocks(u, state, span)
