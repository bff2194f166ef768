"""Anderson mixing of the last iterates of a fixed point."""

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.vector_space import LocalSpace, VectorSpace
from softway.tolerances import INDEPENDENT

ONE = LocalSpace(())


class Anderson:
    """Mixing of the last iterates: the combination with the least residual.

    The differences of the last residuals are kept with their Gram matrix: a new one costs one product with each of
    them.  They are scaled to unit length before the small system is solved.

    Parameters
    ----------
    depth
        Number of differences kept; with 0 the value of the map is returned unchanged.
    space
        Inner products of arguments.

    References
    ----------
    Anderson (1965), J. ACM 12, 547-560; Walker, Ni (2011), SIAM J. Numer. Anal. 49, 1715-1735.

    Examples
    --------
    A linear map in two dimensions is solved with three values:

    >>> matrix, mixing, x = np.array([[0.5, 0.2], [0.0, -0.9]]), Anderson(2), np.zeros(2)
    >>> for _ in range(4):
    ...     x = mixing.mix(x, matrix @ x + 1.0)
    >>> bool(np.allclose(x, np.linalg.solve(np.eye(2) - matrix, np.ones(2))))
    True
    """

    __slots__ = ("count", "depth", "gram", "last", "residuals", "space", "values")

    def __init__(self, depth: int, space: VectorSpace = ONE) -> None:
        self.depth, self.count, self.space = depth, 0, space
        self.residuals = self.values = np.empty((depth, 0))
        self.gram = np.empty((depth, depth))
        self.last: tuple[Array, Array] | None = None

    def restart(self) -> None:
        """Forget all iterates."""
        self.count, self.last = 0, None

    def mix(self, x: Array, value: Array) -> Array:
        """Next argument (g,), from an argument ``x`` (f,) of the map and its ``value`` (g,).

        Entries of the value beyond those of ``x`` are mixed with the same weights.
        """
        if self.depth == 0:
            return value
        residual = value[: len(x)] - x
        if self.last is not None:
            self._keep(residual - self.last[0], value - self.last[1])
        self.last = residual, value
        kept = min(self.count, self.depth)
        if kept == 0:
            return value
        return np.asarray(value - self.space.combined(self._weights(residual, kept), self.values[:kept]))

    def _keep(self, residual: Array, value: Array) -> None:
        """Replace the oldest differences."""
        if self.residuals.shape[1] != len(residual):
            self.residuals, self.values = np.empty((self.depth, len(residual))), np.empty((self.depth, len(value)))
        k = self.count % self.depth
        self.residuals[k], self.values[k] = residual, value
        self.count += 1

    def _weights(self, residual: Array, kept: int) -> Array:
        """Weights (kept,) of the differences that minimise the residual, after the last one was kept."""
        k = (self.count - 1) % self.depth
        row, pull = self.space.products_of(self.residuals[:kept].T, (self.residuals[k], residual))
        self.gram[k, :kept] = self.gram[:kept, k] = row
        length = np.sqrt(np.maximum(np.diagonal(self.gram)[:kept], 1e-300))
        unit = self.gram[:kept, :kept] / np.outer(length, length)
        value, vector = np.linalg.eigh(unit)
        independent = value > INDEPENDENT * kept
        projected = vector.T @ (pull / length)
        return np.asarray((vector[:, independent] @ (projected[independent] / value[independent])) / length)
