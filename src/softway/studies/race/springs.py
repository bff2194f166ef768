"""Penalty springs on contact rows: their stiffness, and the slab matrix with the compressed springs."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.setup.loads import traction_force
from softway.errors import InputError
from softway.model.model import Model
from softway.solve.linear.backends.choice import best_solver
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import Analysis, Factor
from softway.solve.operators.factored import FEW

LEAST = 0.1
"""Smallest nodal area as a fraction of the mean; corners of quadratic facets have zero area."""


def springs(model: Model, factor: float) -> Array:
    """Spring stiffness (m,) of the contact rows, ``factor E A / l`` [N/m].

    ``A`` is the area and ``l`` the edge length at the slave node; ``E = rho c^2`` is the plane-wave modulus, the
    greatest of the materials of the body.
    """
    node = model.contacts.node
    out = np.zeros(len(node))
    for k, contact in enumerate(model.scene.contacts):
        for part, tag in _sides(model, contact.body, contact.tag, contact.opponent, contact.opponent_tag):
            inside = (node >= part.nodes.start) & (node < part.nodes.stop)
            here = np.flatnonzero((model.contacts.contact == k) & inside)
            area = _areas(part, tag)[node[here] - part.nodes.start]
            area = np.maximum(area, LEAST * area.mean()) if len(area) else area
            density, speed = part.materials.stiffest(part.internal.section)
            modulus = density * speed**2
            out[here] = factor * modulus * area / model.edge[node[here]]
    return out


def _sides(model: Model, body: str, tag: str, opponent: str, opponent_tag: str) -> list[tuple[DiscreteSolid, str]]:
    """Solids of a contact, with their tags."""
    tags = {opponent: opponent_tag, body: tag}
    return [(p, tags[p.name]) for p in model.parts if p.name in tags]


def _areas(part: DiscreteSolid, tag: str) -> Array:
    """Area (n,) of the facets of a tag, lumped to the nodes [m^2]."""
    along = (1.0,) + (0.0,) * (part.mesh.dim - 1)
    try:
        return traction_force(part.mesh, part.internal.section, tag, along)[:, 0]
    except InputError:  # nodes without a whole facet
        return traction_force(part.mesh, part.internal.section, "surface", along)[:, 0]


def squeezed(before: Array, after: Array) -> tuple[Array, Array]:
    """Mean force of unit springs over a slab, and its derivative with respect to the depth at the end.

    The force is the secant of the stored energy ``1/2 max(d, 0)^2`` between the depths (m,) before and after [m]. The
    springs therefore conserve energy, whenever contact opens and closes.

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
    """Factorisation of ``M + h^2/4 (K + G^T k G)``; the pattern grows with the pairs in contact.

    Parameters
    ----------
    base
        Numbers ``column f + row`` of the entries without contact (b,).
    keys, where
        Numbers of all entries so far (z,), ascending, and positions of the base among them.
    pattern
        Row indices and column pointers of all entries so far.
    size
        Number f of the unknowns.
    analysis
        Symbolic analysis (elimination order) of the pattern.
    made
        Number of factorisations so far.
    """

    base: IntArray
    keys: IntArray
    where: IntArray
    pattern: tuple[IntArray, IntArray]
    size: int
    analysis: Analysis | None = None
    made: int = 0

    def factored(self, matrix: sp.csc_array, rows: sp.csr_array, stiffness: Array) -> tuple[Factor, "Workshop"]:
        """Factor ``matrix + rows^T stiffness rows`` with rows (k, f); return the factor and the new workshop.

        Raises
        ------
        NoConvergence
            If the matrix is singular.
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
            analysis = (SuperLU() if self.size < FEW else best_solver("double")).analyse(whole)
        return analysis.factor(whole), replace(ready, analysis=analysis, made=ready.made + 1)

    def _holding(self, entries: IntArray) -> tuple["Workshop", IntArray]:
        """Workshop whose pattern includes the given entries (e,), and their positions."""
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
    """Workshop of a model, still without contact entries."""
    size = model.dofs.size
    matrix = model.inertia_and_stiffness(model.displacement, 1.0)
    keys = _keys(matrix.indptr, matrix.indices, size)
    return Workshop(base=keys, keys=keys, where=np.arange(len(keys)), pattern=_pattern(keys, size), size=size)


def _pattern(keys: IntArray, size: int) -> tuple[IntArray, IntArray]:
    """Row indices and column pointers of entries with ascending numbers."""
    column, row = np.divmod(keys, size)
    return row.astype(np.int32), np.searchsorted(column, np.arange(size + 1)).astype(np.int32)


def _keys(indptr: IntArray, indices: IntArray, size: int) -> IntArray:
    """Numbers ``column size + row`` of the entries of a matrix."""
    columns = np.repeat(np.arange(len(indptr) - 1, dtype=np.int64), np.diff(indptr))
    return np.asarray(columns * size + indices)
