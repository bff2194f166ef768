"""Places of the nodes inside a mesh from those on its boundary, without folded cells."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.adaptivity.rezoning.quality import corner_simplices
from softway.arrays import Array, IntArray
from softway.meshes.cells import CELLS

ROUNDS = 60
"""Greatest number of corrections."""
CONVERGED = 1e-5
"""Relative decrease of the distortion below which it counts as least."""
TRIES = 24
"""Greatest number of shares in which the boundary moves."""
SHORTEST = 2.0**-10
"""Least share of a correction, or of the motion of the boundary, that is tried."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Distortion:
    """Distortion of the cells of a mesh from ideal ones, ``sum w |F|^2 / (d det(F)^(2/d))``.

    F maps the simplices at the corners of the ideal cells to those of the cells.  The distortion is least, the sum of
    w, where all cells are similar to the ideal ones, and infinite where one is degenerate.

    Parameters
    ----------
    simplices
        (k, d + 1) nodes of the simplices.
    gradients
        (k, d + 1, d) gradients of their barycentric coordinates in the ideal cells.
    weights
        (k,) shares w.
    """

    simplices: IntArray
    gradients: Array
    weights: Array

    def map(self, places: Array) -> Array:
        """Gradients F (k, d, d) at the places (n, d)."""
        return np.einsum("kai,kaj->kij", places[self.simplices], self.gradients)

    def value(self, places: Array) -> float:
        """Distortion; infinite with a degenerate cell."""
        F = self.map(places)
        det, d = np.linalg.det(F), F.shape[1]
        if not (det > 0.0).all():
            return float("inf")
        return float(self.weights @ ((F * F).sum(axis=(1, 2)) / (d * det ** (2.0 / d))))

    def values(self, places: Array) -> Array:
        """Distortions (k,) of the simplices; infinite if degenerate."""
        F = self.map(places)
        det, d = np.linalg.det(F), F.shape[1]
        safe = np.where(det > 0.0, det, np.inf)
        return np.where(det > 0.0, (F * F).sum(axis=(1, 2)) / (d * safe ** (2.0 / d)), np.inf)

    def slope(self, places: Array) -> Array:
        """Derivative (n, d) by the places of the nodes."""
        F = self.map(places)
        det, d = np.linalg.det(F), F.shape[1]
        value = (F * F).sum(axis=(1, 2)) / (d * det ** (2.0 / d))
        inverse = np.swapaxes(np.linalg.inv(F), 1, 2)
        stress = 2.0 / d * (F / det[:, None, None] ** (2.0 / d) - value[:, None, None] * inverse)
        local = np.einsum("k,kij,kaj->kai", self.weights, stress, self.gradients)
        out = np.zeros_like(places)
        np.add.at(out, self.simplices, local)
        return out

    def laplacian(self, n: int) -> sp.csc_array:
        """Matrix (n, n) of ``sum w |F|^2 2/d``, component by component."""
        d = self.gradients.shape[2]
        local = 2.0 / d * np.einsum("k,kai,kbi->kab", self.weights, self.gradients, self.gradients)
        a = d + 1
        rows, columns = np.repeat(self.simplices, a, axis=1).ravel(), np.tile(self.simplices, (1, a)).ravel()
        return sp.csc_array(sp.coo_array((local.ravel(), (rows, columns)), shape=(n, n)))


def ideal_places(base: Array, places: Array) -> Array:
    """Places (n, d) that the affine motion nearest to the one from ``base`` (n, d) to ``places`` gives the nodes."""
    centre = base.mean(axis=0)
    gradient = np.linalg.lstsq(base - centre, places - places.mean(axis=0), rcond=None)[0]
    return np.asarray((base - centre) @ gradient)


def distortion(blocks: Mapping[str, IntArray], ideal: Array) -> Distortion:
    """Distortion from the cells that nodes at the places ``ideal`` (n, d) have; by corners alone.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> cells = {"quad4": np.array([[0, 1, 2, 3]])}
    >>> found = distortion(cells, square)
    >>> round(found.value(square), 12), round(found.value(square * [2.0, 1.0]), 12)
    (1.0, 1.25)
    """
    simplices = np.concatenate([cells[:, corner_simplices(cell)].reshape(-1, CELLS[cell].dim + 1)
                                for cell, cells in blocks.items()])  # fmt: skip
    x = ideal[simplices]
    edges = x[:, 1:] - x[:, :1]
    rows = np.swapaxes(np.linalg.inv(edges), 1, 2)
    gradients = np.concatenate([-rows.sum(axis=1, keepdims=True), rows], axis=1)
    size = np.linalg.det(edges)
    return Distortion(simplices=simplices, gradients=gradients, weights=size / size.sum())


