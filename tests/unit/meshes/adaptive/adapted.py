"""Base meshes, wanted levels and measures for the tests of adapted meshes."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import Delaunay

from softway.arrays import Array, IntArray
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.element import element, exact_degree
from softway.meshes.generators.shapes import ball, box, disc, interval, rectangle
from softway.meshes.mesh import Mesh


def irregular(dim: int, points: int, seed: int) -> Mesh:
    """Unstructured triangles or tetrahedra of random points, without flat ones."""
    rng = np.random.default_rng(seed)
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * dim)).reshape(dim, -1).T
    places = np.concatenate([corners, rng.uniform(0.1, 0.9, (points, dim))])
    cells = Delaunay(places).simplices.astype(np.int64)
    legs = places[cells[:, 1:]] - places[cells[:, :1]]
    volume = np.linalg.det(legs)
    cells[volume < 0.0, -2:] = cells[volume < 0.0, :-3:-1]
    return Mesh(points=places, blocks={{2: "tri3", 3: "tet4"}[dim]: cells})


def warped(mesh: Mesh, seed: int) -> Mesh:
    """The mesh with its nodes moved, so that faces are no longer flat."""
    rng = np.random.default_rng(seed)
    return replace(mesh, points=mesh.points + rng.uniform(-0.1, 0.1, mesh.points.shape) * mesh.edge())


BASES: Mapping[str, Callable[[], Mesh]] = {
    "bar2": lambda: interval(1.0, cells=3),
    "bar3": lambda: interval(2.0, cells=3, cell="bar3", direction=(1.0, 1.0)),
    "tri3": lambda: rectangle((1.0, 0.7), (4, 3), cell="tri3"),
    "tri3 irregular": lambda: irregular(2, 30, 1),
    "tri6": lambda: rectangle((1.0, 0.7), (3, 3), cell="tri6"),
    "tri6 curved": lambda: disc(1.0, 4, cell="tri6"),
    "tet4": lambda: box((1.0, 0.8, 0.6), (2, 2, 2), cell="tet4"),
    "tet4 irregular": lambda: irregular(3, 12, 2),
    "tet10": lambda: box((1.0, 0.8, 0.6), (2, 1, 1), cell="tet10"),
    "tet10 curved": lambda: ball(1.0, 2, cell="tet10"),
    "quad4": lambda: rectangle((1.0, 0.7), (4, 3), cell="quad4"),
    "quad4 irregular": lambda: disc(1.0, 4, cell="quad4"),
    "hex8": lambda: box((1.0, 0.8, 0.6), (3, 2, 2), cell="hex8"),
    "quad8": lambda: rectangle((1.0, 0.7), (3, 3), cell="quad8"),
    "quad9 curved": lambda: disc(1.0, 4, cell="quad9"),
    "hex20": lambda: box((1.0, 0.8, 0.6), (2, 1, 2), cell="hex20"),
    "hex27 curved": lambda: warped(box((1.0, 0.8, 0.6), (2, 1, 2), cell="hex27"), 3),
    "hex8 curved": lambda: warped(box((1.0, 0.8, 0.6), (3, 2, 2), cell="hex8"), 3),
}
"""Base meshes by name."""
CONFORMING = [name for name in BASES if name[:3] not in ("qua", "hex")]
"""Those whose refinements have no hanging nodes."""
HANGING = [name for name in BASES if name not in CONFORMING]
"""Those whose refinements have hanging nodes."""


def some_levels(count: int, seed: int, greatest: int = 6) -> IntArray:
    """Random levels, two thirds of them zero."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, greatest + 1, count) * (rng.integers(0, 3, count) == 0)


def adapted(name: str, seed: int, greatest: int = 6) -> AdaptedMesh:
    """Random refinement of a base mesh."""
    base = BASES[name]()
    return refined(base, some_levels(base.n_cells, seed, greatest))


def cells_of(mesh: Mesh) -> IntArray:
    """Nodes (e, a) of the cells of a mesh of one type."""
    return next(iter(mesh.blocks.values()))


def follow(mesh: Mesh) -> sp.csr_array:
    """Values (n, n) at all nodes from those that do not hang."""
    count = mesh.n_nodes
    return sp.csr_array(sp.eye_array(count)) if mesh.hanging is None else mesh.hanging.follow(count)


def integrals(mesh: Mesh) -> Array:
    """Measure (e,) of each cell, by a quadrature that is exact for curved ones."""
    (name, cells) = next(iter(mesh.blocks.items()))
    table = element(name, exact_degree(name, curved=True))
    jacobian = np.einsum("eai,qar->eqir", mesh.points[cells], table.dN)
    gram = np.einsum("eqir,eqis->eqrs", jacobian, jacobian)
    return np.sqrt(np.linalg.det(gram)) @ table.weights


def masses(mesh: Mesh) -> Array:
    """Element matrices (e, a, a) of the integral of N_a N_b, also in curved cells."""
    (name, cells) = next(iter(mesh.blocks.items()))
    table = element(name, exact_degree(name, curved=True))
    jacobian = np.einsum("eai,qar->eqir", mesh.points[cells], table.dN)
    gram = np.einsum("eqir,eqis->eqrs", jacobian, jacobian)
    return np.einsum("eq,qa,qb->eab", np.sqrt(np.linalg.det(gram)) * table.weights, table.N, table.N)


def surface_measure(mesh: Mesh) -> float:
    """Length or area of a boundary of straight facets."""
    total = 0.0
    for name, facets in mesh.boundary().items():
        table = element(name)
        jacobian = np.einsum("eai,qar->eqir", mesh.points[facets], table.dN)
        gram = np.einsum("eqir,eqis->eqrs", jacobian, jacobian)
        total += float((np.sqrt(np.linalg.det(gram)) @ table.weights).sum())
    return total


def facet_counts(mesh: Mesh) -> IntArray:
    """Number (f,) of cells at each facet."""
    (name, cells) = next(iter(mesh.blocks.items()))
    rows = [np.sort(cells[:, local[: CELLS[kind].corners]], axis=1) for kind, local in FACETS[name]]
    return np.unique(np.concatenate(rows), axis=0, return_counts=True)[1]


def euler(mesh: Mesh) -> int:
    """Euler's characteristic: corners - edges + faces - cells; 1 for a ball in any dimension."""
    (name, cells) = next(iter(mesh.blocks.items()))
    corners = len(np.unique(cells[:, : CELLS[name].corners]))
    facets = len(facet_counts(mesh))
    match CELLS[name].dim:
        case 1:
            return corners - len(cells)
        case 2:
            return corners - facets + len(cells)
        case _:
            return corners - len(mesh.edge_ends()) + facets - len(cells)


def shapes(mesh: Mesh) -> Array:
    """Edge lengths (e, k) of each cell in rising order, relative to the longest: equal for similar triangles."""
    (name, cells) = next(iter(mesh.blocks.items()))
    ends = mesh.points[cells[:, np.array(CELLS[name].edges)]]
    length = np.sort(np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2), axis=1)
    return length / length[:, -1:]
