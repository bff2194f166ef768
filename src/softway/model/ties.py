"""Ties of a model: nodes that follow others, the unknowns that are left, and nodes that share the lack of inertia."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid, Moved
from softway.bodies.dof_map import CombinedDofs, DofMap, NodalDofs
from softway.contact.assembly.assemble import Joined
from softway.contact.assembly.tied_surfaces import TiedSurfaces
from softway.contact.mortar.following import Following
from softway.errors import InputError, within
from softway.model.cohesive_ties import CohesiveTies
from softway.tolerances import MOTION

ALIKE = 1e-9
"""Difference of weights below which two ties say the same about a node."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Glue:
    """Nodes that follow others.

    Parameters
    ----------
    pairs
        The surfaces of the ties.
    follow
        (n, n) motion of all nodes from that of those that follow none, whose rows are those of the identity.
    """

    pairs: tuple[TiedSurfaces, ...]
    follow: sp.csr_array

    def dofs(self, own: DofMap) -> DofMap:
        """Unknowns of the glued solids from those of the single ones."""
        if not self.pairs:
            return own
        d = own.free.shape[1]
        follow = sp.csr_array(sp.kron(self.follow, sp.eye_array(d), format="csr"))
        hanging = getattr(own, "follow", None)  # no node hangs on one of a tie
        follow = follow if hanging is None else sp.csr_array(follow @ hanging)
        jacobian = sp.csc_array(sp.kron(self.follow, sp.eye_array(d)) @ own.jacobian)
        moved = np.flatnonzero(np.diff(jacobian.indptr))
        return CombinedDofs(sp.csr_array(jacobian[:, moved]), d, getattr(own, "inclined", None), follow)

    def closing(self, points: Array, breaking: Sequence[TiedSurfaces]) -> Array:
        """Reference positions (n, d) with the nodes of these and of ``breaking`` ties on the surfaces that they are
        glued to.
        """
        onto = np.asarray(self.follow @ points) if self.pairs else points.copy()
        for way in (pair.ways[0] for pair in breaking):
            there = way.weights @ onto
            apart = np.abs(there - onto[way.node]).max(axis=1) > MOTION * np.abs(points).max()
            onto[way.node[apart]] = there[apart]
        return onto

    @property
    def joined(self) -> Joined | None:
        """What contacts have to know of the ties; None without."""
        if not self.pairs:
            return None
        kinds = dict.fromkeys(kind for pair in self.pairs for kind in pair.sealed)
        sealed = {k: np.concatenate([p.sealed[k] for p in self.pairs if k in p.sealed]) for k in kinds}
        linked = abs(self.follow)
        return Joined(sealed=sealed, neighbours=sp.csr_array(linked + linked.T + sp.eye_array(linked.shape[0])))

    def together(self, nodes: IntArray) -> IntArray:
        """Nodes (k,), and those that move with one of them."""
        if not self.pairs:
            return nodes
        label = connected_components(self.follow, directed=False)[1]
        return np.flatnonzero(np.isin(label, label[nodes]))

    @property
    def moving(self) -> IntArray:
        """Nodes (k,) that move with others."""
        if not self.pairs:
            return np.zeros(0, int)
        label = connected_components(self.follow, directed=False)[1]
        return np.flatnonzero(np.bincount(label)[label] > 1)

    def fitting(self, field: Array, name: str, parts: Sequence[DiscreteSolid]) -> Array:
        """Initial field (n, d) without the rounding by which glued surfaces differ.

        Raises
        ------
        InputError
            If they differ by more.
        """
        if not self.pairs:
            return field
        out = np.asarray(self.follow @ field)
        wrong = np.abs(out - field).max(axis=1)
        if wrong.max() > MOTION * np.abs(field).max():
            node = int(np.argmax(wrong))
            pair = next(pair for pair in self.pairs if node in np.concatenate([w.node for w in pair.ways]))
            body = next(p.name for p in parts if p.nodes.start <= node < p.nodes.stop)
            problem = f"it differs by {wrong[node]:.3g} from that of the surface that ties[{pair.number}] glues it to"
            raise InputError(f"bodies.{body}.{name}", problem, f"the same {name} on {' and '.join(pair.tie.between)}")
        return out


def glued(pairs: Sequence[TiedSurfaces], own: DofMap, driven: Sequence[Moved]) -> Glue:
    """Nodes that follow others by the ties, one tie after another.

    A condition that earlier ones imply is left out, such as the last one where four matching blocks meet.

    Raises
    ------
    InputError
        If a node would have to follow two surfaces, or one with supports of its own.
    """
    n = len(own.free)
    moved = np.zeros(own.free.shape, bool)
    for _, where in driven:
        moved[where] = True
    follow = sp.csr_array(sp.eye_array(n))
    for pair in pairs:
        with within(f"ties[{pair.number}].between"):
            follow = _by_any(follow, pair.ways, own, np.asarray(moved.any(axis=1)))
    return Glue(pairs=tuple(pairs), follow=follow)


def _by_any(follow: sp.csr_array, ways: Sequence[Following], own: DofMap, driven: BoolArray) -> sp.csr_array:
    """Motion (n, n) of all nodes with one more tie, by the first way that is possible."""
    *better, last = ways
    for way in better:
        try:
            return _with(follow, way, own, driven)
        except InputError:
            continue
    return _with(follow, last, own, driven)


