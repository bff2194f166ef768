"""Probes: one number a slab, read at the nodes of a tag or at the node nearest a point."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.errors import InputError
from softway.scene import State
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray

UNITS = {"displacement": "m", "position": "m", "velocity": "m/s", "reaction": "N"}
COMPONENTS = ("x", "y", "z", "norm")


class Probe(Protocol):
    """Declaration of a probe, as the scenario writes it.

    ``tag`` or ``at`` says where in the body ``of``; ``quantity`` is a key of ``UNITS``; ``component`` one of
    ``COMPONENTS``.
    """

    @property
    def name(self) -> str:
        """Column of the history."""
        ...

    @property
    def of(self) -> str:
        """Solid."""
        ...

    @property
    def tag(self) -> str | None:
        """Nodes by tag."""
        ...

    @property
    def at(self) -> float | Sequence[float] | None:
        """Or the node nearest a reference point [m]."""
        ...

    @property
    def quantity(self) -> str:
        """What is read."""
        ...

    @property
    def component(self) -> str:
        """Which part of it."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reading:
    """A probe resolved on a mesh: the mean over its nodes; for reactions the sum.

    Parameters
    ----------
    name, unit
        Column of the history.
    body
        Solid that is read.
    nodes
        (k,) node numbers.
    reference
        (k, d) their reference coordinates [m].
    quantity, component
        What is read.

    Examples
    --------
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

    def value(self, state: State, reactions: Mapping[str, Array]) -> float:
        """The number at ``state``; a reaction that nobody computed is ``nan``."""
        match self.quantity:
            case "reaction":
                if self.body not in reactions:
                    return float("nan")
                vector = reactions[self.body][self.nodes].sum(axis=0)
            case "velocity":
                vector = state.velocity[self.body][self.nodes].mean(axis=0)
            case "displacement":
                vector = state.displacement[self.body][self.nodes].mean(axis=0)
            case _:
                vector = (self.reference + state.displacement[self.body][self.nodes]).mean(axis=0)
        if self.component == "norm":
            return float(np.linalg.norm(vector))
        return float(vector["xyz".index(self.component)])


def readings(probes: Sequence[Probe], meshes: Mapping[str, Mesh]) -> tuple[Reading, ...]:
    """Resolve the declared probes.

    Raises
    ------
    InputError
        With the path ``output.probes[k]``: unknown body, tag that matches nothing, component that does not exist.
    """
    names = [p.name for p in probes]
    for k, name in enumerate(names):
        if not name or name in names[:k] or not set(name).isdisjoint(',"[]\n'):
            raise InputError(f"output.probes[{k}].name", f"'{name}' cannot name a column", "a unique plain name")
    return tuple(_resolve(f"output.probes[{k}]", probe, meshes) for k, probe in enumerate(probes))


def _resolve(path: str, probe: Probe, meshes: Mapping[str, Mesh]) -> Reading:
    mesh = meshes.get(probe.of)
    if mesh is None:
        raise InputError(f"{path}.of", f"no solid '{probe.of}'", f"one of {list(meshes)}")
    if probe.quantity not in UNITS:
        raise InputError(f"{path}.quantity", f"'{probe.quantity}' is not recorded", f"one of {list(UNITS)}")
    allowed = (*COMPONENTS[: mesh.dim], "norm")
    if probe.component not in allowed:
        raise InputError(f"{path}.component", f"'{probe.component}' in {mesh.dim}D", f"one of {list(allowed)}")
    nodes = _nodes(path, probe, mesh)
    return Reading(
        name=probe.name,
        unit=UNITS[probe.quantity],
        body=probe.of,
        nodes=nodes,
        reference=mesh.points[nodes],
        quantity=probe.quantity,
        component=probe.component,
    )


def _nodes(path: str, probe: Probe, mesh: Mesh) -> IntArray:
    if (probe.tag is None) == (probe.at is None):
        raise InputError(path, "a probe needs one place", "either 'tag' or 'at'")
    if probe.tag is not None:
        try:
            return mesh.nodes(probe.tag)
        except InputError as error:
            raise error.within(f"{path}.tag") from None
    point = np.atleast_1d(np.asarray(probe.at, float))
    if point.shape != (mesh.dim,):
        raise InputError(f"{path}.at", f"{point.size} coordinates in {mesh.dim}D", f"{mesh.dim} coordinates")
    return np.array([mesh.nearest(point.tolist())])
