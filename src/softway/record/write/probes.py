"""Probes: one number per time step (slab), read at the nodes of a tag or at the node nearest to a point."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.marching.results.step_states import Motion
from softway.meshes.adaptive.points import around
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remeshed_mesh import RemeshedMesh

UNITS = {"displacement": "m", "position": "m", "velocity": "m/s", "reaction": "N", "temperature": "K"}
Changing = AdaptedMesh | RemeshedMesh
"""Present mesh of a solid whose mesh changes."""
NONE: Mapping[str, Changing] = MappingProxyType({})
COMPONENTS = ("x", "y", "z", "norm")


class Probe(Protocol):
    """Declaration of a probe in a scenario.

    ``tag`` or ``at`` gives the place in the body ``of``; ``quantity`` is a key of ``UNITS``; ``component`` is one of
    ``COMPONENTS``.
    """

    @property
    def name(self) -> str:
        """Name of the column in the history."""
        ...

    @property
    def of(self) -> str:
        """Name of the solid."""
        ...

    @property
    def tag(self) -> str | None:
        """Tag of the nodes."""
        ...

    @property
    def at(self) -> float | Sequence[float] | None:
        """Reference point whose nearest node is read, instead of a tag [m]."""
        ...

    @property
    def quantity(self) -> str:
        """Recorded quantity."""
        ...

    @property
    def component(self) -> str:
        """Component of the quantity, or ``norm``."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reading:
    """Probe resolved on a mesh: the mean over its nodes, or the sum for reactions.

    On meshes that change, a tag has the mean over its nodes of the base mesh, which all meshes have, and a place the
    value there, between the nodes of its cell: the curves have no jumps where the mesh changes.  Reactions are those of
    all present nodes of a tag, or of the present node that is nearest to a place.  Where meshes are replaced, a tag and
    a place are the matter that was in these nodes, or in the node nearest to the place, at the start.

    Parameters
    ----------
    name, unit
        Name and unit of the column in the history.
    body
        Name of the solid.
    nodes
        (k,) node numbers.
    reference
        (k, d) reference coordinates of the nodes [m].
    quantity, component
        Recorded quantity and its component.
    weights
        (k,) weights of the nodes; None for the mean.
    origin
        (d,) place from which displacements are measured [m]; None for the reference coordinates.

    Examples
    --------
    >>> from softway.model.scene import State
    >>> reading = Reading(name="tip", unit="m", body="bar", nodes=np.array([1]), reference=np.array([[2.0]]),
    ...                   quantity="position", component="x")
    >>> u = {"bar": np.array([[0.0], [0.5]])}
    >>> reading.value(State(time=0.0, displacement=u, velocity=u, acceleration=u, closed={}, pressure={}), {})
    2.5
    """

    name: str
    unit: str
    body: str
    nodes: IntArray
    reference: Array
    quantity: str
    component: str
    weights: Array | None = None
    origin: Array | None = None

    def value(self, state: Motion, reactions: Mapping[str, Array]) -> float:
        """Value at ``state``; a reaction that has not been computed is ``nan``."""
        return float(self.values(state, reactions))

    def values(self, motion: Motion, reactions: Mapping[str, Array]) -> Array:
        """Value () of fields (n, d), or values (s,) of s slabs with fields (s, n, d)."""
        match self.quantity:
            case "temperature":
                return self._mean(self._at(motion.fields["temperature"])).mean(axis=-1)
            case "reaction":
                if self.body not in reactions:
                    return np.asarray(np.nan)
                vector = self._at(reactions).sum(axis=-2)
            case "velocity":
                vector = self._mean(self._at(motion.velocity))
            case "displacement" if self.origin is not None:
                vector = np.asarray(self._place(motion) - self.origin)
            case "displacement":
                vector = self._mean(self._at(motion.displacement))
            case _:
                vector = self._place(motion)
        if self.component == "norm":
            return np.asarray(np.linalg.norm(vector, axis=-1))
        return np.asarray(vector[..., "xyz".index(self.component)])

    def _place(self, motion: Motion) -> Array:
        """Mean place (..., d) [m]."""
        return self._mean(self.reference + self._at(motion.displacement))

    def _at(self, fields: Mapping[str, Array]) -> Array:
        """Values (..., k, d) of a field at the nodes."""
        return fields[self.body][..., self.nodes, :]

    def _mean(self, values: Array) -> Array:
        """Mean (..., d) of values at the nodes (..., k, d)."""
        if self.weights is not None:
            return np.asarray(self.weights @ values)
        return np.asarray(values[..., 0, :] if values.shape[-2] == 1 else values.mean(axis=-2))


