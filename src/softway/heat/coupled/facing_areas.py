"""Areas of contact rows: of the facets at their nodes, as far as these face the opponent."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.setup.loads import facet_measures
from softway.contact.friction_rows import DeclaredSurface


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacingAreas:
    """Parts of facets at the nodes of r rows: numbers (p,) of the rows, areas (p,) [m^2] and unit normals (p, d)."""

    row: IntArray
    area: Array
    normal: Array

    def towards(self, normal: Array) -> Array:
        """Areas (r,) of rows whose opponents have the unit normals (r, d): those of facets across them do not count.

        Examples
        --------
        The corner of a body, whose other side is not touched:

        >>> corner = FacingAreas(row=np.array([0, 0]), area=np.array([2.0, 3.0]), normal=np.eye(2))
        >>> corner.towards(np.array([[0.0, -1.0]])).tolist()
        [3.0]
        """
        facing = np.abs(np.einsum("pd,pd->p", self.normal, normal[self.row]))
        return np.maximum(np.bincount(self.row, weights=self.area * facing, minlength=len(normal)), 0.0)


def facing_areas(surfaces: Sequence[DeclaredSurface], u: Array, node: IntArray) -> FacingAreas:
    """Parts of the facets of ``surfaces`` at the slave nodes (r,) of rows, at the displacement ``u`` (n, d) [m]."""
    nodes, areas, normals = [], [], []
    for it in surfaces:
        x = it.points + u[it.nodes]
        for kind, facets in it.facets.items():
            measure = facet_measures(x[facets], it.section, kind)
            if kind == "quad8":
                measure = evened(measure)
            nodes.append(facets.ravel() + it.nodes.start)
            areas.append(measure.ravel())
            normals.append(np.repeat(_normals(x[facets]), facets.shape[1], axis=0))
    of, n = np.concatenate(nodes), len(u)
    parts = sp.csr_array((np.ones(len(of)), (of, np.arange(len(of)))), shape=(n, len(of)))[node]
    row = np.repeat(np.arange(len(node)), np.diff(parts.indptr))
    return FacingAreas(
        row=row, area=np.concatenate(areas)[parts.indices], normal=np.concatenate(normals)[parts.indices]
    )


def evened(measure: Array) -> Array:
    """Areas (f, 8) of eight-node facets, whose corners have a negative part: a quarter of both mid-nodes beside it."""
    out, given = measure.copy(), 0.25 * measure[:, 4:]
    out[:, 4:] -= 2.0 * given
    out[:, :4] += given + np.roll(given, 1, axis=1)
    return out


def _normals(x: Array) -> Array:
    """Unit normals (f, d) of facets with the nodes ``x`` (f, b, d), whose corners come first."""
    d = x.shape[2]
    if d == 1:
        return np.ones((len(x), 1))
    if d == 2:
        along = x[:, 1] - x[:, 0]
        normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    else:
        normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])
