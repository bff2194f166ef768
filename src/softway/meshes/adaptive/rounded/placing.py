"""Places of the nodes of an adapted mesh with a curved boundary.

A new node lies in the middle of an edge, of a facet or of a cell that has been cut.  On the curved boundary it lies on
the smooth surface, between the nodes around it; inside, in their mean.  So its place depends on the bisections alone.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.rounded.bulges import over_normals, over_tangents
from softway.meshes.topology import Rounding


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Origins:
    """Nodes around each new one.

    Parameters
    ----------
    edges
        (k, 3) a node and the ends of its edge.
    faces
        (k, 5) a node and those in the middle of the edges of its face, in order around.
    cubes
        (k, 7) a node and those in the middle of the faces of its hexahedron.
    """

    edges: IntArray
    faces: IntArray
    cubes: IntArray

    def numbered(self, number: IntArray) -> "Origins":
        """The same with other numbers of the nodes."""
        return Origins(edges=number[self.edges], faces=number[self.faces], cubes=number[self.cubes])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Nodes:
    """Nodes, in arrays that are filled as their places become known.

    They have places, patches, normals, tangents, and the patches ``sides`` (n, 2) of the edge or facet around them.
    """

    points: Array
    patches: IntArray
    normals: Array
    tangents: Array
    sides: IntArray

    def normals_of(self, nodes: IntArray, patch: IntArray) -> Array:
        """Normals (k, a, d) of patches (k,) at nodes (k, a); not a number where unknown."""
        found = self.patches[nodes] == patch[:, None, None]
        slot = found.argmax(axis=2)[..., None]
        normal = np.take_along_axis(self.normals[nodes], slot[..., None], axis=2)[:, :, 0]
        return np.where(found.any(axis=2)[..., None], normal, np.nan)

    def set_edges(self, rows: IntArray) -> None:
        """Place nodes in the middle of edges."""
        node, ends = rows[:, 0], rows[:, 1:]
        x, sides = self.points[ends], self.sides[node]
        self.points[node] = x.mean(axis=1)
        for slot in (0, 1):
            on = sides[:, slot] >= 0
            own, patch = node[on], sides[on, slot]
            middles, normals = over_normals(x[on], self.normals_of(ends[on], patch))
            self.points[own], self.normals[own, slot], self.patches[own, slot] = middles, normals, patch
        crease = sides[:, 1] >= 0
        own = node[crease]
        self.points[own], self.tangents[own] = over_tangents(x[crease], self.tangents[ends[crease]])

    def set_faces(self, rows: IntArray) -> None:
        """Place nodes in the middle of faces, from the nodes in the middle of their edges."""
        node, middles = rows[:, 0], rows[:, 1:]
        self.points[node] = self.points[middles].mean(axis=1)
        on = self.sides[node, 0] >= 0
        own, patch = node[on], self.sides[node[on], 0]
        pairs = (middles[on][:, ::2], middles[on][:, 1::2])
        places, normals = zip(*(over_normals(self.points[p], self.normals_of(p, patch)) for p in pairs), strict=True)
        total = normals[0] + normals[1]
        self.points[own] = 0.5 * (places[0] + places[1])
        self.normals[own, 0] = total / np.linalg.norm(total, axis=1, keepdims=True)
        self.patches[own, 0] = patch


def places(points: Array, rounding: Rounding, carriers: IntArray, origins: Origins) -> Array:
    """Places (n + k, d) of the nodes (n,) of a base mesh and of new ones [m].

    Parameters
    ----------
    points, rounding
        (n, d) nodes of the base mesh, and its smooth surface.
    carriers
        (k, c) corners of the base mesh that each new node lies between, in falling order and filled with -1.
    origins
        Nodes around the new ones.
    """
    n, k, d = len(points), len(carriers), points.shape[1]
    slots = max(2, rounding.patches.shape[1])
    it = _Nodes(
        points=np.concatenate([points, np.zeros((k, d))]),
        patches=np.full((n + k, slots), -1),
        normals=np.full((n + k, slots, d), np.nan),
        tangents=np.concatenate([rounding.tangents, np.full((k, d), np.nan)]),
        sides=np.concatenate([np.full((n, 2), -1), rounding.sides_of(carriers)]),
    )
    own = rounding.patches.shape[1]
    it.patches[:n, :own], it.normals[:n, :own] = rounding.patches, rounding.normals
    known = np.arange(n + k) < n
    while not known.all():
        fresh = known.copy()
        for rows, put in ((origins.edges, it.set_edges), (origins.faces, it.set_faces)):
            ready = _ready(rows, known)
            put(rows[ready])
            fresh[rows[ready, 0]] = True
        ready = _ready(origins.cubes, known)
        it.points[origins.cubes[ready, 0]] = it.points[origins.cubes[ready, 1:]].mean(axis=1)
        fresh[origins.cubes[ready, 0]] = True
        assert fresh.sum() > known.sum(), "a node of an adapted mesh has no origin"
        known = fresh
    return it.points


def _ready(rows: IntArray, known: BoolArray) -> BoolArray:
    """True (k,) for nodes that are not known, but the ones around them are."""
    return np.asarray(~known[rows[:, 0]] & known[rows[:, 1:]].all(axis=1))
