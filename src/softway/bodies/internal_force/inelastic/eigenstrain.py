"""Laws with a history that see the strain less a free strain, in bodies with free faces.

A law whose stress is limited has to know the strain that the material would have without stress, its *eigenstrain*: the
stress that it limits is that of the difference.  The force of a body is that of this stress and of ``k`` times the
eigenstrain along the axes of the body, so that the elastic part is that of the whole strain; the field that causes the
free strain ``e`` takes ``k e`` off (docs/theory/heat/coupling.md).
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.elasticity.free_faces import condensed
from softway.laws.law import Material, Response, initial_moduli


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Relief:
    """Eigenstrains and deformation of a slab of points p in a body of m axes.

    Parameters
    ----------
    moduli
        Moduli for a free strain.
    before, after
        (p,) eigenstrains at both ends.
    dilations
        Changes of volume (p,) along the m axes at both ends, see :func:`dilation`.
    lateral
        (p, 3 - m) stretches across them at the start.
    """

    moduli: "FreeStrainModuli"
    before: Array
    after: Array
    dilations: tuple[Array, Array]
    lateral: Array

    def strain(self, strain: Array, lateral: Array) -> Array:
        """Strain increment (p, 3, 3) with the logarithms of the stretches across the body and of its volume along it.

        Parameters
        ----------
        strain
            (p, 3, 3) strain increment with the same change of volume in all.
        lateral
            (p, 3 - m) stretches at the end.
        """
        m, out = self.moduli.axes, strain.copy()
        inside, across = np.arange(m), np.arange(m, 3)
        missing = (self.dilations[1] - self.dilations[0]) - np.einsum("pii->p", strain[:, :m, :m])
        out[:, inside, inside] += (missing / m)[:, None]
        out[:, across, across] = np.log(lateral / self.lateral)
        return out

    def elastic(self, strain: Array) -> Array:
        """Strain increment (p, 3, 3) less the change of the eigenstrain."""
        return strain - (self.after - self.before)[:, None, None] * tensors.IDENTITY

    def accounted(
        self, response: Response, strain: Array, mean: Array, ends: tuple[Array, Array], factor: Array | float = 1.0
    ) -> Response:
        """Response of a law with the energies of the strain, of which it has seen the elastic part.

        Stored and dissipated energy are the work of the ``mean`` stress on the strain along the m axes, and a rest of
        higher order, the error of the law's integration.  The part of it that the eigenstrain causes is taken off the
        dissipation, so that a body at rest does no work.  Stored energy is that of the elastic strain without the
        eigenstrain.

        Parameters
        ----------
        response
            Response to the elastic part of the strain.
        strain
            (p, 3, 3) strain increment.
        mean
            (p, 3, 3) mean stress of the slab [Pa].
        ends
            Stretches (p, 3 - m) across the body at the end, and volume ratios (p,) in the middle.
        factor
            Mean factor (p,) of the moduli; stress and stored energy are those of a factor of one.
        """
        m, change, (lateral, ratio) = self.moduli.axes, self.after - self.before, ends
        s, e = mean[:, :m, :m], strain[:, :m, :m]
        work, size, square = tensors.double_dot(s, e), tensors.double_dot(e, e), change * change
        rest = factor * (response.stored - work + np.einsum("pii->p", s) * change) + response.dissipated
        moves = size / np.where(square + size > 0.0, square + size, 1.0)
        dissipated = response.dissipated - np.minimum((1.0 - moves) * rest, response.dissipated)
        held0 = self.moduli.energy(self.dilations[0], self.lateral, self.before)
        held1 = self.moduli.energy(self.dilations[1], lateral, self.after)
        taken = 0.5 * (self.before + self.after) * (held1 - held0) / ratio
        return replace(response, stored=work + (moves * rest - dissipated) / factor + taken, dissipated=dissipated)


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeStrainModuli:
    """Moduli of an isotropic law for a free strain, in a body of m axes with free faces across them.

    Parameters
    ----------
    volume
        Pressure that a free strain takes where all axes are held, 3 kappa [Pa].
    held
        Stress that it takes along each of the m axes where these are held, k [Pa].
    axes
        Number m.

    Examples
    --------
    >>> from softway.laws.bulk import Hypoelastic
    >>> bar = free_strain_moduli(Hypoelastic(E=1.0, nu=0.25), (1, 2))
    >>> round(bar.volume, 12), round(bar.held, 12), bar.axes
    (2.0, 1.0, 1)
    """

    volume: float
    held: float
    axes: int

    def energy(self, dilation: Array, lateral: Array, eigenstrain: Array) -> Array:
        """Energy per volume (p,) that a free strain of one takes from the elastic strain along the m axes [J/m^3].

        Parameters
        ----------
        dilation
            (p,) change of volume along the m axes, see :func:`dilation`.
        lateral
            (p, 3 - m) stretches across them.
        eigenstrain
            (p,) free strain that the law knows.
        """
        whole = dilation + np.log(lateral).sum(axis=1)
        return self.volume * (whole - 3.0 * eigenstrain) + (self.axes * self.held) * eigenstrain


def free_strain_moduli(law: Material, free: tuple[int, ...]) -> FreeStrainModuli:
    """Moduli of a law for a free strain where the faces across the axes ``free`` are free; of an isotropic law."""
    moduli, axes = initial_moduli(law), 3 - len(free)
    held = float(np.einsum("ijkk->ij", condensed(moduli, axes, free))[0, 0])
    return FreeStrainModuli(volume=float(np.einsum("iijj", moduli)) / 3.0, held=held, axes=axes)


def dilation(H: Array, g: Array) -> tuple[Array, Array]:
    """Change of volume ln J (p,) along m axes, and its derivative (p, m, D) by the displacement derivatives.

    It is half the logarithm of det C = 1 + tr + minors of C - 1: a body at rest has all digits of a small one.

    Parameters
    ----------
    H, g
        (p, m, D) displacement derivatives, and (p, m, D) or (1, m, D) reference directions.

    Examples
    --------
    >>> change, flux = dilation(np.array([[[0.25]]]), np.array([[[1.0]]]))
    >>> round(float(change[0]), 12) == round(float(np.log(1.25)), 12), float(flux[0, 0, 0])
    (True, 0.8)
    """
    f, more = g + H, 2.0 * tensors.symmetric(H @ np.swapaxes(g, -1, -2)) + H @ np.swapaxes(H, -1, -2)
    trace = np.einsum("pii->p", more)
    change = trace + 0.5 * (trace * trace - tensors.double_dot(more, more))
    with np.errstate(invalid="ignore", divide="ignore"):
        if f.shape[-2] == 1:
            return 0.5 * np.log1p(change), f / tensors.double_dot(f, f)[:, None, None]
        change = change + (tensors.determinant(more) if f.shape[-2] == 3 else 0.0)
        inverted = tensors.determinant(f) <= 0.0
        return 0.5 * np.log1p(np.where(inverted, np.nan, change)), _inverse_transposed(f)


def unstressed(C: Array, free: tuple[int, ...]) -> Array:
    """Moduli (p, 3, 3, 3, 3) at zero stress on the free axes."""
    if not free:
        return C
    axes = np.array(free)
    stiff = C[:, axes, axes][:, :, axes, axes]
    right = C[:, axes, axes].reshape(len(C), len(axes), 9)
    left = np.moveaxis(C[..., axes, axes], -1, 1).reshape(len(C), len(axes), 9)
    follow = np.linalg.solve(stiff, right)
    return C - np.einsum("pkx,pky->pxy", left, follow).reshape(C.shape)


def _inverse_transposed(f: Array) -> Array:
    """Transposed inverse of (p, m, m) with m = 2, 3; not a number where there is none."""
    cofactor = np.empty_like(f)
    if f.shape[-1] == 2:
        cofactor[:, 0, 0], cofactor[:, 0, 1] = f[:, 1, 1], -f[:, 1, 0]
        cofactor[:, 1, 0], cofactor[:, 1, 1] = -f[:, 0, 1], f[:, 0, 0]
    else:
        for k in range(3):
            cofactor[:, k] = np.cross(f[:, k - 2], f[:, k - 1])
    cofactor /= tensors.determinant(f)[:, None, None]
    return cofactor
