"""What every recorder is given at the start, and what it must be able to do."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from softway.march.step import Ledger, Step
from softway.record.probes import Reading
from softway.scene import Scene, State
from softway.space.mesh import Mesh
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Opening:
    """The start of a run, as far as records need it.

    Parameters
    ----------
    scene
        What there is.
    meshes
        Mesh of each solid.
    stresses
        Solid -> function from a state to the mean Cauchy stress of its cells (e, 3, 3) [Pa].
    touching
        Contact -> (m,) slave node of each of its rows, numbered over all solids in order.
    initial, ledger
        Situation and audit at the start.
    remembered
        Solid -> function from a state to what its cells remember, arrays (e,) by name; empty where there is none.
    spread
        Function from a state and contact forces (n, k) of all nodes [N] to force per present area (n, k) [Pa].
    until
        End of the march [s].
    fields_every
        Time between two frames of the fields [s].
    readings
        Resolved probes.
    """

    scene: Scene
    meshes: Mapping[str, Mesh]
    stresses: Mapping[str, Callable[[State], Array]]
    touching: Mapping[str, IntArray]
    initial: State
    ledger: Ledger
    until: float
    fields_every: float
    readings: tuple[Reading, ...] = ()
    remembered: Mapping[str, Callable[[State], Mapping[str, Array]]] = field(default_factory=dict)
    spread: Callable[[State, Array], Array] | None = None


class Recorder(Protocol):
    """Takes every accepted step, in order; valid files lie on the disk after each of them."""

    def take(self, step: Step) -> None:
        """Record one accepted slab."""
        ...

    @property
    def mark(self) -> int:
        """How long the record is: what its opener cuts it back to when a run is resumed."""
        ...

    def sync(self) -> None:
        """Bring what was taken to the disk."""
        ...

    def close(self) -> None:
        """End the record; nothing is taken afterwards."""
        ...


class Opener(Protocol):
    """Starts a recorder in a folder: it writes the initial situation and returns what takes the steps.

    With a ``mark`` it goes on with the record that is there, cut back to that length.
    """

    def __call__(self, folder: Path, opening: Opening, mark: int | None = None) -> Recorder:
        """Open the record."""
        ...
