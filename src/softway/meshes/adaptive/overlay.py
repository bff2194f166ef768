"""Overlay of two adapted meshes of one base: exact pairs of leaves, common matrices, and embeddings.

Of two leaves that overlap one lies inside the other.  There the shape functions of the coarser leaf are combinations of
those of the finer one, ``N_a = sum_b P_ba N_b`` with the values P of N_a at the nodes of the finer leaf.  Integrals of
products of both are therefore products of P with the element matrices of the finer leaves, without another quadrature
(docs/theory/bodies/adaptive.md).
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.adaptive.leaves import Leaves, nested
from softway.meshes.adaptive.nodes.leaf_nodes import node_places, shape_functions
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.adaptive.surfaces.extended import extended


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pairs:
    """Pairs of a coarser leaf and a finer one inside it, or of one that both meshes have.

    Parameters
    ----------
    coarse, fine
        (p,) numbers of the leaves in their meshes.
    values
        (p, a, a) shape functions of the coarser leaf, the last axis, at the nodes of the finer one.
    """

    coarse: IntArray
    fine: IntArray
    values: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Overlay:
    """Leaves of two adapted meshes A and B that overlap.

    Parameters
    ----------
    one, other
        The meshes A and B.
    inside_one
        Leaves of B inside those of A, equal ones among them.
    inside_other
        Leaves of A that are smaller than that of B around them.
    """

    one: AdaptedMesh
    other: AdaptedMesh
    inside_one: Pairs
    inside_other: Pairs


def overlay(one: AdaptedMesh, other: AdaptedMesh) -> Overlay:
    """Overlay of two adapted meshes of the same base.

    Raises
    ------
    InputError
        If the meshes have different bases.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> base = interval(1.0, cells=2)
    >>> found = overlay(refined(base, np.array([1, 0])), refined(base, np.array([0, 1])))
    >>> found.inside_one.fine.tolist(), found.inside_other.fine.tolist()
    ([1, 2], [0, 1])
    """
    require_one_base(one, other)
    return Overlay(
        one=one,
        other=other,
        inside_one=chosen_pairs(one, other, nested(one.leaves, other.leaves)),
        inside_other=chosen_pairs(other, one, ~_covers(other, one)),
    )


def _covers(other: AdaptedMesh, one: AdaptedMesh) -> BoolArray:
    """True (e,) for the leaves of ``one`` that are equal to one of ``other`` or contain some."""
    return np.asarray(one.leaves.level <= other.leaves.level[other.leaves.around(one.leaves.start)])


def require_one_base(one: AdaptedMesh, other: AdaptedMesh) -> None:
    """Refuse meshes of different bases."""
    same = one.base is other.base or (
        list(one.base.blocks) == list(other.base.blocks)
        and np.array_equal(one.base.points, other.base.points)
        and all(np.array_equal(one.base.blocks[k], other.base.blocks[k]) for k in one.base.blocks)
    )
    if not same:
        raise InputError("mesh", "two meshes of different bases", "refined() of the same base mesh for both")


def chosen_pairs(coarse: AdaptedMesh, fine: AdaptedMesh, chosen: BoolArray) -> Pairs:
    """The ``chosen`` leaves (e,) of the finer mesh with the leaves around them."""
    own = np.flatnonzero(chosen)
    around = coarse.leaves.around(fine.leaves.start[own])
    depth = np.ldexp(1.0, fine.leaves.level[own] - coarse.leaves.level[around])[:, None, None]
    place = fine.place[own] @ np.linalg.inv(coarse.place[around])
    exact = np.rint(depth * place) / depth  # multiples of 1 / depth: bisection takes means
    values = shape_functions(coarse.cell, node_places(coarse.cell, exact))
    return Pairs(coarse=around, fine=own, values=values)


def common_matrix(found: Overlay, one: Array, other: Array) -> sp.csr_array:
    """Common matrix ``C_ab = integral of w N_a N_b`` (n, m) of the shape functions of both meshes.

    Parameters
    ----------
    found
        Overlay of the meshes A and B.
    one, other
        (e, a, a) element matrices of the same integral in each mesh, such as masses.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> base = interval(1.0, cells=1)
    >>> coarse, fine = refined(base, np.array([0])), refined(base, np.array([1]))
    >>> mass = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    >>> common = common_matrix(overlay(coarse, fine), mass[None], 0.5 * np.stack([mass, mass]))
    >>> (24.0 * common.toarray()).round(12).tolist()
    [[5.0, 1.0, 6.0], [1.0, 5.0, 6.0]]
    """
    a, b = _nodes(found.one), _nodes(found.other)
    down, up = found.inside_one, found.inside_other
    blocks = [
        (a[down.coarse], b[down.fine], np.einsum("pka,pkb->pab", down.values, other[down.fine])),
        (a[up.fine], b[up.coarse], np.einsum("pak,pkb->pab", one[up.fine], up.values)),
    ]
    shape = found.one.mesh.n_nodes, found.other.mesh.n_nodes
    total = sp.csr_array(shape)
    for rows, columns, values in blocks:
        k = rows.shape[1]
        places = np.repeat(rows, k, axis=1).ravel(), np.tile(columns, (1, k)).ravel()
        total = sp.csr_array(total + sp.csr_array((values.ravel(), places), shape=shape))
    return total


def embedding(coarse: AdaptedMesh, fine: AdaptedMesh) -> sp.csr_array:
    """Values (n, m) at the n nodes of a mesh from those at the m nodes of a coarser one, exactly the same function.

    Where the finer cells of a curved boundary reach beyond those of the coarser mesh, gradients continue the function.

    Raises
    ------
    InputError
        If a leaf of the mesh is larger than that of the coarser one, or the bases are different.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> base = interval(1.0, cells=1)
    >>> embedding(refined(base, np.array([0])), refined(base, np.array([1]))).toarray().tolist()
    [[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]
    """
    require_one_base(coarse, fine)
    inside = nested(coarse.leaves, fine.leaves)
    if not inside.all():
        problem = f"{int((~inside).sum())} cells are larger than those of the coarser mesh"
        raise InputError("mesh", problem, "united() of both, which refines both")
    pairs = chosen_pairs(coarse, fine, inside)
    rows, columns = _nodes(fine), _nodes(coarse)[pairs.coarse]
    number, first = np.unique(rows.ravel(), return_index=True)
    leaf, local = first // rows.shape[1], first % rows.shape[1]
    values, columns = pairs.values[leaf, local], columns[leaf]
    places = np.repeat(number, values.shape[1]), columns.ravel()
    out = sp.csr_array((values.ravel(), places), shape=(fine.mesh.n_nodes, coarse.mesh.n_nodes))
    out.eliminate_zeros()
    return extended(out, coarse, fine)


def united(one: AdaptedMesh, other: AdaptedMesh) -> AdaptedMesh:
    """Mesh of the finer leaf of two meshes at each place, the coarsest one in which both are embedded.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> base = interval(1.0, cells=2)
    >>> united(refined(base, np.array([2, 1])), refined(base, np.array([0, 1]))).leaves.level.tolist()
    [2, 2, 2, 2, 1, 1]
    """
    require_one_base(one, other)
    if nested(one.leaves, other.leaves).all():
        return other
    if nested(other.leaves, one.leaves).all():
        return one
    kept, added = nested(other.leaves, one.leaves), ~_covers(one, other)
    start = np.concatenate([one.leaves.start[kept], other.leaves.start[added]])
    level = np.concatenate([one.leaves.level[kept], other.leaves.level[added]])
    order = np.argsort(start)
    return refined(one.base, level[order], Leaves(start[order], level[order]))


def _nodes(adapted: AdaptedMesh) -> IntArray:
    """Nodes (e, a) of the leaves."""
    return next(iter(adapted.mesh.blocks.values()))
