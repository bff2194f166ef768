"""Mean dilatation: the change of volume of a cell is one number, so that cells of incompressible matter do not lock.

    F_bar = (theta/J)^(1/m) F,        theta = mean of J = det F over the cell (reference volume)

at each point of a cell of m dimensions; the law sees F_bar.  Its stress acts on the nodes by the derivative of F_bar,
so that a stored energy stays one, and the tangent is the exact second derivative (docs/theory/incompressible.md).

References
----------
Nagtegaal, Parks, Rice (1974), Comput. Methods Appl. Mech. Engrg. 4, 153-177; Simo, Taylor, Pister (1985), Comput.
Methods Appl. Mech. Engrg. 51, 177-208; de Souza Neto, Peric, Dutko, Owen (1996), Int. J. Solids Struct. 33, 3277-3296.
"""

from dataclasses import dataclass

import numpy as np

from softway.bodies.section import Axisymmetric, Section, derivatives
from softway.kernels import tensors
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeanDilatation:
    """One dilatation for all the points of a cell; points of a cell follow each other.

    Parameters
    ----------
    starts, cell
        First point of each cell (e,), and the cell of each point (p,).
    volume
        (p,) reference volume of each point [m^3].
    """

    starts: IntArray
    cell: IntArray
    volume: Array

    def _sum(self, values: Array) -> Array:
        """Sums (e, ...) over the points of each cell of values (p, ...) per reference volume."""
        weight = self.volume.reshape(-1, *[1] * (values.ndim - 1))
        return np.add.reduceat(weight * values, self.starts)

    def _ratios(self, f: Array) -> tuple[Array, Array, Array]:
        """J (p,), theta (p,) and ``(theta/J)^(1/m)`` (p,); ``nan`` where matter is inverted."""
        J = tensors.determinant(f)
        theta = (self._sum(J) / self._sum(np.ones_like(J)))[self.cell]
        with np.errstate(invalid="ignore", divide="ignore"):
            return J, theta, np.where((J > 0.0) & (theta > 0.0), theta / J, np.nan) ** (1.0 / f.shape[-1])

    def applied(self, H: Array) -> Array:
        """Displacement derivatives (p, m, m) of F_bar."""
        f = np.eye(H.shape[-1]) + H
        return self._ratios(f)[2][:, None, None] * f - np.eye(H.shape[-1])

    def returned(self, flux: Array, H: Array) -> Array:
        """Flux (p, m, m) on the derivatives H of the shape functions, from that on ``F_bar``."""
        f = np.eye(H.shape[-1]) + H
        J, theta, r = self._ratios(f)
        mean, own = self._pressures(flux, f, r)
        return r[:, None, None] * flux + (J / theta * mean - own)[:, None, None] * _slope(f)

    def _pressures(self, flux: Array, f: Array, r: Array) -> tuple[Array, Array]:
        """Mean (p,) over the cell, and own (p,), of ``flux : F_bar/m``."""
        own = r * tensors.double_dot(flux, f) / f.shape[-1]
        return (self._sum(own) / self._sum(np.ones_like(own)))[self.cell], own

    def cell_matrices(
        self, section: Section, rows: tuple[Array, ...], moduli: Array, flux: Array, H: Array
    ) -> list[Array]:
        """Second derivatives of the energy, a block (e, a, a, d, d) for each kind of cell."""
        out, point, cell = [], 0, 0
        for G in rows:
            e, q, _, _ = G.shape
            here = slice(point, point + e * q)
            part = MeanDilatation(
                starts=self.starts[cell : cell + e] - point, cell=self.cell[here] - cell, volume=self.volume[here]
            )
            out.append(part._block(section, G, moduli[here], flux[here], H[here]))
            point, cell = point + e * q, cell + e
        return out

    def _block(self, section: Section, G: Array, moduli: Array, flux: Array, H: Array) -> Array:
        e, q, a, _ = G.shape
        f = np.eye(H.shape[-1]) + H
        m, (J, theta, r), V = f.shape[-1], self._ratios(f), self.volume
        B = _units(section, G)
        d = B.shape[1] // a
        lnJ = np.einsum("pxJi,pJi->px", B, _slope(f))
        lntheta = (self._sum(J[:, None] * lnJ) / self._sum(J)[:, None])[self.cell]
        c = (lntheta - lnJ) / m
        bar = r[:, None, None, None] * (B + c[:, :, None, None] * f[:, None])
        mean, own = self._pressures(flux, f, r)
        n = a * d
        flat = bar.reshape(e * q, n, m * m)
        stiff = (flat * V[:, None, None]) @ moduli.reshape(e * q, m * m, m * m) @ np.swapaxes(flat, 1, 2)
        pull = (r * V)[:, None] * np.einsum("pxJi,pJi->px", B, flux)
        cross = c[:, :, None] * pull[:, None, :]
        stiff += cross + np.swapaxes(cross, 1, 2) + (m * own * V)[:, None, None] * _square(c)
        weight = V * (mean * J / theta - own)
        L = np.einsum("pJi,pxJk->pxik", _slope(f), B)
        turned = np.swapaxes(L, 2, 3).reshape(e * q, n, m * m)
        stiff -= weight[:, None, None] * (L.reshape(e * q, n, m * m) @ np.swapaxes(turned, 1, 2))
        stiff += (V * mean * J / theta)[:, None, None] * _square(lnJ) - (V * mean)[:, None, None] * _square(lntheta)
        return stiff.reshape(e, q, n, n).sum(axis=1).reshape(e, a, d, a, d).transpose(0, 1, 3, 2, 4)


def mean_dilatation(rows: tuple[Array, ...], volume: Array) -> MeanDilatation:
    """The :class:`MeanDilatation` of cells with the sampling ``rows`` (e, q, a, k)."""
    points = np.concatenate([np.full(len(G), G.shape[1]) for G in rows])
    return MeanDilatation(
        starts=np.cumsum(points) - points, cell=np.repeat(np.arange(len(points)), points), volume=volume
    )


def _slope(f: Array) -> Array:
    """Derivative of ln det F to the displacement derivatives, (p, m, m)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        finite = np.where(np.isfinite(f), f, np.eye(f.shape[-1]))
        return np.swapaxes(np.linalg.inv(finite), -1, -2)


def _square(x: Array) -> Array:
    return x[:, :, None] * x[:, None, :]


def _units(section: Section, G: Array) -> Array:
    """Derivatives (e q, a d, m, m) that unit displacements of the nodes make."""
    e, q, a, k = G.shape
    d = 2 if isinstance(section, Axisymmetric) else k
    A = np.zeros((e * q, a, d, k, d))
    for j in range(d):
        A[:, :, j, :, j] = G.reshape(e * q, a, k)
    return derivatives(section, A.reshape(e * q, a * d, k, d))
