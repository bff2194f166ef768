"""Internal force of laws with a history in cells with a mean dilatation: forces by kernels, tangents by NumPy."""

from dataclasses import dataclass

from scipy.sparse import csc_array

from softway.bodies.memory import Memory
from softway.bodies.rate_fused import RateFused
from softway.bodies.rate_plain import RatePlain
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RateMean:
    """What a body answers to a slab.

    Parameters
    ----------
    kernels
        For forces and memories.
    arrays
        For tangents.
    """

    kernels: RateFused
    arrays: RatePlain

    def energy_and_force(self, u: Array, memory: Memory, span: float) -> tuple[float, Array]:
        """Energy [J] stored since the start, with what the slab dissipates, and the force (n, d) [N] at its end."""
        return self.kernels.energy_and_force(u, memory, span)

    def remembered(self, memory: Memory) -> tuple[float, Array, Array | None]:
        """Stored energy [J] and force (n, d) [N] at the time of a memory; nothing is viscous."""
        return self.kernels.remembered(memory)

    def viscous_force(self, u: Array, memory: Memory, span: float) -> Array | None:
        """None: nothing is viscous."""
        return None

    def settled(self, u: Array, memory: Memory, span: float) -> Memory:
        """The memory at the end of the slab."""
        return self.kernels.settled(u, memory, span)

    def tangent(self, u: Array, memory: Memory, span: float) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m], made symmetric."""
        return self.arrays.tangent(u, memory, span)

    def secant(self, u: Array, memory: Memory, span: float) -> csc_array:
        """The tangent: nothing is viscous."""
        return self.arrays.tangent(u, memory, span)

    def tangent_product(self, u: Array, memory: Memory, span: float, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        return self.arrays.tangent_product(u, memory, span, w)

    def tangent_diagonal_blocks(self, u: Array, memory: Memory, span: float) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        return self.arrays.tangent_diagonal_blocks(u, memory, span)
