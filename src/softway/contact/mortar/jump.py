"""Jump of the displacement between two surfaces that lie on each other: a mean around each node, with its area."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.contact.mortar.facet_pairs import unit
from softway.contact.mortar.following import common_parts
from softway.contact.mortar.linear_surface import LinearSurface
from softway.kernels.mortar.simplices import vector_areas


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FacetNormals:
    """Normals at the nodes of a surface.

    Parameters
    ----------
    surface, control
        Its linear replacement, and the control points (c, n) from the nodes of the model.
    weights
        (m, p) weights of its simplices for the nodes.
    """

    surface: LinearSurface
    control: sp.csr_array
    weights: sp.csr_array

    def at(self, x: Array) -> Array:
        """Unit normals (m, d), into the body, at the positions ``x`` (n, d)."""
        areas = vector_areas(self.surface.spread @ (self.control @ x), self.surface.corner)
        return -unit(self.weights @ areas, axis=1)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EndNormal:
    """Normal at the end of a bar on a line, into the bar."""

    sign: float

    def at(self, x: Array) -> Array:
        """Normal (1, 1)."""
        return np.full((1, 1), self.sign)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Jump:
    """Jump between two surfaces.

    Parameters
    ----------
    node
        (m,) nodes of the first surface.
    rows
        (m, n) mean displacement of the first surface less that of the second one, around each node.
    area
        (m,) area around each node [m^r]; their sum is that of the surface.
    normals
        Normals at the nodes, from the second surface to the first.
    """

    node: IntArray
    rows: sp.csr_array
    area: Array
    normals: FacetNormals | EndNormal


def jump(slave: Mapping[str, IntArray], master: Mapping[str, IntArray], x: Array, reach: float) -> Jump:
    """Jump between the facets ``slave`` and ``master``; arguments as of
    :func:`~softway.contact.mortar.following.following`.

    A uniform traction on the jumps has the nodal loads of a uniform traction on both surfaces.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [2.0, 0.0]])
    >>> found = jump({"bar2": np.array([[1, 0]])}, {"bar2": np.array([[2, 3]])}, x, 0.1)
    >>> found.area.tolist(), (3.0 * found.rows.toarray()).round(12).tolist(), (found.normals.at(x) + 0.0).tolist()
    ([0.5, 0.5], [[3.0, 0.0, -2.0, -1.0], [0.0, 3.0, -1.0, -2.0]], [[0.0, -1.0], [0.0, -1.0]])
    """
    both = common_parts(slave, master, x, reach)
    control = both.mortar.slave.onto(len(x))
    own = sp.csr_array(both.own @ control)
    area = np.asarray(own.sum(axis=1)).ravel()
    here = np.flatnonzero(area > 0.0)
    rows = sp.csr_array(sp.diags_array(1.0 / area[here]) @ sp.csr_array(own - both.cross)[here])
    normals = FacetNormals(surface=both.mortar.slave, control=control, weights=sp.csr_array(both.weights[here]))
    return Jump(node=both.mortar.slave.node[here], rows=rows, area=area[here], normals=normals)


def end_jump(one: int, two: int, sign: float, nodes: int) -> Jump:
    """Jump between the ends ``one`` and ``two`` of bars, of ``nodes``; ``sign`` of the outward normal at ``one``."""
    rows = sp.csr_array(([1.0, -1.0], ([0, 0], [one, two])), shape=(1, nodes))
    return Jump(node=np.array([one]), rows=rows, area=np.ones(1), normals=EndNormal(sign=-sign))
