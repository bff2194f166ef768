"""Supports along directions that are no axes: degrees of freedom of their nodes, and the velocities that they give.

A node with the supported directions C (k, d) and their velocities g (k,) moves by ``v = T w + C^+ g``: the columns of T
are an orthonormal basis of the directions perpendicular to C.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.dof_map import CombinedDofs, DofMap, NodalDofs
from softway.bodies.setup.supports import Carried, Driven, Fixed, Guided, Support
from softway.errors import InputError, within
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh

ALIKE = 1e-6
"""Sine of the angle between a direction and the span of others below which it lies in it."""
CLEAN = 1e-14
"""Component of a unit vector that is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Held:
    """Supported directions of a node: ``directions`` (k, d) and the number of the support of each."""

    directions: Array
    supports: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DirectedMotion:
    """Motion of nodes by driven supports along directions: ``shares`` (s, c) of the supports in their components."""

    supports: tuple[Driven | Guided, ...]
    shares: Array

    @property
    def greatest_speed(self) -> float:
        """Bound of the speed of a component [m/s]."""
        return float((np.array([s.greatest_speed for s in self.supports]) @ np.abs(self.shares)).max(initial=0.0))

    def at(self, time: float) -> Array:
        """Velocities (c,) at a time [m/s]."""
        return np.asarray(np.array([s.at(time) for s in self.supports]) @ self.shares)

    def bends(self, start: float, end: float) -> tuple[tuple[float, Array], ...]:
        """Bends (c,) of the velocities inside a slab, see :meth:`~softway.bodies.Driven.bends`."""
        found = zip(self.supports, self.shares, strict=True)
        return tuple((tau, change * share) for s, share in found for tau, change in s.bends(start, end))


def directed(support: Support) -> bool:
    """True for a support along a direction in place of components."""
    return not isinstance(support, Carried) and len(support.direction) > 0


def directions(support: Fixed | Driven | Guided, mesh: Mesh) -> tuple[IntArray, Array]:
    """Nodes (m,) of a directed support, and its unit direction (m, d) at each.

    Raises
    ------
    InputError
        If the direction has another dimension or no length, or a node has no facet of the tag whose normal it could be.
    """
    with within("on"):
        nodes = mesh.nodes(support.on)
    if support.direction == "normal":
        return nodes, _normals(support.on, mesh, nodes)
    along = np.asarray(support.direction, float)
    if len(along) != mesh.dim:
        raise InputError("direction", f"{len(along)} components in {mesh.dim}D", f"{mesh.dim} components")
    return nodes, np.tile(along / np.linalg.norm(along), (len(nodes), 1))