def readings(
    probes: Sequence[Probe], meshes: Mapping[str, Mesh], changing: Mapping[str, Changing] = NONE
) -> tuple[Reading, ...]:
    """Resolve the declared probes; ``changing`` are the present meshes of solids whose mesh changes.

    Raises
    ------
    InputError
        For an unknown body, a tag without nodes or a component that does not exist; the path is ``output.probes[k]``.
    """
    require_names(probes)
    return tuple(solid_reading(f"output.probes[{k}]", probe, meshes, (), changing) for k, probe in enumerate(probes))


def require_names(probes: Sequence[Probe]) -> None:
    """Refuse names that cannot be columns, and names that two probes have."""
    names = [p.name for p in probes]
    for k, name in enumerate(names):
        if not name or name in names[:k] or not set(name).isdisjoint(',"[]\n'):
            raise InputError(
                f"output.probes[{k}].name",
                f"'{name}' cannot be the name of a column",
                "a name that no other probe has, without commas, quotes and brackets",
            )


def solid_reading(
    path: str,
    probe: Probe,
    meshes: Mapping[str, Mesh],
    others: tuple[str, ...] = (),
    changing: Mapping[str, Changing] = NONE,
) -> Reading:
    """Resolve one probe, whose path in the scenario is given; ``others`` are further bodies that may be named,
    ``changing`` the present meshes of solids whose mesh changes.

    Raises
    ------
    InputError
        As for :func:`readings`.
    """
    mesh = meshes.get(probe.of)
    if mesh is None:
        raise InputError(f"{path}.of", f"no solid '{probe.of}'", f"one of {[*meshes, *others]}")
    if probe.quantity not in UNITS:
        raise InputError(f"{path}.quantity", f"'{probe.quantity}' is not recorded", f"one of {list(UNITS)}")
    allowed = (*COMPONENTS[: mesh.dim], "norm")
    if probe.component not in allowed:
        raise InputError(
            f"{path}.component", f"'{probe.component}' does not exist in {mesh.dim}D", f"one of {list(allowed)}"
        )
    nodes, weights, origin = probed_nodes(path, probe, mesh), None, None
    found = changing.get(probe.of)
    if isinstance(found, RemeshedMesh):
        own, origin = _matter(path, probe, found)
        if probe.quantity != "reaction":
            nodes, weights = own.indices, own.data
        elif probe.at is not None:
            nodes = own.indices[[np.argmax(own.data)]]
    elif found is not None and probe.quantity != "reaction":
        nodes, weights = _lasting(path, probe, found)
    return Reading(
        name=probe.name,
        unit=UNITS[probe.quantity],
        body=probe.of,
        nodes=nodes,
        reference=mesh.points[nodes],
        quantity=probe.quantity,
        component=probe.component,
        weights=weights,
        origin=origin,
    )


def _matter(path: str, probe: Probe, remeshed: RemeshedMesh) -> tuple[sp.csr_array, Array]:
    """Mean of nodal fields (1, n) over the matter that was in the nodes of a probe at the start, and where that was
    (d,) [m].
    """
    first = probed_nodes(path, probe, remeshed.first)
    share = np.full((1, len(first)), 1.0 / len(first))
    return sp.csr_array(sp.csr_array(share) @ remeshed.matter[first]), remeshed.first.points[first].mean(axis=0)


def _lasting(path: str, probe: Probe, adapted: AdaptedMesh) -> tuple[IntArray, Array | None]:
    """Nodes (k,) and their weights (k,), of the same meaning in all meshes: those of the base mesh in a tag, which have
    the same numbers in each of them, or those around a place.
    """
    if probe.at is None:
        return probed_nodes(path, probe, adapted.base), None
    return around(adapted, np.atleast_1d(np.asarray(probe.at, float)))


def probed_nodes(path: str, probe: Probe, mesh: Mesh) -> IntArray:
    """Nodes (k,) of the tag of a probe, or the node nearest to its point."""
    if (probe.tag is None) == (probe.at is None):
        raise InputError(path, "a probe needs exactly one place", "either 'tag' or 'at'")
    if probe.tag is not None:
        try:
            return mesh.nodes(probe.tag)
        except InputError as error:
            raise error.within(f"{path}.tag") from None
    point = np.atleast_1d(np.asarray(probe.at, float))
    if point.shape != (mesh.dim,):
        raise InputError(f"{path}.at", f"{point.size} coordinates in {mesh.dim}D", f"{mesh.dim} coordinates")
    return np.array([mesh.nearest(point.tolist())])
