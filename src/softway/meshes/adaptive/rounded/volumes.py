"""Moments of cells, and what share of the body each leaf of a curved base cell stands for."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.geometry.jacobians import determinants
from softway.meshes.cells import CELLS
from softway.meshes.element import element, exact_degree
from softway.meshes.mesh import Mesh


def stretches(points: Array, name: str, cells: IntArray) -> Array:
    """Determinants (e, q) of the maps from the reference cell at its quadrature points."""
    table = element(name, exact_degree(name, curved=True))
    return determinants(np.einsum("eai,qar->eqir", points[cells], table.dN, optimize=True))


def cell_moments(places: Array, name: str, radial: Array | None = None) -> Array:
    """Integrals (e, 1 + d, 1 + d) over cells of products of ``1, x``; times a ``radial`` distance where it is given.

    Parameters
    ----------
    places
        (e, a, d) nodes of the cells [m].
    name
        Name of the cells.
    radial
        (e, a) distances of the nodes from the axis of revolution [m]; None without.

    Examples
    --------
    >>> square = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]])
    >>> cell_moments(square, "quad4")[0, 0].round(12).tolist()
    [2.0, 2.0, 1.0]
    """
    table = element(name, exact_degree(name, curved=True) + CELLS[name].dim)
    weights = table.weights * determinants(np.einsum("eai,qar->eqir", places, table.dN, optimize=True))
    if radial is not None:
        weights = weights * (radial @ table.N.T)
    x = np.einsum("qa,eai->eqi", table.N, places)
    terms = np.concatenate([np.ones((*x.shape[:2], 1)), x], axis=2)
    return np.einsum("eq,eqi,eqj->eij", weights, terms, terms, optimize=True)


def moments_by_root(base: Mesh, points: Array, nodes: IntArray, root: IntArray, radial: bool) -> Array:
    """Sums (r, 1 + d, 1 + d) over the leaves of each base cell of their moments about its first node, in its size."""
    name = next(iter(base.blocks))
    distance = points[nodes, 0] if radial else None
    own = cell_moments(local_places(base, points, nodes, root), name, distance)
    total = np.zeros((base.n_cells, *own.shape[1:]))
    np.add.at(total, root, own)
    return total


def local_places(base: Mesh, points: Array, nodes: IntArray, root: IntArray) -> Array:
    """Places (e, a, d) of the nodes of leaves from the first node of their base cell, relative to its size."""
    ((_, cells),) = base.blocks.items()
    corners = base.points[cells]
    first = corners[:, 0]
    size = np.linalg.norm(corners - first[:, None], axis=2).max(axis=1)
    return np.asarray((points[nodes] - first[root][:, None]) / size[root][:, None, None])


def filling_of(base: Mesh, points: Array, nodes: IntArray, root: IntArray) -> Array | None:
    """Volume of the body per volume of each leaf, at its nodes (e, a): linear over each base cell, with the volume and
    the centre of the body there.  None where the surface of the base mesh is not curved.

    Parameters
    ----------
    base
        Base mesh with its smooth surface.
    points, nodes, root
        (n, d) nodes [m], nodes (e, a) and base cells (e,) of the leaves.
    """
    rounding = base.rounding
    if rounding is None:
        return None
    total = moments_by_root(base, points, nodes, root, rounding.radial)
    curved = ~np.isnan(rounding.moments[:, 0])
    share = np.zeros(rounding.moments.shape)
    share[:, 0] = 1.0
    share[curved] = np.linalg.solve(total[curved], rounding.moments[curved][..., None])[..., 0]
    own = share[root]
    out = own[:, :1] + np.einsum("ead,ed->ea", local_places(base, points, nodes, root), own[:, 1:])
    return np.asarray(out)
