"""Solids whose meshes change, by groups of those that ties, or contacts of nodes with inertia, link."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.linked_solids import AnyBody, Glue, LinkedSolids, solids_of
from softway.adaptivity.projections.projection import AnyProjection, Unchanged, projection
from softway.adaptivity.transfer import Motion
from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.dof_map import CombinedDofs, DofMap, NodalDofs
from softway.marching.remeshing.adapted_scene import AdaptedScene
from softway.meshes.adaptive.values_at_nodes import values_at_nodes
from softway.model.model import Model


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinkedChange:
    """Change of the meshes of a solid, or of several that ties link.

    Parameters
    ----------
    names
        Names of the solids.
    before, after
        The solids on both meshes.
    nodes
        Their nodes among those of the old and the new model, (n,) and (m,).
    cast
        Projections.
    """

    names: tuple[str, ...]
    before: AnyBody
    after: AnyBody
    nodes: tuple[IntArray, IntArray]
    cast: AnyProjection

    @property
    def changed(self) -> list[str]:
        """Names of the solids whose mesh changes."""
        solids = zip(self.names, solids_of(self.before), solids_of(self.after), strict=True)
        return [name for name, one, other in solids if one.adapted is not other.adapted]

    def velocity(self, field: Array, out: Array) -> None:
        """Project a velocity or acceleration (n, d) of the old model into one of the new model."""
        out[self.nodes[1]] = self.cast.velocity(field[self.nodes[0]])

    def displacement(self, field: Array, out: Array) -> None:
        """Project a displacement (n, d) of the old model into one of the new model [m]."""
        out[self.nodes[1]] = self.cast.displacement(field[self.nodes[0]])

    def motion(self, displacement: Array, velocity: Array) -> Motion:
        """Motion of the solids in the old model."""
        return Motion(displacement=displacement[self.nodes[0]], velocity=velocity[self.nodes[0]])

    def glued(self, glue: Sequence[Glue]) -> "LinkedChange":
        """The change with ties that break between the solids."""
        if not glue or isinstance(self.cast, Unchanged):
            return self
        assert isinstance(self.after, LinkedSolids)
        after = replace(self.after, glue=tuple(glue))
        return replace(self, after=after, cast=replace(self.cast, after=after))


def linked_changes(old: AdaptedScene, new: AdaptedScene, closed: BoolArray) -> tuple[LinkedChange, ...]:
    """Changes of the meshes between two scenes, one for each group of linked solids that can change.

    Solids with nodes that have inertia are linked by the ``closed`` rows (m,) of contacts between them, too.
    """
    groups: dict[int, list[str]] = {}
    linked = _linked(old.model, closed)
    for part, group in zip(new.model.parts, linked.tolist(), strict=True):
        if part.name in new.meshes:
            groups.setdefault(group, []).append(part.name)
    return tuple(_change(old, new, tuple(names)) for names in groups.values())


def _linked(model: Model, closed: BoolArray) -> IntArray:
    """Number (parts,) of the group of each solid, linked by ties, and by ``closed`` rows of nodes with inertia."""
    linked = model.linked.copy()
    for contact in np.unique(model.contacts.contact[closed]) if inert_contacts(model) else ():
        own = np.isin(linked, linked[list(model.contact_solids[contact])])
        linked[own] = linked[own].min()
    return linked


def inert_contacts(model: Model) -> bool:
    """True if nodes that touch have inertia."""
    return model.inert and not model.timing.massless


def _change(old: AdaptedScene, new: AdaptedScene, names: tuple[str, ...]) -> LinkedChange:
    """Change of the meshes of some solids."""
    nodes = nodes_of(old.model, names), nodes_of(new.model, names)
    before, after = _body(old, names, nodes[0]), _body(new, names, nodes[1])
    return LinkedChange(names=names, before=before, after=after, nodes=nodes, cast=projection(before, after))


def nodes_of(model: Model, names: Sequence[str]) -> IntArray:
    """Nodes (n,) of some solids in a model."""
    parts = {part.name: part.nodes for part in model.parts}
    return np.concatenate([np.arange(parts[name].start, parts[name].stop) for name in names])


def _body(scene: AdaptedScene, names: Sequence[str], nodes: IntArray) -> AnyBody:
    """A solid by itself, or several that are linked."""
    solids = tuple(scene.solid(name) for name in names)
    if len(solids) == 1:
        return solids[0]
    mass, follow = (sp.csr_array(m[nodes][:, nodes]) for m in (scene.model.mass, scene.model.follow))
    dofs, touching = _some(scene.model.dofs, nodes), inert_contacts(scene.model)
    return LinkedSolids(solids=solids, dofs=dofs, mass=mass, follow=follow, touching=touching)


def _some(dofs: DofMap, nodes: IntArray) -> DofMap:
    """Map of the unknowns of some nodes (k,), which move no others."""
    d = dofs.free.shape[1]
    if not isinstance(dofs, CombinedDofs):
        return NodalDofs(dofs.free[nodes])
    at = (d * nodes[:, None] + np.arange(d)).ravel()
    rows = sp.csc_array(dofs.jacobian[at])
    own = sp.csr_array(rows[:, np.flatnonzero(np.diff(rows.indptr))])
    inclined, follow = (None if m is None else sp.csr_array(m[at][:, at]) for m in (dofs.inclined, dofs.follow))
    return CombinedDofs(own, d, inclined, follow)


def values_between(pairs: Mapping[str, tuple[AdaptedSolid, AdaptedSolid]]) -> Mapping[str, sp.csr_array]:
    """Values (m, n) at the nodes of each solid on its new mesh of fields on the old one; without those whose mesh
    stays.
    """
    return {
        name: values_at_nodes(one.adapted, other.adapted).forward
        for name, (one, other) in pairs.items()
        if one.adapted is not other.adapted
    }


def all_values(model: Model, values: Mapping[str, sp.csr_array]) -> sp.csr_array:
    """Values (m, n) at the nodes of all solids of fields on the old meshes."""
    blocks = [
        values[part.name] if part.name in values else sp.eye_array(part.mesh.n_nodes, format="csr")
        for part in model.parts
    ]
    return sp.csr_array(sp.block_diag(blocks, format="csr"))
