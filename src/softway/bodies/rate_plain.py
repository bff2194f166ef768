"""Internal force of laws with a history by NumPy, for every law, rate and section."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.memory import Memory
from softway.bodies.rate_points import Answer, RatePoints
from softway.bodies.sampling import Sampling, diagonal_blocks
from softway.laws.law import Damped, Viscous
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RatePlain:
    """What a body answers to a slab, by arrays over all its points.

    The slab starts with a ``memory``, ends at the displacement u (n, d) [m] and is of length ``span`` [s].

    Parameters
    ----------
    sampling
        From the nodes to the points and back.
    points
        The points.
    """

    sampling: Sampling
    points: RatePoints

    def answer(self, u: Array, memory: Memory, span: float) -> tuple[Array, Answer]:
        """Displacement derivatives (p, m, D) at the end, and what the points answer."""
        H0, H1 = self.sampling.derivatives(memory.displacement), self.sampling.derivatives(u)
        return H1, self.points.answer(H0, H1, memory, span)

    def energy_and_force(self, u: Array, memory: Memory, span: float) -> tuple[float, Array]:
        """Energy [J] stored since the start, with what the slab dissipates, and the force (n, d) [N] at its end."""
        H, found = self.answer(u, memory, span)
        with np.errstate(invalid="ignore"):
            taken = found.ratio * (found.response.stored + found.response.dissipated)
            flux = self.points.flux(self.points.stress(found), found.F, H)
        energy = float(self.sampling.volume @ (memory.stored + taken))
        return energy if np.isfinite(energy) else np.inf, self.sampling.nodal(flux, u)

    def viscous_force(self, u: Array, memory: Memory, span: float) -> Array | None:
        """The part of the force that belongs to the mean rate of the slab, (n, d) [N]; None where there is none."""
        H, found = self.answer(u, memory, span)
        viscous = self.points.viscous_stress(found)
        return None if viscous is None else self.sampling.nodal(self.points.flux(viscous, found.F, H), u)

    def tangent(self, u: Array, memory: Memory, span: float) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m], made symmetric."""
        return self._stiffness(u, memory, span, secant=False)

    def secant(self, u: Array, memory: Memory, span: float) -> csc_array:
        """The tangent with the viscosity held fixed, where the law has such moduli, (n d, n d) [N/m]."""
        return self._stiffness(u, memory, span, secant=isinstance(self.points.law, Viscous))

    def _stiffness(self, u: Array, memory: Memory, span: float, secant: bool) -> csc_array:
        H, found = self.answer(u, memory, span)
        flux = self.points.flux(self.points.steady_stress(found), found.F, H)
        return self.sampling.matrix(self.points.moduli(found, H, secant), flux, u)

    def viscous_tangent(self, u: Array, memory: Memory, span: float) -> csc_array | None:
        """Derivative of :meth:`viscous_force` on the pattern of the tangent, (n d, n d) [N/m]; None without."""
        law = self.points.law
        if not isinstance(law, Damped):
            return None
        H, found = self.answer(u, memory, span)
        return self.sampling.matrix(self.points.viscous_moduli(law, found, H), np.zeros_like(H), u)

    def tangent_product(self, u: Array, memory: Memory, span: float, w: Array) -> Array:
        """The tangent times w (n, d), (n, d) [N]."""
        return np.asarray(self.tangent(u, memory, span) @ w.ravel()).reshape(w.shape)

    def tangent_diagonal_blocks(self, u: Array, memory: Memory, span: float) -> Array:
        """Blocks of the tangent that couple each node with itself, (n, d, d) [N/m]."""
        return diagonal_blocks(self.tangent(u, memory, span), (u.shape[0], u.shape[1]))

    def settled(self, u: Array, memory: Memory, span: float) -> Memory:
        """The memory at the end of the slab."""
        return self.points.settled(self.answer(u, memory, span)[1], memory, u)

    def remembered(self, memory: Memory) -> tuple[float, Array, Array | None]:
        """Stored energy [J], force and its viscous part (n, d) [N] at the time of a memory."""
        u = memory.displacement
        H = self.sampling.derivatives(u)
        F = self.points.gradient(H, memory.lateral)
        force, viscous = (
            None if s is None else self.sampling.nodal(self.points.flux(s, F, H), u)
            for s in (memory.stress, memory.viscous)
        )
        assert force is not None
        return float(self.sampling.volume @ memory.stored), force, viscous