def _normals(tag: str, mesh: Mesh, nodes: IntArray) -> Array:
    """Unit normals (m, d) of a side at nodes (m,): the mean over its facets there, weighted by area."""
    if mesh.dim == 1:
        raise InputError("direction", "a normal in one dimension", 'components = "x" without direction')
    total = np.zeros((mesh.n_nodes, mesh.dim))
    for name, facets in mesh.facets_on(tag).items():
        x = mesh.points[facets[:, : CELLS[name].corners]]
        if mesh.dim == 2:
            area = (x[:, 1] - x[:, 0]) @ np.array([[0.0, -1.0], [1.0, 0.0]])
        else:
            first, second = (
                (x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) if x.shape[1] == 3 else (x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
            )
            area = 0.5 * np.cross(first, second)
        np.add.at(total, facets, area[:, None])
    size = np.linalg.norm(total[nodes], axis=1)
    if not (size > 0.0).all():
        problem = f"{int((size == 0.0).sum())} nodes of {tag!r} belong to no whole facet of it"
        raise InputError("direction", problem, "a tag of a side, or a direction of numbers")
    return np.asarray(total[nodes] / size[:, None])


def held_directions(supports: Sequence[Support], mesh: Mesh, masks: Sequence[BoolArray]) -> dict[int, Held]:
    """Supported directions of all nodes with a directed support; ``masks`` (n, d) are the components of the others.

    Raises
    ------
    InputError
        Naming the support, if it asks for another motion along a direction than others do, or a rigid body carries its
        nodes.
    """
    along: dict[int, list[tuple[int, Array]]] = {}
    for k, support in enumerate(supports):
        if directed(support) and not isinstance(support, Carried):
            with within(f"supports[{k}]"):
                for node, n in zip(*directions(support, mesh), strict=True):
                    along.setdefault(int(node), []).append((k, n))
    return {node: _held(supports, [*_axes(supports, masks, node), *along[node]]) for node in sorted(along)}


def _axes(supports: Sequence[Support], masks: Sequence[BoolArray], node: int) -> Iterator[tuple[int, Array]]:
    """Axes along which supports hold a node, with the number of the support that has precedence."""
    axes = np.eye(masks[0].shape[1])
    for i, axis in enumerate(axes):
        owners = [k for k, mask in enumerate(masks) if mask[node, i]]
        moving = [k for k in owners if not isinstance(supports[k], Fixed)]
        if owners:
            yield (moving or owners)[-1], axis


def _held(supports: Sequence[Support], given: Sequence[tuple[int, Array]]) -> Held:
    """Independent ones of the directions that supports give; the others are in their span with the same motion."""
    rows: list[Array] = []
    owners: list[int] = []
    for k, n in given:
        if isinstance(supports[k], Carried):
            raise InputError(f"supports[{k}].on", "nodes of a directed support", "tags without common nodes")
        basis = np.array(rows).reshape(-1, len(n))
        shares = np.linalg.lstsq(basis.T, n, rcond=None)[0] if rows else np.zeros(0)
        if np.linalg.norm(n - shares @ basis) > ALIKE:
            rows.append(n)
            owners.append(k)
            continue
        said = [(float(s), _motion(supports[j])) for s, j in zip(shares, owners, strict=True) if abs(s) > ALIKE]
        still = all(motion is None for _, motion in said)
        same = len(said) == 1 and said[0][1] == _motion(supports[k]) and abs(said[0][0] - 1.0) <= ALIKE
        if not same and not (still and _motion(supports[k]) is None):
            problem = f"moves nodes of {supports[k].on!r} along a direction in which others hold or drive them"
            raise InputError(
                f"supports[{k}].direction", problem, "tags without common nodes, or a direction of its own"
            )
    return Held(directions=np.array(rows), supports=tuple(owners))


def _motion(support: Support) -> object:
    """What a support does along its direction; None if it holds."""
    match support:
        case Driven():
            return support.velocity, support.times
        case Guided():
            return support.travel
        case _:
            return None


def solid_dofs(held: Mapping[int, Held], free: BoolArray) -> DofMap:
    """Degrees of freedom of a solid with free components (n, d), and nodes with supported directions."""
    if not held:
        return NodalDofs(free)
    n, d = free.shape
    nodes = np.array(list(held))
    plain = free.copy()
    plain[nodes] = False
    rest = [_perpendicular(held[node].directions) for node in nodes.tolist()]
    count = plain.sum(axis=1)
    count[nodes] = [t.shape[1] for t in rest]
    first = np.concatenate([[0], np.cumsum(count)])
    node, axis = np.nonzero(plain)
    rows, columns = [node * d + axis], [first[node] + np.cumsum(plain, axis=1)[node, axis] - 1]
    values = [np.ones(len(node))]
    for j, t in zip(nodes.tolist(), rest, strict=True):
        i, k = np.nonzero(t)
        rows.append(j * d + i)
        columns.append(first[j] + k)
        values.append(t[i, k])
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    jacobian = sp.csr_array(entries, shape=(n * d, int(first[-1])))
    return CombinedDofs(jacobian, d, _projector(nodes, rest, (n, d)))


def _perpendicular(held: Array) -> Array:
    """Orthonormal basis (d, f) of the directions perpendicular to independent ones (k, d)."""
    basis = np.linalg.qr(held.T, mode="complete")[0][:, len(held) :]
    return np.where(np.abs(basis) > CLEAN, basis, 0.0)


def _projector(nodes: IntArray, rest: Sequence[Array], shape: tuple[int, int]) -> sp.csr_array:
    """Projector (n d, n d) on the supported directions of nodes, apart from components that nothing moves."""
    n, d = shape
    blocks = np.zeros((len(nodes), d, d))
    for block, t in zip(blocks, rest, strict=True):
        moved = (t != 0.0).any(axis=1)
        block[:] = (np.eye(d) - t @ t.T) * moved[:, None] * moved
    place = np.zeros(n + 1, int)
    place[nodes + 1] = 1
    return sp.csr_array(sp.bsr_array((blocks, nodes, np.cumsum(place)), shape=(n * d, n * d)))


def directed_motion(
    supports: Sequence[Support], held: Mapping[int, Held], shape: tuple[int, int]
) -> tuple[DirectedMotion, BoolArray] | None:
    """Motion of the nodes of directed supports, with the components (n, d) that it moves; None if all are at rest."""
    shares = np.zeros((len(supports), *shape))
    for node, one in held.items():
        inverse = np.linalg.pinv(one.directions)
        for k, column in zip(one.supports, inverse.T, strict=True):
            if not isinstance(supports[k], Fixed):
                shares[k, node] += np.where(np.abs(column) > CLEAN, column, 0.0)
    moving = [(s, share) for s, share in zip(supports, shares, strict=True) if isinstance(s, Driven | Guided)]
    where = (shares != 0.0).any(axis=0)
    if not where.any():
        return None
    return DirectedMotion(supports=tuple(s for s, _ in moving), shares=np.array([s[where] for _, s in moving])), where


def with_hanging(own: DofMap, follow: sp.csr_array) -> CombinedDofs:
    """Map of nodes some of which hang: they have no unknowns of their own, and follow others.

    Parameters
    ----------
    own
        Map of the nodes without regard to what they follow.
    follow
        (n, n) motion of all nodes from that of those that hang nowhere, whose rows are those of the identity.

    Examples
    --------
    The middle of three nodes on a line follows the others, the last of which has a support:

    >>> follow = sp.csr_array(np.array([[1.0, 0, 0], [0.5, 0, 0.5], [0, 0, 1]]))
    >>> dofs = with_hanging(NodalDofs(np.array([[True], [True], [False]])), follow)
    >>> dofs.nodes(np.array([2.0]), np.array([[0.0], [0.0], [4.0]])).ravel().tolist()
    [2.0, 3.0, 4.0]
    """
    d = own.free.shape[1]
    wide = sp.csr_array(sp.kron(follow, sp.eye_array(d), format="csr"))
    moved = sp.csc_array(wide @ own.jacobian)
    jacobian = sp.csr_array(moved[:, np.flatnonzero(np.diff(moved.indptr))])
    inclined = getattr(own, "inclined", None)
    held = sp.csr_array(sp.diags_array((~own.free).ravel().astype(float)))
    held = held if inclined is None else sp.csr_array(held + inclined)
    ahead = sp.diags_array((wide.diagonal() == 1.0).astype(float))  # exact: rows of the identity
    still = sp.diags_array((np.diff(jacobian.indptr) == 0).astype(float))
    return CombinedDofs(jacobian, d, sp.csr_array(wide @ ahead @ held - still), wide)
