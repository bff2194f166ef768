"""Contact rows along the surfaces: how a slave slips on its opponent."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.contact.stencils import along
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shear:
    """The tangential parts of contact rows.

    Parameters
    ----------
    weights
        (m, n) one on the slave node, minus the weights of the opponent's nodes; for mortar the means of both.
    tangents
        (m, k, d) orthonormal directions square to the normals, k = d - 1.
    moved
        (m, d) motion of a driven tool over the slab beside the rows [m]; zero for others.
    """

    weights: sp.csr_array
    tangents: Array
    moved: Array

    def gradient(self) -> sp.csr_array:
        """Rows (m k, n d) of the tangential components of a field, relative to the opponent's; row ``r k + j``."""
        m, k, d = self.tangents.shape
        each = [along(self.weights, self.tangents[:, j]) for j in range(k)]
        order = np.arange(m * k).reshape(k, m).T.ravel()
        return sp.csr_array(sp.vstack(each, format="csr")[order]) if m else sp.csr_array((0, self.weights.shape[1] * d))

    def flat(self, vectors: Array) -> Array:
        """Tangential components (m, d - 1) of vectors (m, d)."""
        return np.einsum("mkd,md->mk", self.tangents, vectors)

    def vectors(self, components: Array) -> Array:
        """Vectors (m, d) of tangential components (m, d - 1)."""
        return np.einsum("mkd,mk->md", self.tangents, components)

    def along(self, field: Array) -> Array:
        """Tangential vectors (m, d) of a nodal field (n, d), relative to the opponent's."""
        return self.vectors(self.flat(np.asarray(self.weights @ field)))

    def slip(self, moved: Array) -> Array:
        """Slip (m, d) on the opponent where the nodes move by ``moved`` (n, d) over the slab [m]."""
        return self.vectors(self.flat(np.asarray(self.weights @ moved) - self.moved))

    def spread(self, vectors: Array) -> Array:
        """Nodal forces (n, d) of forces (m, d) of the rows."""
        return np.asarray(self.weights.T @ vectors)


def tangents(normal: Array) -> Array:
    """Orthonormal directions (m, d - 1, d) square to unit normals (m, d), continuous but for one pole.

    Examples
    --------
    >>> tangents(np.array([[0.0, 1.0]])).tolist()
    [[[1.0, 0.0]]]
    >>> tangents(np.array([[0.0, 0.0, 1.0]])).tolist()
    [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]

    References
    ----------
    Duff et al. (2017), Building an orthonormal basis, revisited, JCGT 6.
    """
    m, d = normal.shape
    if d == 1:
        return np.zeros((m, 0, 1))
    if d == 2:
        return np.stack([normal[:, 1], -normal[:, 0]], axis=1)[:, None, :] + 0.0
    x, y, z = normal.T
    sign = np.where(z < 0.0, -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    first = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x], axis=1)
    second = np.stack([b, sign + y * y * a, -y], axis=1)
    return np.stack([first, second], axis=1) + 0.0
