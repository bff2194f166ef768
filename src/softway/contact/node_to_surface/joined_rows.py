"""Contact rows of several methods, one after another."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.contact.contact_rows import ContactRows
from softway.contact.node_to_surface.node_to_tool import ToolContact
from softway.contact.stencils import PairedSurfaces, Stencils, normal_component
from softway.contact.tangential_rows import TangentialRows, tangents


def joined_rows(
    surfaces: Sequence[PairedSurfaces],
    places: tuple[Array, Array],
    numbers: tuple[IntArray, IntArray],
    labels: tuple[str, ...],
    frictionless: TangentialRows | None,
) -> ContactRows:
    """Rows of the surfaces.

    Parameters
    ----------
    places
        Positions and displacements (n, d) [m].
    numbers
        Slave node and contact (m,) of each row.
    labels
        Names of the contacts.
    frictionless
        Tangential parts without directions if no contact has friction.
    """
    x, u = places
    found = [m.at(x) for m in surfaces]
    d = x.shape[1]
    normal = np.concatenate([np.zeros((0, d)), *(s.normal for s in found)])
    weights = _stacked([s.weights for s in found], len(x))
    gradient = _gradient(found, weights, normal)
    gap = np.concatenate([np.zeros(0), *(s.gap for s in found)])
    tool_motion = [
        m.normal_motion(x, s.normal) if isinstance(m, ToolContact) else np.zeros(len(s.gap))
        for m, s in zip(surfaces, found, strict=True)
    ]
    return ContactRows(
        node=numbers[0],
        contact=numbers[1],
        normal=normal,
        gradient=gradient,
        offset=gap - gradient @ u.ravel(),
        tool_motion=np.concatenate([np.zeros(0), *tool_motion]),
        labels=labels,
        shear=_shear(surfaces, found, x, weights, normal) if frictionless is None else frictionless,
    )


def _stacked(rows: list[sp.csr_array], columns: int) -> sp.csr_array:
    """Rows (m, columns) of several matrices, one after another; those of a single one as they are."""
    return rows[0] if len(rows) == 1 else sp.vstack([sp.csr_array((0, columns)), *rows], format="csr")


def _gradient(found: list[Stencils], weights: sp.csr_array, normal: Array) -> sp.csr_array:
    """Derivatives (m, n d) of the gaps: from weights (m, n) and normals (m, d) at once where these give them."""
    if all(s.slopes is None for s in found):
        return normal_component(weights, normal)
    return _stacked([s.gradient() for s in found], weights.shape[1] * normal.shape[1])


def _shear(
    surfaces: Sequence[PairedSurfaces], found: list[Stencils], x: Array, weights: sp.csr_array, normal: Array
) -> TangentialRows:
    """Tangential parts of the rows with weights (m, n) and normals (m, d), at positions ``x`` (n, d)."""
    moved = [
        m.moved(x) if isinstance(m, ToolContact) else np.zeros_like(s.normal)
        for m, s in zip(surfaces, found, strict=True)
    ]
    motion = np.concatenate([np.zeros((0, x.shape[1])), *moved])
    return TangentialRows(weights=weights, tangents=tangents(normal), moved=motion)
