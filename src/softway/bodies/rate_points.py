"""Points of a body whose law has a history: from the motion of a slab to stresses, fluxes and moduli."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.kinematics import Passage, carried, passage
from softway.bodies.memory import Memory
from softway.kernels import tensors
from softway.laws.law import Damped, Increment, RateLaw, Response, Viscous
from softway.laws.rates import Rate, Truesdell
from softway.typing import Array

TOLERANCE = 1e-12
"""Lateral strain, of the last correction, at which free faces are free."""
LIMIT = 40
"""Corrections of the lateral strain."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Answer:
    """What the points answer to a slab; leading axis p.

    ``response`` is in the axes of the middle, its stresses in those of ``passed.second``; ``F`` (p, 3, 3) the
    deformation at the end, ``ratio`` (p,) the volume ratio by which energies count; ``increment`` what the law was
    asked, ``lateral`` (p, k) the stretch of the free axes.
    """

    response: Response
    passed: Passage
    F: Array
    ratio: Array
    increment: Increment
    lateral: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RatePoints:
    """Points p of one material with a history, in cells that fill m of their D dimensions.

    Arguments ``H`` are displacement derivatives (p, m, D), see :mod:`softway.laws.measure`.

    Parameters
    ----------
    law
        The law.
    free
        Axes beyond the cell whose normal stress is zero.
    directions
        (p, m, D) or (1, m, D) orthonormal reference directions.
    """

    law: RateLaw
    free: tuple[int, ...]
    directions: Array

    def gradient(self, H: Array, lateral: Array) -> Array:
        """Deformation gradient (p, 3, 3) with the stretches (p, k) of the free axes; of a bar in axes of its own."""
        f = self.directions + H
        m, size = f.shape[-2:]
        F = np.zeros((len(H), 3, 3))
        F[:, range(3), range(3)] = 1.0
        if m == 1:
            F[:, 0, 0] = np.sqrt(np.einsum("pJi,pJi->p", f, f))
        else:
            F[:, :size, :size] = np.swapaxes(f, 1, 2) @ self.directions  # F_iK = f_Ji g_JK
        for k, axis in enumerate(self.free):
            F[:, axis, axis] = lateral[:, k]
        return F

    def answer(self, H0: Array, H1: Array, memory: Memory, span: float) -> Answer:
        """What the points answer to a slab between two states; ``nan`` where matter is inverted."""
        F0 = self.gradient(H0, memory.lateral)
        lateral = memory.lateral
        with np.errstate(all="ignore"):
            found = self._asked(F0, self.gradient(H1, lateral), memory, span, lateral)
            for _ in range(LIMIT if self.free else 0):
                step = self._relief(found)
                lateral = np.asarray(lateral * np.exp(np.clip(step, -0.5, 0.5)))
                found = self._asked(F0, self.gradient(H1, lateral), memory, span, lateral)
                if not np.any(np.abs(step) > TOLERANCE):
                    break
        return found

    def _asked(self, F0: Array, F1: Array, memory: Memory, span: float, lateral: Array) -> Answer:
        rate = self.law.rate
        inverted = ~(tensors.determinant(F1) > 0.0)
        if inverted.any():
            F1 = np.where(inverted[:, None, None], np.nan, F1)
            F1 = np.where(np.isfinite(F1), F1, np.eye(3))
        passed = passage(rate, F0, F1)
        increment = Increment(
            stress=carried(memory.stress, passed.first, rate),
            memory=_moved(memory.law, passed.first, rate),
            strain=passed.strain,
            span=span,
        )
        response = self.law.respond(increment)
        if inverted.any():
            stress = np.where(inverted[:, None, None], np.nan, response.stress)
            response = replace(response, stress=stress, stored=np.where(inverted, np.nan, response.stored))
        ratio = tensors.determinant(0.5 * (F0 + F1))
        return Answer(response=response, passed=passed, F=F1, ratio=ratio, increment=increment, lateral=lateral)

    def _relief(self, found: Answer) -> Array:
        """Changes (p, k) of the logarithmic lateral strains that take the stress off the free faces."""
        axes = np.array(self.free)
        C = self.law.moduli(found.increment)[:, axes, axes][:, :, axes, axes]
        pull = found.response.stress[:, axes, axes]
        out = -np.linalg.solve(np.where(np.isfinite(C), C, np.eye(len(axes))), pull[..., None])[..., 0]
        return np.where(np.isfinite(out), out, 0.0)

    def stress(self, found: Answer) -> Array:
        """Cauchy stress (p, 3, 3) at the end [Pa]."""
        return carried(found.response.stress, found.passed.second, self.law.rate)

    def _steady(self, found: Answer) -> Array:
        viscous = isinstance(self.law, Viscous)
        return np.zeros_like(found.response.stress) if viscous else found.response.stress

    def steady_stress(self, found: Answer) -> Array:
        """The Cauchy stress (p, 3, 3) [Pa] that tangents turn with the matter: that at the end.

        Of viscous matter it is that of the start: the pressure of an iterate may be far out of balance where volume is
        kept, and would make the tangent indefinite.
        """
        return carried(self._steady(found), found.passed.second, self.law.rate)

    def viscous_stress(self, found: Answer) -> Array | None:
        """The part of :meth:`stress` that the mean rate makes."""
        viscous = found.response.viscous
        return None if viscous is None else carried(viscous, found.passed.second, self.law.rate)

    def flux(self, sigma: Array, F: Array, H: Array) -> Array:
        """First Piola-Kirchhoff stress along the directions, (p, m, D) [Pa], of a Cauchy stress (p, 3, 3)."""
        J = tensors.determinant(F)
        m, size = H.shape[1:]
        if m == 1:
            f = self.directions + H
            return (J * sigma[:, 0, 0] / F[:, 0, 0] ** 2)[:, None, None] * f
        P = J[:, None, None] * (np.linalg.inv(F) @ sigma)  # P_Ki
        return self.directions @ P[:, :size, :size]

    def settled(self, found: Answer, memory: Memory, u: Array) -> Memory:
        """The memory after the slab that ends at the displacement u (n, d)."""
        response = found.response
        return Memory(
            displacement=np.array(u),
            stress=self.stress(found),
            law=_moved(response.memory, found.passed.second, self.law.rate),
            lateral=found.lateral.copy(),
            stored=memory.stored + found.ratio * response.stored,
            dissipated=memory.dissipated + found.ratio * response.dissipated,
            viscous=self.viscous_stress(found),
        )

    def moduli(self, found: Answer, H: Array, secant: bool = False) -> Array:
        """Derivative of the flux to H, (p, m, D, m, D) [Pa], made symmetric; the free faces follow.

        The stress that turns with the matter is :meth:`steady_stress`.
        """
        sigma, law = self._steady(found), self.law
        own = law.secant(found.increment) if secant and isinstance(law, Viscous) else law.moduli(found.increment)
        return self._spread(own, sigma, found, H)

    def _spread(self, own: Array, sigma: Array, found: Answer, H: Array) -> Array:
        C = spatial(own, sigma, self.law.rate)
        J = tensors.determinant(found.F)
        m, size = H.shape[1:]
        if m == 1:
            return self._bar_moduli(C, sigma, found, H, J)
        C = _relieved(C, self.free)
        B = found.passed.second
        if isinstance(self.law.rate, Truesdell):
            B = tensors.rotation(B)
        to = self.directions @ np.linalg.inv(found.F)[:, :size, :] @ B  # (p, m, 3): F^-1 to the axes of the middle
        turned = B[:, :size, :]  # (p, D, 3): components i in the axes of the middle
        left = np.einsum("pJa,pib,pabcd->pJicd", to, turned, C, optimize=True)
        out = np.einsum("pJicd,pLc,pld->pJiLl", left, to, turned, optimize=True)
        spin = np.einsum("pJa,pab,pLb->pJL", to, sigma, to, optimize=True)
        out += spin[:, :, None, :, None] * np.eye(size)[:, None, :]
        return J[:, None, None, None, None] * out

    def viscous_moduli(self, law: Damped, found: Answer, H: Array) -> Array:
        """The part of :meth:`moduli` that the mean rate makes, by what the ``law`` of the points says of it."""
        own, still = self.law.moduli(found.increment), np.zeros_like(found.F)
        more = own + law.viscous_moduli(found.increment)
        return self._spread(more, still, found, H) - self._spread(own, still, found, H)

    def _bar_moduli(self, C: Array, sigma: Array, found: Answer, H: Array, J: Array) -> Array:
        """Moduli (p, 1, D, 1, D) of a bar: stiff along its axis, pulled across it."""
        C = _relieved(C, self.free)
        length = found.F[:, 0, 0]
        along = (self.directions + H)[:, 0] / length[:, None]
        axis = along[:, :, None] * along[:, None, :]
        stiff = (J * C[:, 0, 0, 0, 0] / length**2)[:, None, None]
        pull = (J * sigma[:, 0, 0] / length**2)[:, None, None]
        return ((stiff + pull) * axis + pull * (np.eye(H.shape[2]) - axis))[:, None, :, None, :]


