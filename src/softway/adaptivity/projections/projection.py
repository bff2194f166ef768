"""Projection of fields from one adapted mesh of a solid to another (docs/theory/bodies/adaptive.md#transfer).

A field of mesh A goes to mesh B by its values at the nodes of B, and a correction: the projection of the rest, which is
zero but in cells of B that are larger than those of A, and of what ties change of the values.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.linked_solids import AnyBody, LinkedSolids, solids_of
from softway.adaptivity.projections.conjugate_gradients import conjugate_gradients
from softway.arrays import Array
from softway.meshes.adaptive.values_at_nodes import ValuesAtNodes, values_at_nodes, values_of_base

EXACT = 1e-14
"""Relative residual of the projection with the mass."""
CLOSE = 1e-4
"""Relative residual of the projection with mass and stiffness: the energy of the correction is exact to its square."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Projection:
    """Projections of nodal fields of a solid, or of several that ties link, from mesh A, n nodes, to mesh B, m nodes.

    Supported components have the values of the field at their nodes.

    Parameters
    ----------
    before, after
        The solid, or the solids, on A and on B.
    values
        Values of fields of each mesh at the nodes of the other.
    masses
        Consistent mass matrices (n, n) of A and (m, m) of B [kg].
    time
        Time t of the form of the displacements, ``M + t^2 K`` [s].
    """

    before: AnyBody
    after: AnyBody
    values: ValuesAtNodes
    masses: tuple[sp.csr_array, sp.csr_array]
    time: float

    @property
    def at_nodes(self) -> sp.csr_array:
        """Values (m, n) of fields of A at the nodes of B."""
        return self.values.forward

    def velocity(self, field: Array) -> Array:
        """Projection (m, d) of a field (n, d) with the mass: velocities, accelerations."""
        near, rest, change = self._near(field)
        right = np.asarray(self.values.back.T @ (self.masses[0] @ rest))
        if change is not None:
            right += self.masses[1] @ change
        return near + self._corrected(self.after.dofs.forces(right))

    def displacement(self, field: Array) -> Array:
        """Projection (m, d) of a displacement (n, d) [m] with mass and stiffness."""
        near, rest, change = self._near(field)
        square = self.time**2
        right = np.asarray(self.values.back.T @ (self.masses[0] @ rest + square * self.before.stretched(rest)))
        if change is not None:
            right += self.masses[1] @ change + square * self.after.stretched(change)
        if isinstance(self.after, LinkedSolids):
            right += square * self.after.pulled(near)
        return near + self._relaxed(self.after.dofs.forces(right))

    def _near(self, field: Array) -> tuple[Array, Array, Array | None]:
        """Values (m, d) of a field (n, d) at the nodes of B as ties allow, the rest (n, d) at the nodes of A, and the
        change (m, d) by the ties.
        """
        values = np.asarray(self.values.forward @ field)
        near = self.after.fitting(values)
        return near, np.asarray(field - self.values.back @ values), None if near is values else values - near

    def _corrected(self, right: Array) -> Array:
        """Correction (m, d) with the mass by forces (f,) on the unknowns."""
        dofs, mass = self.after.dofs, self.masses[1]
        if not right.any():
            return dofs.nodes(right)
        d = self.after.points.shape[1]
        inverse = dofs.block_inverse(mass.diagonal()[:, None, None] * np.eye(d))
        found = conjugate_gradients(
            lambda x: dofs.forces(np.asarray(mass @ dofs.nodes(x))), lambda r: inverse @ r, right, EXACT
        )
        return dofs.nodes(found)

    def _relaxed(self, right: Array) -> Array:
        """Correction (m, d) with mass and stiffness by forces (f,) on the unknowns."""
        dofs, d = self.after.dofs, self.after.points.shape[1]
        if not right.any():
            return dofs.nodes(right)
        wide = sp.csc_array(sp.kron(self.masses[1], sp.eye_array(d), format="csc"))
        form = dofs.matrix(sp.csc_array(wide + self.time**2 * self.after.stiffness()))
        if dofs.components is None or isinstance(self.after, LinkedSolids):
            return dofs.nodes(splu(form).solve(right))
        rows = sp.csr_array(form)
        diagonal, coarse = 1.0 / rows.diagonal(), _coarse(self.after, rows)
        found = conjugate_gradients(lambda x: rows @ x, lambda r: diagonal * r + coarse(r), right, CLOSE)
        return dofs.nodes(found + coarse(right - rows @ found))  # with the centre of mass of the exact projection


@dataclass(frozen=True, slots=True)
class Unchanged:
    """Projections between two meshes that are the same: fields keep their values."""

    def velocity(self, field: Array) -> Array:
        """The field (n, d)."""
        return field

    def displacement(self, field: Array) -> Array:
        """The field (n, d)."""
        return field


AnyProjection = Projection | Unchanged
"""Projection of fields from one mesh to another."""


def projection(before: AnyBody, after: AnyBody) -> AnyProjection:
    """Projections of a solid, or of several that ties link, from its mesh ``before`` to its mesh ``after``.

    Velocities are projected with the mass M, displacements with ``M + t^2 K``: K is the stiffness of the undeformed
    solid, t the time in which its slowest wave crosses it.

    Parameters
    ----------
    before, after
        The solid on two meshes of one base, or the solids.

    Raises
    ------
    InputError
        If the meshes have different bases.

    Examples
    --------
    >>> import softway as sw
    >>> from softway.adaptivity.adapted_solid import adapted_solid
    >>> from softway.meshes.adaptive.refinement import refined
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=1), material=sw.LinearElastic(E=1.0), density=1.0)
    >>> fine, coarse = (adapted_solid("bar", bar, refined(bar.mesh.build(), np.array([k])), ()) for k in (1, 0))
    >>> projection(fine, coarse).velocity(np.array([[0.0], [0.0], [1.0]])).round(12).ravel().tolist()
    [0.5, 0.5]
    """
    pairs = list(zip(solids_of(before), solids_of(after), strict=True))
    if all(one.adapted is other.adapted for one, other in pairs):
        return Unchanged()
    found = [values_at_nodes(one.adapted, other.adapted) for one, other in pairs]
    return Projection(
        before=before,
        after=after,
        values=found[0] if len(found) == 1 else _together(found),
        masses=(before.consistent_mass(), after.consistent_mass()),
        time=after.crossing,
    )


def _together(values: list[ValuesAtNodes]) -> ValuesAtNodes:
    """Values of the fields of several solids."""
    forward, back = (
        sp.csr_array(sp.block_diag([getattr(one, name) for one in values], format="csr"))
        for name in ("forward", "back")
    )
    return ValuesAtNodes(forward=forward, back=back)


def _coarse(after: AdaptedSolid, form: sp.csr_array) -> Callable[[Array], Array]:
    """Correction (f,) in the fields of the base mesh of a residual (f,), with the ``form`` (f, f)."""
    dofs, base = after.dofs, after.adapted.base
    assert dofs.components is not None
    values = sp.kron(values_of_base(after.adapted), sp.eye_array(base.dim), format="csr")
    into = sp.csr_array(values[dofs.components][:, np.flatnonzero(dofs.free[: base.n_nodes])])
    onto = sp.csr_array(into.T)
    factor = splu(sp.csc_array(onto @ form @ into))
    return lambda r: into @ factor.solve(onto @ r)
