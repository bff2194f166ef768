"""Interface of the recorders, and the data that they receive at the start of a run."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from softway.arrays import Array, IntArray
from softway.marching.audit.balances import Balances, Pushed
from softway.marching.results.step import Ledger, Step
from softway.marching.results.step_states import Motion
from softway.marching.slab.step_group import StepGroup
from softway.meshes.mesh import Mesh
from softway.model.field import Field
from softway.model.model import Model
from softway.model.scene import Scene, State

Times = float | Array
"""A time, or several [s]."""


class Readable(Protocol):
    """Probe that has been resolved: a column of the history."""

    @property
    def name(self) -> str:
        """Name of the column."""
        ...

    @property
    def unit(self) -> str:
        """Unit of the column."""
        ...

    def value(self, state: Motion, reactions: Mapping[str, Array]) -> float:
        """Value at ``state``, of which a motion is enough."""
        ...

    def values(self, motion: Motion, reactions: Mapping[str, Array]) -> Array:
        """Values (k,) of k slabs, whose fields are (k, n, d)."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RunStart:
    """Start of a run, with the data that the recorders need.

    Parameters
    ----------
    scene
        Bodies, contacts and loads.
    meshes
        Mesh of each solid.
    stresses
        For each solid, a function from a state to the mean Cauchy stress of its cells (e, 3, 3) [Pa].
    touching
        For each contact, (m,) slave node of each contact row, numbered over all solids in order.
    initial, ledger
        Initial state, and its energy and momentum audit.
    remembered
        For each solid with history, a function from a state to the history variables of its cells: (e, ...) by name.
    spread
        Function from a state and contact forces (n, k) of all nodes [N] to forces per current area (n, k) [Pa].
    until
        End of the march [s].
    fields_every
        Time between two frames of the fields [s].
    readings
        Resolved probes.
    fields
        Displacement and companion fields.
    audit
        True if the geometry and the balances are audited at stored frames.
    balances
        Function from a state to its balances, computed again from its fields.
    pushed
        Function from a step to the contact forces that the change of momentum of each body needs.
    rounding
        Energy of strains that are rounding errors [J].
    model
        Model on these meshes.
    on_meshes
        Function from the model of a step to the same start on its meshes; None where meshes stay.
    """

    scene: Scene
    meshes: Mapping[str, Mesh]
    stresses: Mapping[str, Callable[[State], Array]]
    touching: Mapping[str, IntArray]
    initial: State
    ledger: Ledger
    until: float
    fields_every: float
    readings: tuple[Readable, ...] = ()
    remembered: Mapping[str, Callable[[State], Mapping[str, Array]]] = field(default_factory=dict)
    spread: Callable[[State, Array], Array] | None = None
    fields: tuple[Field, ...] = ()
    audit: bool = False
    balances: Callable[[State], Balances] | None = None
    pushed: Callable[[Step], Mapping[tuple[str, ...], Pushed]] | None = None
    rounding: float = 0.0
    model: Model | None = None
    on_meshes: Callable[[Model], "RunStart"] | None = None

    def of(self, step: Step) -> "RunStart":
        """Start on the meshes of a step; itself where they are the same."""
        return self if self.on_meshes is None or step.model is self.model else self.on_meshes(step.model)

    @property
    def adapts(self) -> bool:
        """True if meshes change between slabs."""
        return self.on_meshes is not None

    @property
    def passing_heat(self) -> tuple[str, ...]:
        """Labels of the contacts that pass heat between solids with a temperature."""
        return () if self.ledger.heat is None else tuple(c.label for c in self.scene.contacts if c.heat is not None)

    def frame_due(self, before: float, after: float) -> bool:
        """True if a slab between two times [s] passes an instant at which a frame is stored, or reaches the end."""
        return bool(frame_due(self.fields_every, self.until, before, after))

    def parts(self, group: StepGroup) -> Iterator[Step | StepGroup]:
        """Slabs that were compiled together: a step of each at whose end a frame is stored, and groups between them."""
        slab, begin = group.slab, 0
        for k in np.flatnonzero(frame_due(self.fields_every, self.until, slab.start, slab.end)).tolist():
            if k > begin:
                yield group.part(begin, k)
            yield group.step(k)
            begin = k + 1
        if begin < len(group):
            yield group.part(begin, len(group))

    def ended(self, time: float) -> bool:
        """True at the end of the march, up to rounding."""
        return bool(_ended(self.until, time))


def frame_due(every: float, until: float, before: Times, after: Times) -> Any:
    """True if a slab between two times [s] passes a multiple of ``every``, or reaches the end ``until`` of the march.

    An array for arrays of times.

    Examples
    --------
    >>> [bool(frame_due(1.0, 9.5, *times)) for times in ((0.5, 0.9), (0.9, 1.0), (9.1, 9.5))]
    [False, True, True]
    >>> frame_due(1.0, 9.5, np.array([0.5, 0.9]), np.array([0.9, 1.0])).tolist()
    [False, True]
    """
    return (np.floor(after / every + 1e-9) > np.floor(before / every + 1e-9)) | _ended(until, after)


def _ended(until: float, time: Times) -> Any:
    """True at the end of the march, up to rounding."""
    return time >= until * (1.0 - 1e-12)


class Recorder(Protocol):
    """Recorder of the accepted steps, which it takes in order; its file is valid after each of them."""

    def take(self, step: Step) -> None:
        """Record one accepted slab."""
        ...

    def take_group(self, group: StepGroup) -> None:
        """Record slabs that were compiled together: nothing happens in them, and no frame is due at their ends."""
        ...

    @property
    def mark(self) -> int:
        """Length of the record; the opener truncates the record to this length when a run is resumed."""
        ...

    def sync(self) -> None:
        """Flush the recorded steps to the disk."""
        ...

    def close(self) -> None:
        """Close the record; no step is taken afterwards."""
        ...


class Opener(Protocol):
    """Function that opens a recorder in a folder: it writes the initial state and returns the recorder.

    With a ``mark`` it truncates the existing record to that length and continues it.
    """

    def __call__(self, folder: Path, opening: RunStart, mark: int | None = None) -> Recorder:
        """Open the record."""
        ...