def _with(follow: sp.csr_array, way: Following, own: DofMap, driven: BoolArray) -> sp.csr_array:
    """Motion (n, n) of all nodes with the nodes of one more surface that follow."""
    target = sp.csr_array(way.weights @ follow)
    left = abs(follow[way.node] - target).max(axis=1).toarray().ravel() > ALIKE
    node, target = way.node[left], sp.csr_array(target[left])
    bound = np.diff(follow.indptr)[node] != 1
    bound |= follow.diagonal()[node] != 1.0
    used = np.unique(target.indices[target.data != 0.0])
    if bound.any() or np.isin(used, node).any():
        count = int(bound.sum()) or int(np.isin(used, node).sum())
        remedy = "tags that share no nodes with those of other ties, or matching meshes where they meet"
        raise InputError("", f"{count} of its nodes also follow another tie", remedy)
    _require_free(node, target, used, own, driven)
    rest = np.setdiff1d(np.arange(len(driven)), node)
    each = sp.csr_array((np.ones(len(rest)), (rest, rest)), shape=follow.shape)
    place = sp.csr_array((np.ones(len(node)), (node, np.arange(len(node)))), shape=(follow.shape[0], len(node)))
    return sp.csr_array(follow @ (each + place @ target))


def _require_free(node: IntArray, target: sp.csr_array, used: IntArray, own: DofMap, driven: BoolArray) -> None:
    """Refuse nodes with drives, or with supports that the nodes that they follow do not have."""
    count = int(driven[node].sum() + driven[used].sum())
    if count:
        remedy = "a support on a tag without nodes of the tie"
        raise InputError("", f"{count} of its nodes have a driven support", remedy)
    held = np.flatnonzero(~own.unsupported[node])
    d = own.free.shape[1]
    moved = np.diff(sp.csr_array(sp.kron(target[held], sp.eye_array(d), format="csr") @ own.jacobian).indptr) > 0
    fixed = ~own.free[node[held]]
    inclined = ~fixed.any(axis=1)
    wrong = (moved.reshape(-1, d) & fixed).any(axis=1) | inclined
    if wrong.any():
        remedy = "the support on the other surface only, or on a tag without nodes of the tie"
        raise InputError("", f"{int(wrong.sum())} of its nodes have a support and would follow free nodes", remedy)


def require_even(pairs: Sequence[TiedSurfaces], parts: Sequence[DiscreteSolid]) -> None:
    """Refuse tied nodes that hang, or on which nodes hang.

    Raises
    ------
    InputError
        With the place of the tie.
    """
    hanging = [(part, part.mesh.hanging) for part in parts if part.mesh.hanging is not None]
    both = [np.column_stack([one.node, one.parents]) + part.nodes.start for part, one in hanging]
    for pair in pairs if both else ():
        tied = np.concatenate([surface.side.nodes for surface in pair.surfaces])
        wrong = sum(int(np.isin(nodes, tied).any(axis=1).sum()) for nodes in both)
        if wrong:
            remedy = "cells of one size along the surfaces, softway.adaptivity.marking.even_surface.even"
            raise InputError(f"ties[{pair.number}].between", f"{wrong} hanging nodes at tied nodes", remedy)


def joined(maps: Sequence[DofMap]) -> DofMap:
    """Map of several bodies with nodes and unknowns in order."""
    if all(m.components is not None for m in maps):
        return NodalDofs(np.concatenate([m.free for m in maps]))
    none = [sp.csr_array((m.free.size, m.free.size)) for m in maps]
    whole = [sp.csr_array(sp.eye_array(m.free.size)) for m in maps]
    return CombinedDofs(
        sp.csr_array(sp.block_diag([m.jacobian for m in maps], format="csr")),
        maps[0].free.shape[1],
        _together(maps, "inclined", none),
        _together(maps, "follow", whole),
    )


def _together(maps: Sequence[DofMap], name: str, others: Sequence[sp.csr_array]) -> sp.csr_array | None:
    """Matrix of all maps by its name, with that of ``others`` for maps that have none; None if no map has one."""
    found = [getattr(m, name, None) for m in maps]
    if all(one is None for one in found):
        return None
    blocks = [other if one is None else one for one, other in zip(found, others, strict=True)]
    return sp.csr_array(sp.block_diag(blocks, format="csr"))


def linked_parts(part_of: IntArray, parts: int, dofs: DofMap, bonds: Sequence[CohesiveTies] = ()) -> IntArray:
    """Group (parts,) of each solid; solids that share unknowns, or that a tie joins which may break, have the same."""
    links = sp.csr_array(sp.eye_array(parts))
    if dofs.components is None:
        of = np.repeat(part_of, dofs.free.shape[1])
        shares = sp.csr_array((np.ones(len(of)), (of, np.arange(len(of))))) @ abs(dofs.jacobian)
        links = sp.csr_array(shares @ shares.T)
    for bond in bonds:
        of = sp.csr_array((np.ones(len(part_of)), (part_of, np.arange(len(part_of)))))
        for tie in bond.ties:
            shares = of @ abs(tie.jump.rows).T
            links = sp.csr_array(links + shares @ shares.T)
    return np.asarray(connected_components(links)[1])
