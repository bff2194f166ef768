"""Penalty springs on contact rows: their stiffness, and the matrix of a slab with those that are pressed."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.bodies.loads import traction_force
from softway.bodies.part import Part
from softway.bodies.section import wave_speed
from softway.errors import InputError
from softway.model import Model
from softway.solve.backends.choice import best
from softway.solve.linear import Analysis, Factor, SuperLU
from softway.solve.operators.factored import FEW
from softway.typing import Array, IntArray

LEAST = 0.1
"""Share of the mean area below which no node falls: corners of quadratic facets have none."""


def springs(model: Model, factor: float) -> Array:
    """Stiffness (m,) of the contact rows, ``factor E A / l`` of area, edge and stiffness at the slave node [N/m].

    ``E`` is that of plane waves, ``rho c^2``.
    """
    node = model.encounters.node
    out = np.zeros(len(node))
    for k, contact in enumerate(model.scene.contacts):
        for part, tag in _sides(model, contact.body, contact.tag, contact.opponent, contact.opponent_tag):
            inside = (node >= part.rows.start) & (node < part.rows.stop)
            here = np.flatnonzero((model.encounters.contact == k) & inside)
            area = _areas(part, tag)[node[here] - part.rows.start]
            area = np.maximum(area, LEAST * area.mean()) if len(area) else area
            modulus = part.density * wave_speed(part.internal.material, part.density, part.internal.section) ** 2
            out[here] = factor * modulus * area / model.edge[node[here]]
    return out


def _sides(model: Model, body: str, tag: str, opponent: str, opponent_tag: str) -> list[tuple[Part, str]]:
    """The solids of a contact with their tags."""
    tags = {opponent: opponent_tag, body: tag}
    return [(p, tags[p.name]) for p in model.parts if p.name in tags]


def _areas(part: Part, tag: str) -> Array:
    """Area (n,) of the facets of a tag that falls to each node [m^2]."""
    along = (1.0,) + (0.0,) * (part.mesh.dim - 1)
    try:
        return traction_force(part.mesh, part.internal.section, tag, along)[:, 0]
    except InputError:  # nodes without a whole facet
        return traction_force(part.mesh, part.internal.section, "surface", along)[:, 0]


def squeezed(before: Array, after: Array) -> tuple[Array, Array]:
    """Mean force of springs of stiffness one over a slab, and its derivative to the depth at the end.

    It is the secant of the stored energy ``1/2 max(d, 0)^2`` between the depths (m,) before and after [m], so that the
    springs give back what they took whenever they touch and let go.

    References
    ----------
    Armero, Petocz (1998), Comput. Methods Appl. Mech. Engrg. 158, 269-300.

    Examples
    --------
    >>> [x.tolist() for x in squeezed(np.array([1.0, -1.0, 1.0, -1.0]), np.array([3.0, 1.0, -1.0, -2.0]))]
    [[2.0, 0.25, 0.25, 0.0], [0.5, 0.375, 0.125, 0.0]]
    """
    first, last = np.maximum(before, 0.0), np.maximum(after, 0.0)
    part = np.maximum(first, last) / np.maximum(np.abs(after - before), 1e-300)
    part = np.where((first > 0.0) == (last > 0.0), 1.0, part)
    mean = 0.5 * (first + last) * part
    entering = part * (1.0 - 0.5 * part)
    leaving = 0.5 * part**2
    return mean, np.where(last > 0.0, entering, leaving) * ((first > 0.0) | (last > 0.0))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Workshop:
    """Factors of ``M + h^2/4 (K + G^T k G)``: the pattern grows with the pairs that touch.

    Parameters
    ----------
    base
        Numbers ``column f + row`` of the entries without contact (b,).
    keys, where
        The same of all entries so far (z,), ascending, and where among them the base stands.
    pattern
        Row indices and column pointers of all entries so far.
    size
        Number f of the unknowns.
    analysis
        Order of elimination of the pattern.
    made
        Factors so far.
    """

    base: IntArray
    keys: IntArray
    where: IntArray
    pattern: tuple[IntArray, IntArray]
    size: int
    analysis: Analysis | None = None
    made: int = 0

    def factored(self, matrix: sp.csc_array, rows: sp.csr_array, stiffness: Array) -> tuple[Factor, "Workshop"]:
        """The factor of ``matrix + rows^T stiffness rows`` for rows (k, f), and the workshop afterwards.

        Raises
        ------
        NoConvergence
            If it is singular.
        """
        extra = sp.csc_array(rows.T @ sp.csr_array(rows.multiply(stiffness[:, None])))
        entries = _keys(extra.indptr, extra.indices, self.size)
        ready, places = self._holding(entries)
        data = np.zeros(len(ready.keys))
        data[ready.where] = matrix.data
        np.add.at(data, places, extra.data)
        whole = sp.csc_array((data, *ready.pattern), (self.size, self.size))
        analysis = ready.analysis
        if analysis is None:
            analysis = (SuperLU() if self.size < FEW else best("double")).analyse(whole)
        return analysis.factor(whole), replace(ready, analysis=analysis, made=ready.made + 1)

    def _holding(self, entries: IntArray) -> tuple["Workshop", IntArray]:
        """The workshop with a pattern that holds some entries (e,) too, and where they stand."""
        places = np.searchsorted(self.keys, entries)
        missing = self.keys[np.minimum(places, len(self.keys) - 1)] != entries
        if not missing.any():
            return self, places
        keys = np.union1d(self.keys, entries[missing])
        grown = replace(
            self,
            keys=keys,
            where=np.searchsorted(keys, self.base),
            pattern=_pattern(keys, self.size),
            analysis=None,
        )
        return grown, np.searchsorted(keys, entries)


def workshop(model: Model) -> Workshop:
    """The workshop of a model, without contact so far."""
    size = int(model.free.sum())
    keys = _keys(model.total.indptr, model.total.indices, size)
    return Workshop(base=keys, keys=keys, where=np.arange(len(keys)), pattern=_pattern(keys, size), size=size)


def _pattern(keys: IntArray, size: int) -> tuple[IntArray, IntArray]:
    """Row indices and column pointers of entries with ascending numbers."""
    column, row = np.divmod(keys, size)
    return row.astype(np.int32), np.searchsorted(column, np.arange(size + 1)).astype(np.int32)


def _keys(indptr: IntArray, indices: IntArray, size: int) -> IntArray:
    """Numbers ``column size + row`` of the entries of a matrix."""
    columns = np.repeat(np.arange(len(indptr) - 1, dtype=np.int64), np.diff(indptr))
    return np.asarray(columns * size + indices)
