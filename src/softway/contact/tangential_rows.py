"""Tangential parts of contact rows: slip of the slave nodes on the opponent."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.contact.stencils import normal_component


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TangentialRows:
    """Tangential parts of contact rows.

    Parameters
    ----------
    weights
        (m, n) one on the slave node, minus the weights of the opponent's nodes; for mortar the mean weights of both.
    tangents
        (m, k, d) orthonormal directions orthogonal to the normals, k = d - 1; k = 0 without friction.
    moved
        (m, d) motion of a driven tool over the slab at the rows [m]; zero for other opponents.
    """

    weights: sp.csr_array
    tangents: Array
    moved: Array

    @classmethod
    def none(cls, m: int, n: int, d: int) -> "TangentialRows":
        """Tangential parts of m frictionless rows on n nodes: no directions."""
        return cls(weights=sp.csr_array((m, n)), tangents=np.zeros((m, 0, d)), moved=np.zeros((m, d)))

    @property
    def count(self) -> int:
        """Number of rows that may stick or slip: m, or 0 without friction."""
        m, k, _ = self.tangents.shape
        return m if k else 0

    def components(self, multipliers: Array) -> Array:
        """Tangential components (m, k) of a vector of multipliers (m k,)."""
        return multipliers.reshape(self.tangents.shape[:2])

    def gradient(self) -> sp.csr_array:
        """Rows (m k, n d) of the tangential components of a field, relative to the opponent's; row ``r k + j``."""
        m, k, d = self.tangents.shape
        if not self.count:
            return sp.csr_array((0, self.weights.shape[1] * d))
        weights = self.weights if k == 1 else self.weights[np.repeat(np.arange(m), k)]
        return normal_component(weights, self.tangents.reshape(m * k, d))

    def flat(self, vectors: Array) -> Array:
        """Tangential components (m, k) of vectors (m, d)."""
        return np.einsum("mkd,md->mk", self.tangents, vectors)

    def vectors(self, components: Array) -> Array:
        """Vectors (m, d) of tangential components (m, k)."""
        if not self.count:
            return np.zeros((len(components), self.tangents.shape[2]))
        return np.einsum("mkd,mk->md", self.tangents, components)

    def tangential(self, field: Array) -> Array:
        """Tangential vectors (m, d) of a nodal field (n, d), relative to the opponent's."""
        return self.vectors(self.flat(np.asarray(self.weights @ field)))

    def slip(self, moved: Array) -> Array:
        """Slip (m, d) on the opponent where the nodes move by ``moved`` (n, d) over the slab [m]."""
        return self.vectors(self.flat(np.asarray(self.weights @ moved) - self.moved))

    def spread(self, vectors: Array) -> Array:
        """Nodal forces (n, d) of forces (m, d) of the rows."""
        if not self.count:
            return np.zeros((self.weights.shape[1], self.tangents.shape[2]))
        return np.asarray(self.weights.T @ vectors)


def tangents(normal: Array) -> Array:
    """Orthonormal directions (m, d - 1, d) orthogonal to unit normals (m, d), continuous except at one pole.

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
