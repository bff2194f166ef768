"""Conditions on the velocity of a solid: momenta of rigid motions, and normal velocities at contacts that stay closed
(docs/theory/bodies/adaptive.md#balances).
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from softway.arrays import Array
from softway.bodies.dof_map import DofMap
from softway.bodies.elements.section import Section

DEPENDENT = 1e-9
"""Relative inertia below which a condition follows from the others."""
BATCH = 64
"""Rows whose motions are computed together."""


class MassiveSolid(Protocol):
    """Solid of n nodes with its nodal mass matrix (n, n) [kg]."""

    @property
    def dofs(self) -> DofMap:
        """Velocities of the nodes from the unknowns."""
        ...

    @property
    def section(self) -> Section:
        """Section of the solid."""
        ...

    @property
    def mass(self) -> sp.csr_array:
        """Mass matrix."""
        ...

    @property
    def points(self) -> Array:
        """Reference places (n, d) of the nodes [m]."""
        ...

    def kinetic(self, velocity: Array) -> float:
        """Kinetic energy [J] at a velocity (n, d) [m/s]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClosedRows:
    """Contact rows (k, n d) of a solid that stay closed, and the normal velocities (k,) that they have [m/s]."""

    gradient: sp.csr_array
    velocity: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Conditions:
    """Conditions ``C v = c``, with the closed rows G and the momenta of rigid motions Z: ``C = [G; Z^T M]``.

    Parameters
    ----------
    solid
        The solid.
    motions
        Free rigid motions Z (n d, m).
    rows
        Closed rows G (k, n d).
    factor
        Factor of the mass matrix of the unknowns; None without rows.
    inverse
        Pseudo-inverse (k + m, k + m) of ``C M^-1 C^T``.
    scale
        Factor of the rows, with which they are of the size of the momenta.
    """

    solid: MassiveSolid
    motions: Array
    rows: sp.csr_array
    factor: SuperLU | None
    inverse: Array
    scale: float

    def of(self, velocity: Array) -> Array:
        """Values (k + m,) of a velocity (n, d)."""
        return np.concatenate([self.rows @ velocity.ravel(), self.motions.T @ (self.solid.mass @ velocity).ravel()])

    def change(self, values: Array) -> Array:
        """Velocity (n, d) of least energy with given values (k + m,)."""
        k = self.rows.shape[0]
        scaled = np.concatenate([self.scale * values[:k], values[k:]])
        found = self.inverse @ scaled
        out = np.asarray(self.motions @ found[k:])
        if self.factor is not None:
            out = out + _moved(self.solid, self.factor, self.scale * (self.rows.T @ found[:k])).ravel()
        return np.asarray(out.reshape(self.solid.mass.shape[0], -1))


def conditions_of(solid: MassiveSolid, motions: Array, closed: ClosedRows | None = None) -> Conditions:
    """Conditions on the velocity of a solid with free rigid motions (n d, m) and closed rows.

    Examples
    --------
    Two unit masses on a line move together, and the second one stops at a wall: the first has all momentum.

    >>> from types import SimpleNamespace
    >>> from softway.bodies.dof_map import NodalDofs
    >>> pair = SimpleNamespace(dofs=NodalDofs(np.ones((2, 1), bool)), mass=sp.csr_array(sp.eye_array(2)))
    >>> wall = ClosedRows(gradient=sp.csr_array([[0.0, -1.0]]), velocity=np.zeros(1))
    >>> found = conditions_of(pair, np.ones((2, 1)), wall)
    >>> found.change(np.array([0.0, 2.0])).ravel().round(12).tolist()
    [2.0, 0.0]
    """
    n, inertia = solid.mass.shape[0], _inertia(solid, motions)
    rows = sp.csr_array((0, len(motions))) if closed is None else closed.gradient
    k = rows.shape[0]
    if not k:
        inverse = _pseudo_inverse(inertia)
        return Conditions(solid=solid, motions=motions, rows=rows, factor=None, inverse=inverse, scale=1.0)
    d = len(motions) // n
    factor = splu(solid.dofs.matrix(sp.csc_array(sp.kron(solid.mass, sp.eye_array(d), format="csc"))))
    felt = np.empty((k, k))
    for first in range(0, k, BATCH):
        some = rows[first : first + BATCH].toarray().T
        columns = [_moved(solid, factor, column).ravel() for column in some.T]
        felt[:, first : first + BATCH] = rows @ np.array(columns).T
    mixed = np.asarray(rows @ motions)
    size, most = float(felt.diagonal().max()), float(inertia.diagonal().max(initial=0.0))
    scale = float(np.sqrt(most / size)) if most > 0.0 and size > 0.0 else 1.0
    both = np.block([[scale**2 * felt, scale * mixed], [scale * mixed.T, inertia]])
    inverse = _pseudo_inverse(0.5 * (both + both.T))
    return Conditions(solid=solid, motions=motions, rows=rows, factor=factor, inverse=inverse, scale=scale)


def _pseudo_inverse(matrix: Array) -> Array:
    """Pseudo-inverse (k, k) of a symmetric matrix, without conditions that follow from others."""
    return np.asarray(np.linalg.pinv(matrix, rcond=DEPENDENT, hermitian=True), dtype=np.float64)


def _inertia(solid: MassiveSolid, motions: Array) -> Array:
    """Inertia (m, m) of rigid motions."""
    n = solid.mass.shape[0]
    return np.asarray(motions.T @ (solid.mass @ motions.reshape(n, -1)).reshape(len(motions), -1))


def _moved(solid: MassiveSolid, factor: SuperLU, impulse: Array) -> Array:
    """Velocity (n, d) by impulses (n d,)."""
    return solid.dofs.nodes(factor.solve(solid.dofs.forces(impulse.reshape(solid.mass.shape[0], -1))))
