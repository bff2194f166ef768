"""Values of the fields of two adapted meshes of one base at the nodes of each other."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.leaves import Leaves, among
from softway.meshes.adaptive.nodes.leaf_nodes import node_places, shape_functions
from softway.meshes.adaptive.overlay import chosen_pairs, require_one_base
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.adaptive.surfaces.extended import extended


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ValuesAtNodes:
    """Values of fields of two meshes A, n nodes, and B, m nodes, at the nodes of each other.

    Parameters
    ----------
    forward
        (m, n) values of a field of A at the nodes of B.
    back
        (n, m) values of a field of B at the nodes of A.
    """

    forward: sp.csr_array
    back: sp.csr_array


def values_at_nodes(one: AdaptedMesh, other: AdaptedMesh) -> ValuesAtNodes:
    """Matrices that give the values of fields of each mesh at the nodes of the other, exact in floating point.

    Leaves that both meshes have share their nodes.  Where a leaf is cut in the other mesh, its shape functions give the
    values at the new nodes, and its own nodes are those at which one of its shape functions is one.  At a
    curved boundary the gradient carries the values to nodes off the cell.

    Raises
    ------
    InputError
        If the meshes have different bases.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import interval
    >>> base = interval(1.0, cells=1)
    >>> found = values_at_nodes(refined(base, np.array([0])), refined(base, np.array([1])))
    >>> found.forward.toarray().tolist(), found.back.toarray().tolist()
    ([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    """
    require_one_base(one, other)
    nodes = [next(iter(mesh.mesh.blocks.values())) for mesh in (one, other)]
    cut = _cut(one.leaves, other.leaves), _cut(other.leaves, one.leaves)
    same = np.full((2, max(one.mesh.n_nodes, other.mesh.n_nodes)), -1)
    equal = among(other.leaves, one.leaves)
    ours = nodes[0][one.leaves.around(other.leaves.start[equal])]
    same[0, ours], same[1, nodes[1][equal]] = nodes[1][equal], ours
    fine = [_inside(one, other, cut[0]), _inside(other, one, cut[1])]
    for k, (rows, columns, values) in enumerate(fine):
        own = values == 1.0  # a shape function is one at its node alone
        inner, outer = np.repeat(rows, values.shape[1])[own.ravel()], columns[own]
        same[1 - k, inner], same[k, outer] = outer, inner
    sizes = one.mesh.n_nodes, other.mesh.n_nodes
    forward, back = (_matrix(fine[k], same[1 - k, : sizes[1 - k]], (sizes[1 - k], sizes[k])) for k in (0, 1))
    forward, back = extended(forward, one, other), extended(back, other, one)
    return ValuesAtNodes(forward=_followed(other, forward), back=_followed(one, back))


def _followed(mesh: AdaptedMesh, values: sp.csr_array) -> sp.csr_array:
    """Values (m, n) at the m nodes of a mesh, hanging ones following the others."""
    hanging = mesh.mesh.hanging
    return values if hanging is None else sp.csr_array(hanging.follow(values.shape[0]) @ values)


def values_of_base(adapted: AdaptedMesh) -> sp.csr_array:
    """Values (m, n) of the fields of the base mesh, n nodes, at the m nodes of the adapted mesh."""
    rows = next(iter(adapted.mesh.blocks.values()))
    first = np.unique(rows.ravel(), return_index=True)[1]
    leaf, local = np.divmod(first, rows.shape[1])
    own = node_places(adapted.cell, adapted.place[leaf])[np.arange(len(leaf)), local]
    values = shape_functions(adapted.cell, own)
    columns = next(iter(adapted.base.blocks.values()))[adapted.leaves.root[leaf]]
    starts = np.arange(0, values.size + 1, values.shape[1])
    out = sp.csr_array((values.ravel(), columns.ravel(), starts), (len(leaf), adapted.base.n_nodes))
    out.eliminate_zeros()
    return out


def _cut(coarse: Leaves, fine: Leaves) -> BoolArray:
    """True (e,) for each leaf of ``fine`` that lies in a larger one of ``coarse``."""
    return np.asarray(fine.level > coarse.level[coarse.around(fine.start)])


def _inside(coarse: AdaptedMesh, fine: AdaptedMesh, chosen: BoolArray) -> tuple[IntArray, IntArray, Array]:
    """Nodes (k,) of the ``chosen`` leaves (e,) inside larger ones, the nodes (k, a) of the leaf around each, and their
    shape functions (k, a) there.
    """
    pairs = chosen_pairs(coarse, fine, chosen)
    rows = next(iter(fine.mesh.blocks.values()))[pairs.fine]
    number, first = np.unique(rows.ravel(), return_index=True)
    leaf, local = np.divmod(first, rows.shape[1])
    return number, next(iter(coarse.mesh.blocks.values()))[pairs.coarse[leaf]], pairs.values[leaf, local]


def _matrix(inside: tuple[IntArray, IntArray, Array], same: IntArray, shape: tuple[int, int]) -> sp.csr_array:
    """Matrix of the values ``inside`` larger leaves, and of ones at nodes that are the ``same`` (m,) in both meshes."""
    rows, columns, values = inside
    others = same >= 0
    others[rows] = False
    own = np.flatnonzero(others)
    places = np.concatenate([np.repeat(rows, values.shape[1]), own]), np.concatenate([columns.ravel(), same[own]])
    out = sp.csr_array((np.concatenate([values.ravel(), np.ones(len(own))]), places), shape=shape)
    out.eliminate_zeros()
    return out
