"""Thickness of a body at its boundary, counted in layers of quadrilaterals or hexahedra."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.mesh import Mesh

OPPOSITE = {"quad4": (2, 3, 0, 1), "hex8": (1, 0, 3, 2, 5, 4)}
"""Cell -> number of the facet opposite to each of its facets."""
MOST = 16
"""Greatest number of layers that are counted."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layers:
    """Layers of cells between boundary facets on opposite sides of a body.

    Parameters
    ----------
    facets, ends
        (f, b) nodes of the boundary facets, and of the facets opposite to them.
    thickness
        (f,) distance between the centres of both [m].
    count
        (f,) number of layers.
    """

    facets: IntArray
    ends: IntArray
    thickness: Array
    count: IntArray


def layers(mesh: Mesh, cell: str) -> Layers:
    """Layers of the cells ``quad4`` or ``hex8`` of a mesh, up to :data:`MOST`.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> found = layers(rectangle((8.0, 1.0), (8, 2)), "quad4")
    >>> len(found.count), found.count.min(), found.thickness.min()
    (20, np.int64(2), np.float64(1.0))
    """
    cells, opposite = mesh.blocks[cell], np.array(OPPOSITE[cell])
    local = np.array([nodes for _, nodes in FACETS[cell]])
    width = CELLS[FACETS[cell][0][0]].corners
    rows = cells[:, local].reshape(-1, local.shape[1])
    number = np.unique(np.sort(rows[:, :width], axis=1), axis=0, return_inverse=True)[1].ravel()
    twin = _twins(number)
    outer = outer_facets(mesh, cell).ravel()
    start = np.flatnonzero(outer)
    at, end, count = start.copy(), np.full(len(start), -1), np.zeros(len(start), int)
    active = np.arange(len(start))
    for step in range(1, MOST + 1):
        through = at[active] // len(local) * len(local) + opposite[at[active] % len(local)]
        out = outer[through]
        end[active[out]], count[active[out]] = through[out], step
        at[active] = twin[through]
        active = active[twin[through] >= 0]
    done = end >= 0
    facets, ends = rows[start[done]], rows[end[done]]
    apart = mesh.points[facets].mean(axis=1) - mesh.points[ends].mean(axis=1)
    return Layers(facets=facets, ends=ends, thickness=np.linalg.norm(apart, axis=1), count=count[done])


def outer_facets(mesh: Mesh, cell: str) -> BoolArray:
    """True (e, f) for the facets of the linear cells of a block that are on the boundary of the mesh.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import rectangle
    >>> outer_facets(rectangle((2.0, 1.0), (2, 1)), "quad4").tolist()
    [[True, False, True, True], [True, True, True, False]]
    """
    facet, local = FACETS[cell][0][0], np.array([nodes for _, nodes in FACETS[cell]])
    outer = mesh.boundary().get(facet, np.zeros((0, local.shape[1]), int))
    surface = np.zeros(mesh.n_nodes, bool)
    surface[outer] = True
    rows = mesh.blocks[cell][:, local]
    on = np.asarray(surface[rows].all(axis=2))
    near = np.sort(np.concatenate([outer, rows[on]]), axis=1)
    number = np.unique(near, axis=0, return_inverse=True)[1].ravel()
    on[on] = np.isin(number[len(outer) :], number[: len(outer)])
    return on


def _twins(number: IntArray) -> IntArray:
    """For each facet of a cell the same facet of the neighbour, -1 without one; ``number`` (f,) numbers the facets."""
    order = np.argsort(number, kind="stable")
    pair = np.flatnonzero(number[order[1:]] == number[order[:-1]])
    twin = np.full(len(number), -1)
    twin[order[pair]], twin[order[pair + 1]] = order[pair + 1], order[pair]
    return twin