def moved(found: Distortion, places: Array, boundary: IntArray, targets: Array) -> Array | None:
    """Places (n, d) with the boundary nodes (b,) at their targets (b, d) and least distortion inside.

    The boundary moves in shares that fold no cell, and the nodes inside follow each of them by the harmonic extension
    and a descent of the distortion in its metric.  If a cell is folded at the start, all follow at once.  None if a
    cell folds whatever the share.

    Parameters
    ----------
    found
        Distortion.
    places
        (n, d) places of the nodes [m].
    boundary, targets
        (b,) nodes of the boundary, and their new places (b, d) [m].

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((1.0, 1.0), cells=(4, 4))
    >>> rim = mesh.nodes("surface")
    >>> new = moved(distortion(mesh.blocks, mesh.points), mesh.points, rim, mesh.points[rim] * [2.0, 0.5])
    >>> bool(abs(new - mesh.points * [2.0, 0.5]).max() < 1e-12)
    True
    """
    corners = np.unique(found.simplices)
    free = np.zeros(len(places), dtype=bool)
    free[corners] = True
    free[boundary] = False
    inside, rim = np.flatnonzero(free), np.intersect1d(boundary, corners)
    matrix = found.laplacian(len(places))
    solve = splu(sp.csc_array(matrix[inside][:, inside])).solve if len(inside) else np.array
    coupling = matrix[inside][:, rim]
    goal = np.array(places)
    goal[boundary] = targets
    now, share = np.array(places), 1.0
    if not np.isfinite(found.value(now)):
        now = np.array(goal)
        now[inside] = -solve(np.asarray(coupling @ goal[rim]))
        return _relaxed(found, now, inside, solve) if np.isfinite(found.value(now)) else None
    for _ in range(TRIES):
        way = goal[rim] - now[rim]
        if not way.any():
            now[boundary] = targets  # nodes in the middles of edges, too
            return _relaxed(found, now, inside, solve)
        step = np.zeros_like(now)
        step[rim] = way
        step[inside] = -solve(np.asarray(coupling @ way))
        while not np.isfinite(found.value(_along(now, step, share, rim, goal))):
            share *= 0.5
            if share < SHORTEST:
                return None
        now = _along(now, step, share, rim, goal)
        if share < 1.0:
            now = _relaxed(found, now, inside, solve)
        share = min(1.0, 2.0 * share)
    return None


def _along(now: Array, step: Array, share: float, rim: IntArray, goal: Array) -> Array:
    """Places after a share of a step; the rim exactly at its goal after a whole one."""
    out = now + share * step
    if share >= 1.0:
        out[rim] = goal[rim]
    return np.asarray(out)


def slid_along(found: Distortion, places: Array, inside: IntArray, nodes: IntArray, ways: Array) -> Array:
    """Places (n, d) with less distortion, with the nodes (k,) moved in directions given by projections ``ways``
    (k, d, d), and those ``inside`` (m,) in any.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> mesh = rectangle((2.0, 1.0), cells=(2, 1))
    >>> found, shifted = distortion(mesh.blocks, mesh.points), mesh.points + 0.3 * (mesh.points[:, :1] == 1.0) * [1, 0]
    >>> middle = np.flatnonzero(mesh.points[:, 0] == 1.0)
    >>> none, ways = np.zeros(0, dtype=np.int64), np.tile(np.diag([1.0, 0.0]), (2, 1, 1))
    >>> bool(abs(slid_along(found, shifted, none, middle, ways) - mesh.points).max() < 0.01)
    True
    """
    free = np.concatenate([inside, nodes])
    if not len(free):
        return places
    solve = splu(sp.csc_array(found.laplacian(len(places))[free][:, free])).solve
    whole = np.concatenate([np.tile(np.eye(places.shape[1]), (len(inside), 1, 1)), ways])

    def along(values: Array) -> Array:
        return np.einsum("kij,kj->ki", whole, values)

    return _relaxed(found, places, free, lambda slope: along(solve(along(slope))))


def _relaxed(found: Distortion, places: Array, inside: IntArray, solve: Callable[[Array], Array]) -> Array:
    """Places with least distortion for nodes on the boundary that stay."""
    now, value = places, found.value(places)
    if not len(inside) or not np.isfinite(value):
        return now
    for _ in range(ROUNDS):
        slope = found.slope(now)[inside]
        step = np.zeros_like(now)
        step[inside] = -solve(slope)
        fall, share = -float((slope * step[inside]).sum()), 1.0
        while (tried := found.value(now + share * step)) > value - 0.1 * share * fall and share > SHORTEST:
            share *= 0.5
        if tried >= value:
            break
        now, done = now + share * step, value - tried < CONVERGED * value
        value = tried
        if done:
            break
    return np.asarray(now)
