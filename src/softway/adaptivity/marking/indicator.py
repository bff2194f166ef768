"""Where a mesh is too coarse: recovered stress and rate against those of the cells, and wanted levels.

Indicator of Zienkiewicz and Zhu (Int. J. Num. Meth. Eng. 24 (1987) 337) for a solid in motion
(docs/theory/bodies/adaptive.md#indicator).
"""

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.transfer import Motion
from softway.arrays import Array, IntArray
from softway.meshes.adaptive.leaves import DEPTH
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.cells import CELLS

FINER = {1: (1.0, 3.0), 2: (1.0, 6.0), 3: (1.0, 8.0)}
"""Indicators, relative to the threshold, above which a cell wants one cut and two cuts more, by the levels of a cut."""
COARSER = {1: (0.35, 0.15), 2: (0.15, 0.04), 3: (0.1, 0.02)}
"""Indicators, relative to the threshold, below which it wants one cut and two cuts less, by the levels of a cut."""


def indicator(solid: AdaptedSolid, motion: Motion, moves: bool = True) -> Array:
    """Indicator (e,) of each cell, the root of an energy [J^(1/2)].

    Its square is the integral of ``|s* - s|^2 / (rho c^2) + rho h^2 |l* - l|^2`` over the cell.  The stress s and the
    gradient l of the velocity are means over the cell; s* and l* are linear between recovered values at its corners,
    means over the cells around them by volume, in one material; c is the speed of the fastest wave and h the shortest
    edge.  Without inertia, where nothing ``moves``, the rate does not count.

    Examples
    --------
    >>> import softway as sw
    >>> from softway.adaptivity.adapted_solid import adapted_solid
    >>> from softway.meshes.adaptive.refinement import refined
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=1.0)
    >>> on = adapted_solid("bar", bar, refined(bar.mesh.build(), np.zeros(4, int)), np.zeros(0, int))
    >>> kink = np.maximum(on.points - 0.5, 0.0)
    >>> indicator(on, Motion(displacement=kink, velocity=0.0 * kink)).round(3).tolist()
    [0.0, 0.144, 0.144, 0.0]
    """
    part, mesh = solid.part, solid.adapted.mesh
    count = mesh.n_cells
    volume = part.internal.sampling.volume.reshape(count, -1)
    stress = part.internal.stress(motion.displacement, motion.state).reshape(count, -1)
    rates = part.internal.sampling.plain_derivatives(motion.velocity).reshape(count, volume.shape[1], -1)
    whole = volume.sum(axis=1)
    rate = np.einsum("eq,eqk->ek", volume, rates) / whole[:, None]
    materials = part.materials
    owner = np.zeros(count, dtype=np.int64) if materials.owner is None else materials.owner
    density = np.array(materials.densities)[owner]
    modulus = density * np.array(materials.speeds(part.internal.section))[owner] ** 2
    (edge,) = mesh.cell_edges()
    square = whole / modulus * _spread(solid.adapted, owner, whole, stress)
    if moves:
        square += density * whole * edge**2 * _spread(solid.adapted, owner, whole, rate)
    return np.sqrt(square)


def warmth_indicator(solid: AdaptedSolid, warmth: Array) -> Array:
    """Indicator (e,) of the relative temperatures ``warmth`` (n,) of a solid, without unit.

    Its square is the integral of ``h^2 |g* - g|^2`` over the cell and the volume of the solid, with the gradient g of
    the cell, g* recovered from it as stresses are, and the shortest edge h: the error of the temperature in the mean
    square, relative to its range.

    Examples
    --------
    >>> import softway as sw
    >>> from softway.adaptivity.adapted_solid import adapted_solid
    >>> from softway.meshes.adaptive.refinement import refined
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=1.0)
    >>> on = adapted_solid("bar", bar, refined(bar.mesh.build(), np.zeros(4, int)), np.zeros(0, int))
    >>> warmth_indicator(on, 2.0 * np.maximum(on.points[:, 0] - 0.5, 0.0)).round(3).tolist()
    [0.0, 0.072, 0.072, 0.0]
    """
    part, mesh = solid.part, solid.adapted.mesh
    field = np.zeros(mesh.points.shape)
    field[:, 0] = warmth
    volume = part.internal.sampling.volume.reshape(mesh.n_cells, -1)
    slopes = part.internal.sampling.plain_derivatives(field).reshape(*volume.shape, -1)
    whole = volume.sum(axis=1)
    mean = np.einsum("eq,eqk->ek", volume, slopes) / whole[:, None]
    owner = np.zeros(mesh.n_cells, dtype=np.int64) if part.materials.owner is None else part.materials.owner
    (edge,) = mesh.cell_edges()
    return np.asarray(np.sqrt(whole / whole.sum() * edge**2 * _spread(solid.adapted, owner, whole, mean)))


def _spread(adapted: AdaptedMesh, owner: IntArray, volume: Array, values: Array) -> Array:
    """Mean square (e,) over a cell of its values (e, k) less the linear field of those recovered at its corners."""
    rows = next(iter(adapted.mesh.blocks.values()))[:, : CELLS[adapted.cell].corners]
    nodes = rows + owner[:, None] * adapted.mesh.n_nodes
    count, c = rows.shape
    around = sp.csr_array(
        (np.ones(nodes.size), nodes.ravel(), np.arange(0, nodes.size + 1, c)), (count, nodes.max() + 1)
    )
    total = around.T @ np.column_stack([volume[:, None] * values, volume])
    mean = total[:, :-1] / np.where(total[:, -1:] > 0.0, total[:, -1:], 1.0)
    apart = mean[nodes] - values[:, None]
    return np.asarray(np.einsum("eak,ab,ebk->e", apart, _products(adapted), apart))


def _products(adapted: AdaptedMesh) -> Array:
    """Means (c, c) of the products of the linear shape functions over a cell of constant thickness and area."""
    corners = CELLS[adapted.cell].corners
    if adapted.step > 1:
        apart = np.abs(CELLS[adapted.cell].nodes[:corners, None] - CELLS[adapted.cell].nodes[None, :corners])
        return np.asarray((1.0 / 3.0 - apart / 6.0).prod(axis=2))
    return (np.ones((corners, corners)) + np.eye(corners)) / (corners * (corners + 1))


def wanted_levels(adapted: AdaptedMesh, indicated: Array, threshold: float, greatest: int) -> IntArray:
    """Wanted levels (e,) on the leaves of a mesh: up to two cuts more or less than they have, 0 to ``greatest``.

    Parameters
    ----------
    adapted
        The mesh.
    indicated
        (e,) indicator of each cell.
    threshold
        Indicator above which a cell is too coarse.
    greatest
        Greatest level.

    Examples
    --------
    >>> from softway.meshes.adaptive.refinement import refined
    >>> from softway.meshes.generators.shapes import interval
    >>> found = refined(interval(1.0, cells=1), np.array([2]))
    >>> wanted_levels(found, np.array([4.0, 1.5, 0.5, 0.1]), 1.0, 9).tolist()
    [4, 3, 2, 0]
    """
    ratio, step, most = indicated[:, None] / threshold, adapted.step, min(greatest, DEPTH)
    change = (ratio > np.array(FINER[step])).sum(axis=1) - (ratio < np.array(COARSER[step])).sum(axis=1)
    return np.asarray(np.clip(adapted.leaves.level + step * change, 0, most - most % step))
