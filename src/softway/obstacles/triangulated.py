"""Rigid obstacles made of facets: triangles in space, segments in the plane."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.kernels.geometry.closest_points import on_segments, on_triangles
from softway.meshes.files.mesh_files import read_facets
from softway.obstacles.facet_tree import FacetTree, facet_tree
from softway.obstacles.half_space import check_length, unit_vectors
from softway.obstacles.orientation import CORNERS, merged, normals_of, oriented, pseudo_normals, rim_of, smooth_normals
from softway.units import Metre

PAIRS = 2_000_000
"""Greatest number of pairs of a point and a facet that are processed together."""
FAR = 1e100
"""Points with greater coordinates [m] have the distance ``nan``."""
ROUNDING = 1e-13
"""Rounding error of positions, as a fraction of the greatest coordinate."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Facets:
    """Surface of flat facets with an exact signed distance.

    Coincident vertices are merged. The normals of a closed surface must point outward; for bodies inside it, use a
    :class:`~softway.obstacles.primitives.Cavity`. An open surface faces the side from which the corners of a triangle
    are anticlockwise (segments: the right-hand side). Points behind it have a negative gap, unless their closest point
    is on the rim: beyond the rim all space is free.

    Parameters
    ----------
    points
        (n, d) vertices [m], d = 2 or 3.
    cells
        (f, d) vertex numbers of the facets.
    smooth
        True for curved facets: the surface has the mean normal of its facets at each vertex. For round bodies without
        sharp edges. The normal is the gradient of the gap on the surface, and approximately so near it.

    Examples
    --------
    >>> corner = Facets(points=np.array([[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]]), cells=np.array([[2, 1], [1, 0]]))
    >>> corner.closed, corner.gap(np.array([[0.2, 0.1], [-3.0, -4.0]])).round(12).tolist()
    (False, [0.1, -5.0])
    """

    points: Array
    cells: IntArray
    smooth: bool = False
    pseudo: Array = field(init=False, repr=False)
    rim: BoolArray = field(init=False, repr=False)
    vertex: Array = field(init=False, repr=False)
    tree: FacetTree = field(init=False, repr=False)

    def __post_init__(self) -> None:
        points, cells = np.array(self.points, dtype=float), np.array(self.cells, dtype=np.int64)
        _check(points, cells)
        points, cells = merged(points, cells)
        if not len(cells):
            raise InputError("cells", "no facet has two different vertices", "facets of a size greater than zero")
        normals = normals_of(points, cells)
        rim, corners = oriented(points, cells), points[cells]
        made = {
            "points": points,
            "cells": cells,
            "pseudo": pseudo_normals(points, cells, normals),
            "vertex": smooth_normals(points, cells, normals),
            "rim": rim_of(cells, rim),
            "tree": facet_tree(corners, normals),
        }
        for name, value in made.items():
            object.__setattr__(self, name, value)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return int(self.points.shape[1])

    @property
    def closed(self) -> bool:
        """True if the surface has no rim."""
        return not bool(self.rim.any())

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative inside."""
        return self.gap_and_normal(x)[0]

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d): the gradient of the distance."""
        return self.gap_and_normal(x)[1]

    def gap_and_normal(self, x: Array) -> tuple[Array, Array]:
        """Gap and normal together, since they share the search for the closest point."""
        if x.shape[-1] != self.dim:
            raise InputError("", f"facets in {self.dim}D for a body in {x.shape[-1]}D", "a shape of that dimension")
        points = x.reshape(-1, self.dim)
        known = (np.abs(points) < FAR).all(axis=1)
        gap, normal = np.full(len(points), np.nan), np.full(points.shape, np.nan)
        if known.any():
            gap[known], normal[known] = self._seen_from(points[known])
        return gap.reshape(x.shape[:-1]), normal.reshape(x.shape)

    def _seen_from(self, x: Array) -> tuple[Array, Array]:
        """Gap (p,) and normal (p, d) at points (p, d)."""
        facet, weights = self.closest(x)
        inner, corners = weights > 0.0, self.points[self.cells[facet]]
        feature = inner @ np.array(CORNERS[self.dim])
        arm, rim = x - np.einsum("pk,pki->pi", weights, corners), self.rim[facet, feature]
        face, pseudo = self.pseudo[facet, -1], self.pseudo[facet, feature]
        above: BoolArray = np.all(inner, axis=1)
        gap, normal = _flat(arm, above, face, np.where(rim[:, None], arm, pseudo), self._rounding)
        if self.smooth:
            gap[~rim], normal[~rim] = _curved(x[~rim], weights[~rim], corners[~rim], self.vertex[facet[~rim]])
        return gap, normal

    def closest(self, x: Array) -> tuple[IntArray, Array]:
        """Nearest facet (p,) of points (p, d), and the weights (p, d) of its corners at the closest point."""
        pairs = self.tree.near(x, self._rounding, PAIRS if len(x) > 1 else np.inf)
        if pairs is None:
            halves = [self.closest(half) for half in np.array_split(x, 2)]
            return np.concatenate([f for f, _ in halves]), np.concatenate([w for _, w in halves])
        point, facet = pairs
        weights, away = self._from(facet, x[point])
        first = np.lexsort((away, point))[np.searchsorted(point, np.arange(len(x)))]
        return facet[first], weights[first]

    def _from(self, facet: IntArray, x: Array) -> tuple[Array, Array]:
        """Weights (p, d) of the closest points of facets (p,) to points (p, d), and the distances (p,) [m]."""
        corners = self.points[self.cells[facet]]
        weights = (on_segments if self.dim == 2 else on_triangles)(x, *np.swapaxes(corners, 0, 1))
        return weights, np.linalg.norm(x - np.einsum("pk,pki->pi", weights, corners), axis=-1)

    @property
    def _rounding(self) -> float:
        return ROUNDING * float(np.abs(self.points).max())


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """Surface of facets from a file; see :class:`Facets`.

    STL, OBJ and PLY files contain surfaces in space. A Gmsh ``.msh`` or VTK ``.vtu`` file may also contain segments in
    a plane z = const, or the cells of a solid or plane body. In this case the facets of its boundary are used.

    Parameters
    ----------
    file
        Path of the file.
    scale
        Length unit of the file [m].
    smooth
        True for facets that are curved according to the mean normals at their vertices.
    """

    file: Path
    scale: Metre = 1.0
    smooth: bool = False
    facets: Facets = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        file = Path(self.file)
        check_length("scale", self.scale)
        try:
            points, cells = read_facets(file, self.scale)
            facets = Facets(points=points, cells=cells, smooth=self.smooth)
        except InputError as error:
            raise InputError("file", error.problem, error.remedy) from None
        object.__setattr__(self, "file", file)
        object.__setattr__(self, "facets", facets)

    @property
    def dim(self) -> int:
        """Dimension of space."""
        return self.facets.dim

    def gap(self, x: Array) -> Array:
        """Signed distance (...,) of points (..., d) [m]; negative inside."""
        return self.facets.gap(x)

    def normal_at(self, x: Array) -> Array:
        """Unit normals (..., d) at points (..., d)."""
        return self.facets.normal_at(x)


