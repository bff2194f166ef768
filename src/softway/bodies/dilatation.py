"""The change of volume as a mean over a cell, or around a corner: incompressible matter without locking.

    F_bar = (theta/J)^(1/m) F

at each point of a cell of m dimensions; the law sees F_bar.  J = det F, and theta is J smoothed: its mean over the cell
(mean dilatation), or its means around the corners of the cells with linear interpolation in between (the pressure of
Taylor and Hood's element, with a lumped mass of the pressure).  The stress acts on the nodes by the derivative of
F_bar, so that a stored energy stays one, and the tangent is the exact second derivative.  In the linear theory J is the
trace of the strain, and what is smoothed is added to it (docs/theory/incompressible.md).

References
----------
Nagtegaal, Parks, Rice (1974), Comput. Methods Appl. Mech. Engrg. 4, 153-177; Simo, Taylor, Pister (1985), Comput.
Methods Appl. Mech. Engrg. 51, 177-208; de Souza Neto, Peric, Dutko, Owen (1996), Int. J. Solids Struct. 33, 3277-3296;
Taylor, Hood (1973), Comput. Fluids 1, 73-100; Bonet, Burton (1998), Commun. Numer. Meth. Eng. 14, 437-449.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import csc_array

from softway.bodies.section import Axisymmetric, Section, derivatives
from softway.kernels import tensors
from softway.kernels.gather import Assembler
from softway.typing import Array


class Smoothing(Protocol):
    """A linear map of values (p,) at the points that keeps constants, symmetric under the volume of the points."""

    @property
    def volume(self) -> Array:
        """(p,) reference volume of each point [m^3]."""
        ...

    def mean(self, values: Array) -> Array:
        """The smoothed values (p,)."""
        ...

    def matrix(self, pattern: Assembler, varied: "Varied") -> csc_array:
        """Second derivative (n d, n d) of the energy."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Dilatation:
    """The change of volume that the law sees at the points.

    Parameters
    ----------
    section
        How the cells fill space.
    rows
        Per block of cells (e, q, a, k) the sampling of the nodes.
    smoothing
        What makes theta of J.
    small
        Whether strains are those of the linear theory.
    """

    section: Section
    rows: tuple[Array, ...]
    smoothing: Smoothing
    small: bool

    def _ratios(self, f: Array) -> tuple[Array, Array, Array]:
        """J, theta and ``(theta/J)^(1/m)``, (p,); ``nan`` where matter is inverted."""
        J = tensors.determinant(f)
        theta = self.smoothing.mean(J)
        with np.errstate(invalid="ignore", divide="ignore"):
            return J, theta, np.where((J > 0.0) & (theta > 0.0), theta / J, np.nan) ** (1.0 / f.shape[-1])

    def applied(self, H: Array) -> Array:
        """Displacement derivatives (p, m, m) of F_bar."""
        if self.small:
            own = np.trace(H, axis1=1, axis2=2) / H.shape[-1]
            return H + (self.smoothing.mean(own) - own)[:, None, None] * np.eye(H.shape[-1])
        f = np.eye(H.shape[-1]) + H
        return self._ratios(f)[2][:, None, None] * f - np.eye(H.shape[-1])

    def returned(self, flux: Array, H: Array) -> Array:
        """Flux (p, m, m) on the derivatives H of the shape functions, from that on ``F_bar``."""
        if self.small:
            own = np.trace(flux, axis1=1, axis2=2) / H.shape[-1]
            return flux + (self.smoothing.mean(own) - own)[:, None, None] * np.eye(H.shape[-1])
        f = np.eye(H.shape[-1]) + H
        J, theta, r = self._ratios(f)
        own = r * tensors.double_dot(flux, f) / f.shape[-1]
        return r[:, None, None] * flux + (J * self.smoothing.mean(own / theta) - own)[:, None, None] * _slope(f)

    def matrix(self, pattern: Assembler, moduli: Array, flux: Array, H: Array) -> csc_array:
        """Second derivative (n d, n d) of the energy, of moduli (p, m, m, m, m) and flux (p, m, m) on F_bar."""
        if self.small:
            H, flux = np.zeros_like(H), np.zeros_like(flux)
        f = np.eye(H.shape[-1]) + H
        J, theta, r = self._ratios(f)
        own = r * tensors.double_dot(flux, f) / f.shape[-1]
        return self.smoothing.matrix(
            pattern,
            Varied(
                section=self.section,
                rows=self.rows,
                volume=self.smoothing.volume,
                moduli=moduli,
                flux=flux,
                f=f,
                ratios=(J, theta, r),
                pressures=(own, self.smoothing.mean(own / theta)),
            ),
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Varied:
    """What second derivatives are made of.

    ``ratios`` J, theta, r and ``pressures`` ``flux : F_bar/m`` and the smoothed quotient of it and theta, (p,) each.
    """

    section: Section
    rows: tuple[Array, ...]
    volume: Array
    moduli: Array
    flux: Array
    f: Array
    ratios: tuple[Array, Array, Array]
    pressures: tuple[Array, Array]

    def blocks(self) -> list["Block"]:
        """The derivatives of each kind of cell."""
        out, start = [], 0
        for G in self.rows:
            e, q = G.shape[:2]
            out.append(self._block(G, slice(start, start + e * q)))
            start += e * q
        return out

    def _block(self, G: Array, here: slice) -> "Block":
        """All that does not ask theta how it varies."""
        f, flux, V = self.f[here], self.flux[here], self.volume[here]
        J, _, r = (x[here] for x in self.ratios)
        own, quotient = (x[here] for x in self.pressures)
        m = f.shape[-1]
        B = _units(self.section, G)
        p, n = B.shape[:2]
        slope = _slope(f)
        lnJ = np.einsum("pxJi,pJi->px", B, slope)
        bar = (r[:, None, None, None] * (B - lnJ[:, :, None, None] * f[:, None] / m)).reshape(p, n, m * m)
        stiff = (bar * V[:, None, None]) @ self.moduli[here].reshape(p, m * m, m * m)
        along = (r[:, None] * f.reshape(p, m * m)) / m  # change of F_bar with ln theta
        mixed = np.einsum("pxy,py->px", stiff, along)
        twice = V * np.einsum("py,pyz,pz->p", along, self.moduli[here].reshape(p, m * m, m * m), along)
        stiff = stiff @ np.swapaxes(bar, 1, 2)
        pull = (r * V)[:, None] * np.einsum("pxJi,pJi->px", B, flux) / m
        stiff -= both(lnJ, pull)
        stiff += (own * V / m + V * quotient * J)[:, None, None] * lnJ[:, :, None] * lnJ[:, None, :]
        L = np.einsum("pJi,pxJk->pxik", slope, B)
        turned = np.swapaxes(L, 2, 3).reshape(p, n, m * m)
        weight = V * (quotient * J - own)
        stiff -= weight[:, None, None] * (L.reshape(p, n, m * m) @ np.swapaxes(turned, 1, 2))
        mixed += pull - (own * V / m)[:, None] * lnJ
        twice += V * own * (1.0 / m - 1.0)
        return Block(cells=G.shape, local=stiff, mixed=mixed, twice=twice, slope=J[:, None] * lnJ)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Block:
    """Second derivatives of the cells (e, q, a, k) of one kind, over x = a d components of their nodes.

    ``local`` (p, x, x) with theta as it is; ``mixed`` (p, x) with ln theta once, ``twice`` (p,) with it twice;
    ``slope`` (p, x) of J.
    """

    cells: tuple[int, ...]
    local: Array
    mixed: Array
    twice: Array
    slope: Array

    def shaped(self, stiff: Array) -> Array:
        """Cell matrices (e, a, a, d, d) of those of the cells (e, x, x)."""
        e, a = self.cells[0], self.cells[2]
        d = stiff.shape[-1] // a
        return stiff.reshape(e, a, d, a, d).transpose(0, 1, 3, 2, 4)


def both(x: Array, y: Array) -> Array:
    """``x y^T + y x^T`` of (..., n)."""
    outer = x[..., :, None] * y[..., None, :]
    return np.asarray(outer + np.swapaxes(outer, -1, -2))


def _slope(f: Array) -> Array:
    """Derivative of ln det F to the displacement derivatives, (p, m, m)."""
    finite = np.where(np.isfinite(f), f, np.eye(f.shape[-1]))
    return np.swapaxes(np.linalg.inv(finite), -1, -2)


def _units(section: Section, G: Array) -> Array:
    """Derivatives (e q, a d, m, m) that unit displacements of the nodes make."""
    e, q, a, k = G.shape
    d = 2 if isinstance(section, Axisymmetric) else k
    A = np.zeros((e * q, a, d, k, d))
    for j in range(d):
        A[:, :, j, :, j] = G.reshape(e * q, a, k)
    return derivatives(section, A.reshape(e * q, a * d, k, d))
