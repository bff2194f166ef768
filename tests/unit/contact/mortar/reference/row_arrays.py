"""NumPy reference of the rows of mortar contact: arrays over all pairs, sums by sparse matrices."""

import numpy as np
import scipy.sparse as sp
import segment_arrays
import triangle_arrays
from fade_arrays import gap_change, pair_weights, weight_changes
from overlap_arrays import Overlap
from weight_arrays import gap_weights

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.mortar.facet_pairs import unit, vector_areas
from softway.contact.mortar.mortar import Mortar, MortarContact, corners_of
from softway.contact.stencils import Stencils

STEEP = 0.2


def rows(mortar: Mortar, met: MortarContact, x: Array) -> tuple[Stencils, Array]:
    """Rows at the positions x (n, d) [m], and their covered areas (m,)."""
    control, lift = mortar.slave.onto(len(x)), mortar.master.spread @ mortar.master.onto(len(x))
    points = control @ x
    to_slave = mortar.slave.spread @ control
    slave_nodes = mortar.slave.spread @ points
    slave = corners_of(slave_nodes, mortar.slave.corner)
    master = corners_of(lift @ x, mortar.master.corner)
    areas = vector_areas(slave)
    normal = -unit(met.vertex_weights @ areas.T, axis=1)
    common = overlap(mortar, met, slave, areas, master, normal)
    i, j = met.pairs.slave[common.pair], met.pairs.master[common.pair]
    size = np.sqrt(np.sum(areas**2, axis=0))
    functions = gap_weights(mortar.slave, points, size, common.mass(i, len(size)))
    nodal = mortar.slave.nodal
    own = nodal(functions.own)
    cross = nodal(functions.integrals(i, common.cross, mortar.master.corner.T[:, j], lift.shape[0]))
    total, covered = cross.sum(axis=1), own.sum(axis=1)
    felt = (total > 0.0) & (covered > 0.0)
    weights = _over(own @ control, covered, felt) - _over(cross @ lift, total, felt)
    square = np.take(unit(areas), i, axis=1)
    facing = _seen(square, master, j)
    normal = np.where(felt[:, None], unit(nodal(functions.means(i, common.cross, facing)), axis=1), normal)
    turn = _turning(slave, master, facing, common, (i, j))
    parts = (
        functions.integrals(i, common.own * n + turn * p, mortar.slave.corner.T[:, i], len(slave_nodes)) @ to_slave
        - functions.integrals(i, common.cross * n, mortar.master.corner.T[:, j], lift.shape[0]) @ lift
        for n, p in zip(facing, square, strict=True)
    )
    slopes = interleaved([_over(nodal(sp.csr_array(p)), total, felt) for p in parts])
    slopes = slopes + _fades(mortar, (slave, master), (points, size), common, (i, j), (to_slave, lift), facing)
    gap = np.where(felt, slopes @ x.ravel(), np.inf)
    return Stencils(gap=gap, normal=normal, weights=weights, slopes=slopes), covered


def overlap(mortar: Mortar, met: MortarContact, slave: Array, areas: Array, master: Array, normal: Array) -> Overlap:
    """Overlap of the pairs within their limits.

    Arguments: corners (d, k, p) and vector areas (d, p) of the slave simplices, corners of the master simplices,
    normals (m, d) of the rows.
    """
    i, j = met.pairs.slave, met.pairs.master
    if len(slave) == 2:
        common = segment_arrays.overlap(slave, -corners_of(normal, mortar.slave.corner), master, i, j)
    else:
        common = triangle_arrays.overlap(slave, master, i, j)
    i, j = i[common.pair], j[common.pair]
    apart = np.einsum("ks,dks->ds", common.cross.sum(axis=0), np.take(master, j, axis=2))
    apart -= np.einsum("ks,dks->ds", common.own.sum(axis=0), np.take(slave, i, axis=2))
    height, measure = np.sum(apart * np.take(unit(areas), i, axis=1), axis=0), common.measure
    near = common.subset((measure > 0.0) & (np.abs(height) <= met.pairs.limit[common.pair] * measure))
    i, j = met.pairs.slave[near.pair], met.pairs.master[near.pair]
    weight = pair_weights(np.take(unit(areas), i, axis=1), np.take(unit(vector_areas(master)), j, axis=1))
    return Overlap(pair=near.pair, own=weight * near.own, cross=weight * near.cross).subset(weight > 0.0)


