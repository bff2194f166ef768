"""Projection of fields of a solid with hanging nodes, on the overlay of two meshes
(docs/theory/bodies/adaptive.md#transfer).
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.arrays import Array
from softway.bodies.discretised import discretise
from softway.meshes.adaptive.overlay import common_matrix, embedding, overlay, united


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OverlayProjection:
    """Projections of nodal fields of a solid from its mesh A, n nodes, to its mesh B, m nodes.

    Supported components have the values of the field at their nodes.

    Parameters
    ----------
    after
        The solid on B.
    at_nodes
        (m, n) values of a field of A at the nodes of B.
    common, mass
        (n, m) common mass matrix, and consistent mass matrix (m, m) of B [kg].
    stiff, stiff_common
        Form of the displacements on B, (m d, m d), and its common matrix (m d, n d) [kg].
    factored, stiff_factored
        Factors of ``mass`` and ``stiff`` on the unknowns of B.
    """

    after: AdaptedSolid
    at_nodes: sp.csr_array
    common: sp.csr_array
    mass: sp.csr_array
    stiff: sp.csc_array
    stiff_common: sp.csr_array
    factored: SuperLU
    stiff_factored: SuperLU

    def velocity(self, field: Array) -> Array:
        """Projection (m, d) of a field (n, d) with the mass: velocities, accelerations; the values at the nodes of B,
        corrected.
        """
        near, dofs = np.asarray(self.at_nodes @ field), self.after.part.dofs
        right = self.common.T @ field - self.mass @ near
        return np.asarray(near + dofs.nodes(self.factored.solve(dofs.forces(right))))

    def displacement(self, field: Array) -> Array:
        """Projection (m, d) of a displacement (n, d) [m] with mass and stiffness."""
        near, dofs = np.asarray(self.at_nodes @ field), self.after.part.dofs
        right = (self.stiff_common @ field.ravel() - self.stiff @ near.ravel()).reshape(near.shape)
        return np.asarray(near + dofs.nodes(self.stiff_factored.solve(dofs.forces(right))))


def overlay_projection(before: AdaptedSolid, after: AdaptedSolid) -> OverlayProjection:
    """Projections of a solid from its mesh ``before`` to its mesh ``after``, see
    :func:`~softway.adaptivity.projections.projection.projection`.

    Raises
    ------
    InputError
        If the meshes have different bases.
    """
    both = _on_united(before, after)
    ours, theirs = embedding(after.adapted, both.adapted), embedding(before.adapted, both.adapted)
    d = after.points.shape[1]
    nodal = _mass(both)
    form = _form(both, nodal)
    wide, wide_before = (sp.csr_array(sp.kron(m, sp.eye_array(d))) for m in (ours, theirs))
    stiff = sp.csc_array(wide.T @ form @ wide)
    mass = sp.csr_array(ours.T @ nodal @ ours)
    dofs = after.part.dofs
    return OverlayProjection(
        after=after,
        at_nodes=_at_nodes(ours, theirs, after),
        common=sp.csr_array(theirs.T @ nodal @ ours),
        mass=mass,
        stiff=stiff,
        stiff_common=sp.csr_array(wide.T @ form @ wide_before),
        factored=splu(dofs.matrix(_wide(mass, d))),
        stiff_factored=splu(dofs.matrix(stiff)),
    )


def _on_united(before: AdaptedSolid, after: AdaptedSolid) -> AdaptedSolid:
    """The solid on the united mesh: one of the two where it has the other's cells or smaller ones everywhere."""
    found = united(before.adapted, after.adapted)
    for known in (before, after):
        if found is known.adapted:
            return known
    solid = replace(after.solid, mesh=found.mesh)
    none = sp.csr_array((found.mesh.n_nodes,) * 2)
    return AdaptedSolid(solid=solid, adapted=found, part=discretise("", solid, 0), mass=none, follow=none)


def _mass(both: AdaptedSolid) -> sp.csr_array:
    """Consistent mass matrix (n, n) [kg]."""
    masses = both.element_masses()
    return common_matrix(overlay(both.adapted, both.adapted), masses, masses)


def _form(both: AdaptedSolid, mass: sp.csr_array) -> sp.csc_array:
    """Mass plus the stiffness of the undeformed solid times the square of a time, (n d, n d) [kg]."""
    part = both.part
    size = float(np.linalg.norm(np.ptp(both.points, axis=0)))
    time = size / min(part.materials.speeds(part.internal.section))
    return sp.csc_array(_wide(mass, both.points.shape[1]) + time**2 * part.tangent(np.zeros(both.points.shape)))


def _wide(mass: sp.csr_array, d: int) -> sp.csc_array:
    """Matrix (n d, n d) that acts on each of d components as ``mass`` (n, n)."""
    return sp.csc_array(sp.kron(mass, sp.eye_array(d), format="csc"))


def _at_nodes(ours: sp.csr_array, theirs: sp.csr_array, after: AdaptedSolid) -> sp.csr_array:
    """Values (m, n) at the nodes of a mesh from those of another one by both embeddings; hanging nodes follow."""
    found, hanging = sp.csr_array(theirs[_node_rows(ours)]), after.adapted.mesh.hanging
    return found if hanging is None else sp.csr_array(hanging.follow(found.shape[0]) @ found)


def _node_rows(into: sp.csr_array) -> np.ndarray:
    """Row of an embedding (n, m) at each of the m nodes: the one whose only value is one; any for hanging nodes."""
    entries = into.tocoo()
    own = entries.data == 1.0  # a shape function is one at its node alone; its values here are exact
    rows = np.zeros(into.shape[1], dtype=np.int64)
    rows[entries.col[own]] = entries.row[own]
    return rows
