"""rigid.csv: the motion of the rigid bodies of a run with solids, one line for each accepted time step (slab)."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from softway.arrays import Array
from softway.bodies.prescribed_motion import PlacedShape, Pose
from softway.marching.results.step import Step
from softway.marching.results.step_states import Motion
from softway.marching.slab.step_group import StepGroup
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.step import BodyState
from softway.model.scene import State
from softway.record.storage import table
from softway.record.storage.table import Lines
from softway.record.write.mechanism.columns import motion_columns, motion_values
from softway.record.write.mechanism.probes import BodyReading
from softway.record.write.recorder import RunStart

FILE = "rigid.csv"


@dataclass(frozen=True, slots=True, eq=False)
class RigidTable:
    """Open file ``rigid.csv``."""

    lines: Lines

    def take(self, step: Step) -> None:
        """Write the places, rotations and velocities of the bodies after one slab."""
        self.lines.write(_cells(step.after))

    def take_group(self, group: StepGroup) -> None:
        """Write the motion after each of some slabs."""
        for step in group.steps():
            self.take(step)

    @property
    def mark(self) -> int:
        """Length of the file [bytes]."""
        return self.lines.mark

    def sync(self) -> None:
        """Flush the lines to the disk."""
        self.lines.sync()

    def close(self) -> None:
        """Close the file."""
        self.lines.close()


def open_rigid_table(folder: Path, opening: RunStart, mark: int | None = None) -> RigidTable:
    """Create ``rigid.csv`` with the state at the start, or continue the existing file."""
    rows = table.lines(folder / FILE, mark)
    if mark is None:
        dim = next(iter(opening.meshes.values())).dim
        names = opening.initial.rigid
        rows.write(table.header((("time", "s"), *(column for name in names for column in motion_columns(name, dim)))))
        rows.write(_cells(opening.initial))
    return RigidTable(rows)


def _cells(state: State) -> list[str | int | float]:
    return [state.time, *(x for body in state.rigid.values() for x in motion_values(body))]


@dataclass(frozen=True, slots=True, eq=False)
class RigidReading:
    """Probe of a rigid body in a run with solids."""

    of: BodyReading

    @property
    def name(self) -> str:
        """Name of the column in the history."""
        return self.of.name

    @property
    def unit(self) -> str:
        """Unit of the column."""
        return self.of.unit

    def value(self, state: Motion, reactions: Mapping[str, Array]) -> float:
        """Value at ``state``."""
        return self.of.at(state.rigid)

    def values(self, motion: Motion, reactions: Mapping[str, Array]) -> Array:
        """Value of a single slab (1,): slabs with rigid bodies are not compiled."""
        return np.array([self.value(motion, reactions)])


def pose(body: Rigid, state: BodyState) -> Pose:
    """Pose of the shape of a body, which is described at its place at the start."""
    return Pose(rotation=state.rotation, shift=state.centre - state.rotation @ body.centre)


def placed_bodies(bodies: Mapping[str, Rigid], state: State) -> dict[str, PlacedShape]:
    """Shapes of the rigid bodies that have one, at their places in a state."""
    return {
        name: PlacedShape(shape=body.shape, pose=pose(body, state.rigid[name]))
        for name, body in bodies.items()
        if body.shape is not None and name in state.rigid
    }
