"""State of the march of a pile between two slabs (time steps)."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.kernels.pile import tables


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PileState:
    """State from which a march of the same pile goes on.

    Parameters
    ----------
    time, slabs
        Time [s] and number of slabs since the start.
    place, velocity, turn
        (n, 3) places, (n + 1, 6) velocities and angular velocities, (n, 4) quaternions; the ground is the last body.
    pairs, impulse, closed
        (c, 2) contacts of the last slab, (c, 4) their impulses [N s], (c,) 1 for those that are closed.
    length
        Length of the last slab [s].
    told
        Numbers of the slabs since the last step that was yielded, and the dissipation since the start [J].
    initial
        Energy at the start [J].
    """

    time: float
    slabs: int
    place: Array
    velocity: Array
    turn: Array
    pairs: IntArray
    impulse: Array
    closed: IntArray
    length: float
    told: Array
    initial: float

    @property
    def memory(self) -> tables.Memory:
        """Contacts of the last slab."""
        return tables.Memory(self.pairs, self.impulse, self.closed)

    @property
    def fresh(self) -> "PileState":
        """State with the numbers of the slabs at zero, apart from the dissipation."""
        told = np.zeros(tables.TOLD)
        told[tables.DISSIPATION] = self.told[tables.DISSIPATION]
        return replace(self, told=told)

    def writable(self, count: int, walls: int, slabs: int) -> "PileState":
        """Copy for the march of a number of balls, walls and slabs.

        Raises
        ------
        InputError
            If the state is not one of such a march.
        """
        contacts = len(self.pairs)
        shapes = {
            "place": (count, 3),
            "velocity": (count + 1, 6),
            "turn": (count, 4),
            "pairs": (contacts, 2),
            "impulse": (contacts, 4),
            "closed": (contacts,),
            "told": (tables.TOLD,),
        }
        sound = all(getattr(self, name).shape == shape for name, shape in shapes.items())
        sound = sound and bool(((self.pairs >= 0) & (self.pairs < count + walls)).all()) and self.length > 0.0
        if not (sound and 0 <= self.slabs <= slabs):
            raise InputError("state", "is not one of a march of this pile", "a step of a march with the same input")
        copies: dict[str, Any] = {name: np.array(getattr(self, name)) for name in shapes}
        return replace(self, **copies)