def _check(points: Array, cells: IntArray) -> None:
    """Check the arrays of points and facets."""
    if points.ndim != 2 or points.shape[1] not in (2, 3) or not np.isfinite(points).all():
        raise InputError("points", f"array of shape {points.shape}, or not finite", "finite coordinates (n, 2 or 3)")
    d = points.shape[1]
    if cells.ndim != 2 or cells.shape[1] != d or not len(cells):
        raise InputError("cells", f"array of shape {cells.shape} in {d}D", f"at least one facet: (f, {d}) numbers")
    if not 0 <= cells.min() <= cells.max() < len(points):
        raise InputError("cells", f"vertex numbers from {cells.min()} to {cells.max()}", f"0 to {len(points) - 1}")


def _flat(arm: Array, above: BoolArray, face: Array, pseudo: Array, rounding: float) -> tuple[Array, Array]:
    """Gap (p,) and normal (p, d) over flat facets.

    Parameters
    ----------
    arm
        (p, d) from the closest points [m].
    above
        (p,) true where the closest points lie inside the facets, not on their edges.
    face, pseudo
        (p, d) normals of the facets, and pseudo-normals of the closest points.
    rounding
        Error of the positions [m].
    """
    height = np.einsum("pi,pi->p", arm, face)
    above = above | (np.linalg.norm(arm - height[:, None] * face, axis=-1) <= rounding)
    length = np.copysign(np.linalg.norm(arm, axis=-1), np.einsum("pi,pi->p", arm, pseudo))
    normal = np.copysign(1.0, length)[:, None] * unit_vectors(arm)
    return np.where(above, height, length), np.where(above[:, None], face, normal)


def _curved(x: Array, weights: Array, corners: Array, normals: Array) -> tuple[Array, Array]:
    """Gap (p,) and normal (p, d) over facets that are curved by the normals (p, k, d) at their corners (p, k, d).

    The closest point c has the weights w_k of the corners p_k and the mean normal N, the unit vector along
    ``n = sum w_k n_k``. The surface lies ``1/2 sum w_k n_k . (p_k - c)`` above c, half the mean height of the tangent
    planes at the corners. ``phi = N . (x - c) - height`` vanishes on the surface, and ``phi / |grad phi|`` is the
    distance to first order.
    """
    active = weights > 0.0
    middle = np.einsum("pk,pki->pi", active / active.sum(axis=1, keepdims=True), corners)
    offset = active[..., None] * (corners - middle[:, None])
    slope = np.swapaxes(np.linalg.pinv(offset, rcond=1e-8), 1, 2)  # gradient of the weights
    foot = np.einsum("pk,pki->pi", weights, corners)
    arm, lift = x - foot, np.einsum("pki,pki->pk", normals, corners - foot[:, None])
    n = np.einsum("pk,pki->pi", weights, normals)
    length = np.linalg.norm(n, axis=-1, keepdims=True)
    N = n / length
    phi = np.einsum("pi,pi->p", N, arm) - 0.5 * np.einsum("pk,pk->p", weights, lift)
    across = (arm - np.einsum("pi,pi->p", N, arm)[:, None] * N) / length
    along = np.einsum("pki,pi->pk", offset, 0.5 * n - N) + np.einsum("pki,pi->pk", normals, across) - 0.5 * lift
    gradient = N + np.einsum("pk,pki->pi", along, slope)
    size = np.linalg.norm(gradient, axis=-1)
    return phi / size, gradient / size[:, None]
