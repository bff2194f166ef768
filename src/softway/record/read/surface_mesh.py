"""Surface of a deformed body, divided into small flat triangles with interpolated values."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.meshes.adaptive.squares.inner_facets import beside_smaller
from softway.meshes.mesh import Mesh
from softway.record.read.cells import Cells

MOST = 60000
"""Maximum number of small triangles on a surface."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Patches:
    """Facets (f, b) of one kind, with shape functions (p, b) at the points of a lattice and its triangles (t, 3)."""

    facets: IntArray
    shape: Array
    triangles: IntArray

    def spread(self, nodal: Array) -> Array:
        """Corners of all small triangles (f t, 3, ...) from a nodal field (n, ...)."""
        corners = self.lattice(nodal)[:, self.triangles]
        return np.asarray(corners.reshape(-1, 3, *nodal.shape[1:]))

    def lattice(self, nodal: Array) -> Array:
        """A nodal field (n, ...) at the lattice points of the facets (f, p, ...)."""
        return np.asarray(np.einsum("pb,fb...->fp...", self.shape, nodal[self.facets]))

    def numbered(self, first: int) -> IntArray:
        """Small triangles (f t, 3) as numbers of their lattice points, counted from ``first``."""
        facets = np.arange(len(self.facets))[:, None, None] * len(self.shape)
        return np.asarray((first + facets + self.triangles).reshape(-1, 3))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Skin:
    """Visible surface of a mesh in patches: the ``boundary`` of volumes, or the cells of plane bodies."""

    mesh: Mesh
    boundary: Mapping[str, IntArray]
    patches: tuple[Patches, ...]

    def spread(self, nodal: Array) -> Array:
        """Corners of all small triangles (t, 3, ...) from a nodal field (n, ...)."""
        return np.concatenate([patch.spread(nodal) for patch in self.patches])

    def lattice(self, nodal: Array) -> Array:
        """A nodal field (n, ...) at the corner points (k, ...) of the small triangles."""
        return np.concatenate([patch.lattice(nodal).reshape(-1, *nodal.shape[1:]) for patch in self.patches])

    @property
    def triangles(self) -> IntArray:
        """Small triangles (t, 3) as numbers of the points of :meth:`lattice`."""
        counts = [len(patch.facets) * len(patch.shape) for patch in self.patches]
        starts = np.cumsum([0, *counts[:-1]])
        return np.concatenate([patch.numbered(int(s)) for patch, s in zip(self.patches, starts, strict=True)])


def skin_of(cells: Cells, most: int = MOST) -> Skin:
    """Visible surface of all solids together, divided into about ``most`` small triangles."""
    mesh = Mesh(points=cells.reference[:, : cells.dimension], blocks=cells.blocks())
    owner = np.zeros(len(cells.reference), dtype=np.int64)
    owner[cells.connectivity] = np.repeat(cells.body, np.diff(cells.offsets))
    single = mesh.boundary()
    boundary = {name: facets[~beside_smaller(mesh.points, owner, name, facets)] for name, facets in single.items()}
    seen: Mapping[str, IntArray] = boundary if mesh.dim == 3 else mesh.blocks
    count = sum(len(f) for f in seen.values())
    made = tuple(_patches(name, facets, count, most) for name, facets in seen.items() if name in SHAPES)
    return Skin(mesh=mesh, boundary=boundary, patches=made)


def _patches(name: str, facets: IntArray, count: int, most: int) -> Patches:
    flat = name == "tri3"
    k = 1 if flat else int(np.clip(np.sqrt(most / (2.0 * max(count, 1))), 1, 8))
    points, triangles = _triangle(k) if name.startswith("tri") else _square(k)
    return Patches(facets=facets, shape=SHAPES[name](points[:, 0], points[:, 1]), triangles=triangles)


