"""Averaged volume change in the elements (F-bar): nearly incompressible material without locking.

    F_bar = (theta/J)^(1/m) F

at each point of an element of m dimensions; the law is evaluated at F_bar.  J = det F, and theta is the average of J
over the element (mean dilatation), or its averages around the corner nodes with linear interpolation (the pressure of
the Taylor-Hood element, with a lumped pressure mass).  Nodal forces follow from the derivative of F_bar: they are the
derivative of a stored energy, and the tangent is its exact second derivative.  In the linear theory J is the trace of
the strain, and its average is added in place of it (docs/theory/bodies/incompressible.md).

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

from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric, Section, derivatives
from softway.kernels.assembly.assembler import Assembler
from softway.kernels.linalg import tensors


class DilatationAverage(Protocol):
    """Linear average of values (p,) at the points; it keeps constants, and is symmetric with the volumes as weights."""

    @property
    def volume(self) -> Array:
        """(p,) reference volume of each point [m^3]."""
        ...

    def mean(self, values: Array) -> Array:
        """Averages (p,) at the points."""
        ...

    def matrix(self, pattern: Assembler, varied: "Varied") -> csc_array:
        """Second derivative (n d, n d) of the energy."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeanDilatation:
    """F-bar map between displacement derivatives and fluxes of the element and of the law.

    Parameters
    ----------
    section
        Section of the elements.
    rows
        Rows (e, q, a, k) of the strain operator, for each cell type.
    smoothing
        Average that gives theta.
    small
        True for the linear theory.
    """

    section: Section
    rows: tuple[Array, ...]
    smoothing: DilatationAverage
    small: bool

    def _ratios(self, f: Array) -> tuple[Array, Array, Array]:
        """J, theta and ``(theta/J)^(1/m)``, (p,); ``nan`` where the material is inverted."""
        J = tensors.determinant(f)
        theta = self.smoothing.mean(J)
        with np.errstate(invalid="ignore", divide="ignore"):
            return J, theta, np.where((J > 0.0) & (theta > 0.0), theta / J, np.nan) ** (1.0 / f.shape[-1])

    def applied(self, H: Array) -> Array:
        """Displacement derivatives (p, m, m) of F_bar from the derivatives H (p, m, m) of the shape functions."""
        if self.small:
            own = np.trace(H, axis1=1, axis2=2) / H.shape[-1]
            return H + (self.smoothing.mean(own) - own)[:, None, None] * np.eye(H.shape[-1])
        f = np.eye(H.shape[-1]) + H
        return self._ratios(f)[2][:, None, None] * f - np.eye(H.shape[-1])

    def returned(self, flux: Array, H: Array) -> Array:
        """Flux (p, m, m) conjugate to H, from the flux conjugate to ``F_bar``."""
        if self.small:
            own = np.trace(flux, axis1=1, axis2=2) / H.shape[-1]
            return flux + (self.smoothing.mean(own) - own)[:, None, None] * np.eye(H.shape[-1])
        f = np.eye(H.shape[-1]) + H
        J, theta, r = self._ratios(f)
        own = r * tensors.double_dot(flux, f) / f.shape[-1]
        return r[:, None, None] * flux + (J * self.smoothing.mean(own / theta) - own)[:, None, None] * _slope(f)

    def matrix(self, pattern: Assembler, moduli: Array, flux: Array, H: Array) -> csc_array:
        """Second derivative (n d, n d) of the energy from moduli (p, m, m, m, m) and flux (p, m, m) at F_bar."""
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
    """Data of the second derivative of the energy.

    Parameters
    ----------
    section, rows
        As for :class:`MeanDilatation`.
    volume
        (p,) reference volume of each point [m^3].
    moduli, flux
        (p, m, m, m, m) moduli and (p, m, m) flux at F_bar [Pa].
    f
        (p, m, m) deformation gradient of the shape functions.
    ratios
        J, theta and ``r = (theta/J)^(1/m)``, (p,) each.
    pressures
        ``own = flux : F_bar/m``, and the average of ``own/theta``, (p,) each.
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
        """Second derivatives of each cell type."""
        out, start = [], 0
        for G in self.rows:
            e, q = G.shape[:2]
            out.append(self._block(G, slice(start, start + e * q)))
            start += e * q
        return out

    def _block(self, G: Array, here: slice) -> "Block":
        """Terms without the derivative of theta."""
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
    """Second derivatives in the elements of one cell type, over x = a d components of their nodes.

    Parameters
    ----------
    cells
        Shape (e, q, a, k) of the rows of the strain operator.
    local
        (p, x, x) second derivative at constant theta.
    mixed, twice
        (p, x) mixed and (p,) second derivative with respect to ln theta.
    slope
        (p, x) derivative of J.
    """

    cells: tuple[int, ...]
    local: Array
    mixed: Array
    twice: Array
    slope: Array

    def shaped(self, stiff: Array) -> Array:
        """Element matrices (e, a, a, d, d) from (e, x, x)."""
        e, a = self.cells[0], self.cells[2]
        d = stiff.shape[-1] // a
        return stiff.reshape(e, a, d, a, d).transpose(0, 1, 3, 2, 4)


def both(x: Array, y: Array) -> Array:
    """Symmetric sum ``x y^T + y x^T`` (..., n, n) of vectors (..., n)."""
    outer = x[..., :, None] * y[..., None, :]
    return np.asarray(outer + np.swapaxes(outer, -1, -2))


def _slope(f: Array) -> Array:
    """Derivative of ln det F with respect to the displacement derivatives, (p, m, m)."""
    finite = np.where(np.isfinite(f), f, np.eye(f.shape[-1]))
    return np.swapaxes(np.linalg.inv(finite), -1, -2)


def _units(section: Section, G: Array) -> Array:
    """Displacement derivatives (e q, a d, m, m) of unit displacements of the nodes."""
    e, q, a, k = G.shape
    d = 2 if isinstance(section, Axisymmetric) else k
    A = np.zeros((e * q, a, d, k, d))
    for j in range(d):
        A[:, :, j, :, j] = G.reshape(e * q, a, k)
    return derivatives(section, A.reshape(e * q, a * d, k, d))
