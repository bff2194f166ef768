"""Moments of the mass that a redistribution keeps: all of them if the mesh allows it, else as many as it does.

The mass is that of a density ``f = 1 + alpha + beta . xi + xi . Gamma xi``, linear in as many numbers as there are
moments (docs/theory/bodies/mass.md).
"""

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from softway.arrays import Array, BoolArray

_LOG = logging.getLogger(__name__)

LEAST_FACTOR = 0.1
"""Least density relative to the given one; below it fewer layers, or fewer moments of the mass, are used."""
FLAT = 1e-9
"""Distance of nodes from a plane or a line, relative to the size of the body, below which they lie in it."""
THIN = 0.1
"""Extent of the nodes with mass across a body, relative to that along it, below which the moments across are given up
before those along it."""
SPREAD = "body '%s': too few elements for the mass of its contact nodes: %s; a finer mesh avoids this"
"""Log message about a mass matrix that does not keep all moments."""
MOMENTS, ACROSS, ALL = (
    "the moments of inertia change",
    "the centre of mass moves across the body",
    "only the mass is kept, the centre of mass moves",
)
"""Consequences of a mass matrix that keeps some moments only."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Aim:
    """Moments to keep.

    Parameters
    ----------
    turn
        (d, d) axes of the moments, in columns.
    first, second
        Number of axes, the first ones, along which the centre and the second moments are kept.
    nearly
        Number of axes along which second moments are kept as far as the least density allows; 0 for none.
    lost
        What the body loses, for the log; empty for nothing.
    """

    turn: Array
    first: int
    second: int
    nearly: int = 0
    lost: str = ""

    def factor(self, found: Sequence[Array], kept: tuple[Array, Array], forms: Array) -> Array | None:
        """Coefficients (m,) of the density; None if no density of at least ``LEAST_FACTOR`` keeps the moments.

        Parameters
        ----------
        found
            Moments (m,) of the matrix of each monomial.
        kept
            Moments (m,) to keep: mass and centre of the first, second moments of the other.
        forms
            (m, n) monomials at the nodes.
        """
        table, width = np.array(found).T, _width(forms)
        target = np.where(np.arange(len(forms)) <= width, kept[0], kept[1])
        factor = _solved(table, target, _chosen(width, self.first, self.second))
        if factor is None or (self.first and (factor @ forms).min() < LEAST_FACTOR):
            return None
        better = _solved(table, target, _chosen(width, self.first, self.nearly)) if self.nearly else None
        return factor if better is None else _towards(better, factor, forms)

    def tell(self, name: str) -> None:
        """Log what the body of this name loses."""
        if self.lost:
            _LOG.log(logging.INFO if self.lost == MOMENTS else logging.WARNING, SPREAD, name, self.lost)


def aims(points: Array, heavy: BoolArray) -> list[Aim]:
    """Aims for a body with nodes at ``points`` (n, d), ``heavy`` (n,) of which have mass, the best one first.

    Nodes with mass in a plane or on a line have no second moments across it.  Where they are nearly so, these are given
    up first, and then the centre across, before anything along the body.
    """
    d = points.shape[1]
    centred = points[heavy] - points[heavy].mean(axis=0)
    size, turned = np.zeros(d), np.eye(d)
    _, found, rows = np.linalg.svd(np.linalg.qr(centred, mode="r"))
    size[: len(found)], turned = found, rows.T
    extended = int((size > FLAT * np.linalg.norm(np.ptp(points, axis=0)) * np.sqrt(len(centred))).sum())
    flat, thin = extended < d, d > 1 and size[-1] < THIN * size[0]
    turn, along = turned if flat else np.eye(d), extended if flat else d - 1
    out = [Aim(turn=turn, first=d, second=extended)]
    if thin and not flat:
        out.append(Aim(turn=turned, first=d, second=along))
    if d > 1:
        axes, nearly = (turned, along) if thin else (turn, extended)
        out.append(Aim(turn=axes, first=d, second=0, nearly=nearly, lost=MOMENTS))
    if thin:
        out.append(Aim(turn=turned, first=along, second=along, lost=ACROSS))
        out.append(Aim(turn=turned, first=along, second=0, nearly=along, lost=ACROSS))
    return [*out, Aim(turn=turn, first=0, second=0, lost=ALL)]


def scaled(points: Array, mass: sparse.csr_array) -> Array:
    """Coordinates (n, w) relative to the centre of mass and the size, along the axes in which the body extends."""
    size = np.ptp(points, axis=0)
    wide = size > FLAT * size.max()
    nodal = np.asarray(mass.sum(axis=1)).ravel()
    return np.asarray((points - nodal @ points / nodal.sum())[:, wide] / size[wide])


def monomials(y: Array) -> list[Array]:
    """Nodal values (n,) of the monomials of the coordinates (n, w), up to the second order if there are several.

    Examples
    --------
    >>> len(monomials(np.zeros((4, 1)))), len(monomials(np.zeros((4, 2))))
    (2, 6)
    """
    w = y.shape[1]
    return [np.ones(len(y)), *y.T, *(y[:, i] * y[:, j] for i in range(w) if w > 1 for j in range(i + 1))]


def moments(mass: sparse.csr_array, y: Array) -> Array:
    """Mass, first and second moments (m,) of a mass matrix, in the order of :func:`monomials`."""
    z = np.column_stack([np.ones(len(y)), y])
    table, w = z.T @ (mass @ z), y.shape[1]
    return np.array([*table[0], *(table[1 + i, 1 + j] for i in range(w) if w > 1 for j in range(i + 1))])


def _width(forms: Array) -> int:
    """Number of coordinates of monomials (m, n)."""
    return {2: 1, 6: 2, 10: 3}[len(forms)]


def _chosen(width: int, first: int, second: int) -> list[int]:
    """Numbers of the monomials up to the first order in the first axes, and of second order in others."""
    count = min(second, width) if width > 1 else 0
    return [0, *range(1, 1 + min(first, width)), *range(1 + width, 1 + width + count * (count + 1) // 2)]


def _solved(table: Array, target: Array, chosen: list[int]) -> Array | None:
    """Coefficients (m,) of the ``chosen`` monomials by which the same moments are the ``target``; None if none are."""
    part, goal = table[np.ix_(chosen, chosen)], target[chosen]
    found = np.linalg.lstsq(part, goal, rcond=1e-12)[0]
    if np.abs(part @ found - goal).max() > 1e-9 * goal[0]:
        return None
    out = np.zeros(len(target))
    out[chosen] = found
    return out


def _towards(better: Array, factor: Array, forms: Array) -> Array:
    """Coefficients (m,) on the way from those of a density that is possible to better ones, as far as possible."""
    start, end = factor @ forms, better @ forms
    low = end < LEAST_FACTOR
    share = min(1.0, float(((start[low] - LEAST_FACTOR) / (start[low] - end[low])).min(initial=1.0)))
    return np.asarray(share * better + (1.0 - share) * factor)