def _triangle(k: int) -> tuple[Array, IntArray]:
    """Lattice points and triangles of the unit triangle, with k small triangles along an edge."""
    number = {(i, j): n for n, (i, j) in enumerate((i, j) for j in range(k + 1) for i in range(k + 1 - j))}
    up = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in number if i + j < k]
    down = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in number if i + j < k - 1]
    return np.array(list(number), float) / k, np.array(up + down)


def _square(k: int) -> tuple[Array, IntArray]:
    """Lattice points and triangles of the unit square, with k small squares along an edge."""
    number = {(i, j): n for n, (i, j) in enumerate((i, j) for j in range(k + 1) for i in range(k + 1))}
    low = [(number[i, j], number[i + 1, j], number[i + 1, j + 1]) for i in range(k) for j in range(k)]
    high = [(number[i, j], number[i + 1, j + 1], number[i, j + 1]) for i in range(k) for j in range(k)]
    return np.array(list(number), float) / k, np.array(low + high)


def _tri3(x: Array, y: Array) -> Array:
    return np.stack([1 - x - y, x, y], axis=-1)


def _tri6(x: Array, y: Array) -> Array:
    z = 1 - x - y
    return np.stack([z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1), 4 * z * x, 4 * x * y, 4 * y * z], axis=-1)


def _quad4(x: Array, y: Array) -> Array:
    return np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=-1)


def _quad9(x: Array, y: Array) -> Array:
    a, b = (np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)]) for t in (x, y))
    pairs = ((0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (1, 2), (2, 1), (0, 2), (2, 2))
    return np.stack([a[i] * b[j] for i, j in pairs], axis=-1)


def _quad8(x: Array, y: Array) -> Array:
    full, bubble = _quad9(x, y)[..., :8], _quad9(x, y)[..., 8:]
    return full + bubble * np.repeat([-0.25, 0.5], 4)


SHAPES: Mapping[str, Callable[[Array, Array], Array]] = {
    "tri3": _tri3,
    "tri6": _tri6,
    "quad4": _quad4,
    "quad8": _quad8,
    "quad9": _quad9,
}


def at_nodes(cells: Cells, values: Array) -> Array:
    """Nodal means (n,) of cell values (e,)."""
    owner = np.repeat(np.arange(len(values)), np.diff(cells.offsets))
    count = np.bincount(cells.connectivity, minlength=len(cells.reference))
    return np.bincount(cells.connectivity, values[owner], len(cells.reference)) / np.maximum(count, 1)


def rigid(reference: Array, points: Array) -> Array:
    """Move the reference points (n, 3) rigidly as close as possible to ``points``, in the sense of least squares.

    If some node does not move at all along an axis, the body is supposed to be supported along that axis: it is then
    not rotated, and shifted only along the other axes.

    Reference: W. Kabsch, Acta Cryst. A32 (1976) 922.
    """
    moved = points - reference
    still = (moved == 0.0).any(axis=0)
    lies = (points == 0.0).all(axis=0)
    if (still & ~lies).any() and moved.any():
        return reference + np.where(still, 0.0, moved.mean(axis=0))
    middle, centre = reference.mean(axis=0), points.mean(axis=0)
    u, _, vt = np.linalg.svd((reference - middle).T @ (points - centre))
    sign = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt)) or 1.0])
    return np.asarray((reference - middle) @ (u @ sign @ vt) + centre)


def exaggeration(size: float, depth: float) -> float:
    """Factor 1, 2 or 5 times a power of ten that makes a deformation of ``depth`` visible on a body of ``size`` [m].

    The factor is 1 if the deformation is large enough to be visible without enlargement.

    Examples
    --------
    >>> exaggeration(1.0, 1e-4), exaggeration(1.0, 0.1)
    (500.0, 1.0)
    """
    if depth <= 1e-14 * size or 0.05 * size / depth < 2.0:
        return 1.0
    wanted = 0.05 * size / depth
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(m for m in (1, 2, 5) if m * power <= wanted * (1 + 1e-9)))