def _fades(
    mortar: Mortar,
    corners: tuple[Array, Array],
    surface: tuple[Array, Array],
    common: Overlap,
    pair: tuple[IntArray, IntArray],
    spread: tuple[sp.csr_array, sp.csr_array],
    facing: Array,
) -> sp.csr_array:
    """Slopes (m, n d) by the weights of pairs.

    Arguments: corners (d, k, p) of both surfaces, control points and sizes of the slave, overlaps, numbers of the
    simplices, vertices of both surfaces from the nodes of the model, slopes (d, s) of the distances.
    """
    (slave, master), (i, j), d = corners, pair, len(facing)
    square, normal = (np.take(unit(vector_areas(c)), k, axis=1) for c, k in zip(corners, pair, strict=True))
    weight = pair_weights(square, normal)
    changes = weight_changes(square, normal, (_gradients(slave)[..., i], _gradients(master)[..., j]))
    low, high = (np.einsum("dks,ds->ks", c[..., k], facing) for c, k in zip(corners, pair, strict=True))
    apart = np.einsum("abs,bs->as", common.own, low) - np.einsum("abs,bs->as", common.cross, high)
    found = sp.csr_array((len(mortar.node), spread[0].shape[1] * d))
    for s in np.flatnonzero(weight < 1.0):
        change = sp.csr_array(gap_change(mortar, *surface, common, pair, apart, int(s))[:, None] / weight[s])
        for motion, numbers, simplex, vertices in zip(
            changes, pair, (mortar.slave.corner, mortar.master.corner), spread, strict=True
        ):
            for b, vertex in enumerate(simplex[numbers[s]]):
                node = sp.kron(vertices[[vertex]], motion[:, b, s][None], format="csr")
                found = found + sp.csr_array(change @ sp.csr_array(node))
    return found


def _seen(square: Array, master: Array, j: IntArray) -> Array:
    """Derivatives (d, s) of the distance along the slave normals ``square`` (d, s) to the master simplices j (s,), when
    the slave shifts: the master normal divided by its cosine.  ``master`` (d, k, q) are the corners.
    """
    normal = np.take(unit(vector_areas(master)), j, axis=1)
    return np.asarray(normal / np.maximum(-np.sum(square * normal, axis=0), STEEP))


def _turning(slave: Array, master: Array, facing: Array, common: Overlap, pair: tuple[IntArray, IntArray]) -> Array:
    """Integrals (k, k, s) of coordinates on the slave times the change of the distance, when its corners move along
    the normal.

    The direction in which the distance is measured turns with the slave: without this term a row of two surfaces that
    are not parallel would have a moment.  Arguments: corners (d, k, p), (d, k, q); the slopes (d, s) of the distance.
    """
    i, j = pair
    own = np.einsum("dks,ds->ks", np.take(slave, i, axis=2), facing)
    other = np.einsum("dks,ds->ks", np.take(master, j, axis=2), facing)
    distance = np.einsum("abs,bs->as", common.own, own) - np.einsum("abs,bs->as", common.cross, other)
    lean = np.einsum("dks,ds->ks", np.take(_gradients(slave), i, axis=2), facing)
    return np.asarray(-distance[:, None] * lean[None])


def _gradients(corners: Array) -> Array:
    """Gradients (d, k, p), along the simplices, of the barycentric coordinates of corners (d, k, p).

    Examples
    --------
    >>> _gradients(np.array([[0.0, 2.0], [0.0, 0.0]])[:, :, None])[0, :, 0].tolist()
    [-0.5, 0.5]
    """
    if len(corners) == 2:
        run = corners[:, 1] - corners[:, 0]
        slope = run / np.sum(run**2, axis=0)
        return np.stack([-slope, slope], axis=1)
    edge = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    area = np.cross(edge[:, 0], edge[:, 1], axis=0)
    return np.asarray(np.cross(area[:, None], edge, axis=0) / np.sum(area**2, axis=0))


def _over(matrix: sp.csr_array, total: Array, met: BoolArray) -> sp.csr_array:
    """Rows divided by their totals (m,) where ``met``; the other rows are empty."""
    factor = np.where(met, 1.0, 0.0) / np.where(met, total, 1.0)
    made = sp.csr_array(
        (matrix.data * np.repeat(factor, np.diff(matrix.indptr)), matrix.indices, matrix.indptr), matrix.shape
    )
    made.eliminate_zeros()
    return made


def interleaved(parts: list[sp.csr_array]) -> sp.csr_array:
    """Interleave the d components (m, n) of rows to (m, n d)."""
    (m, n), d = parts[0].shape, len(parts)
    coo = [p.tocoo() for p in parts]
    row = np.concatenate([c.coords[0] for c in coo])
    column = np.concatenate([c.coords[1].astype(np.int64) * d + k for k, c in enumerate(coo)])
    return sp.csr_array((np.concatenate([c.data for c in coo]), (row, column)), shape=(m, n * d))