def spatial(C: Array, sigma: Array, rate: Rate) -> Array:
    """Moduli (..., 3, 3, 3, 3) of Truesdell's rate of the Kirchhoff stress per present volume, made symmetric.

    ``s_T = C:D - D s - s D + tr(D) s`` where C belongs to a corotational rate of the Cauchy stress.
    """
    if isinstance(rate, Truesdell):
        return C
    one = np.eye(3)
    out = C + 0.5 * (
        sigma[..., :, :, None, None] * one[None, None, :, :] + one[:, :, None, None] * sigma[..., None, None, :, :]
    )
    part = one[:, None, :, None] * sigma[..., None, :, None, :] + sigma[..., :, None, :, None] * one[None, :, None, :]
    part = part + np.swapaxes(part, -1, -2)
    return np.asarray(out - 0.5 * part)


def _relieved(C: Array, free: tuple[int, ...]) -> Array:
    """Moduli whose free axes carry no stress."""
    if not free:
        return C
    axes = np.array(free)
    stiff = C[:, axes, axes][:, :, axes, axes]
    right = C[:, axes, axes].reshape(len(C), len(axes), 9)
    left = np.moveaxis(C[..., axes, axes], -1, 1).reshape(len(C), len(axes), 9)
    follow = np.linalg.solve(stiff, right)
    return C - np.einsum("pkx,pky->pxy", left, follow).reshape(C.shape)


def _moved(memory: Mapping[str, Array], A: Array, rate: Rate) -> Mapping[str, Array]:
    """The memory carried along: its tensors turn, its numbers stay."""
    return {n: carried(a, A, rate) if a.shape[1:] == (3, 3) else a for n, a in memory.items()}
