"""Reader of a run folder, whether the run is finished, interrupted or still going on."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from softway.arrays import Array
from softway.errors import InputError
from softway.record.pile import history as pile_history
from softway.record.pile import outline as pile_outline
from softway.record.pile.motion import BallMotion, read_motion
from softway.record.pile.summary import summarise_pile
from softway.record.read import summary
from softway.record.read.frames import Fields
from softway.record.read.heat_summary import summarise_heat
from softway.record.read.mechanism_summary import summarise_mechanism
from softway.record.storage import provenance, table
from softway.record.storage.gate.own_files import plain_file, readable_file
from softway.record.storage.provenance import RUNNING, Stop
from softway.record.storage.table import Table
from softway.record.write import events, fields, history
from softway.record.write.heat import columns as heat_columns
from softway.record.write.heat import outline as heat_outline
from softway.record.write.history_columns import COLUMNS
from softway.record.write.mechanism import columns, outline

if TYPE_CHECKING:
    from softway.record.read.body_motion import BodyMotion
    from softway.record.view.pictures import Picture

SCENARIO = "scenario.toml"
REMEDY = "the unchanged run folder"


@dataclass(frozen=True, slots=True, eq=False, init=False)
class Run:
    """Run folder; every property reads the files in their present state.

    Parameters
    ----------
    path
        Path of the folder.
    keep
        Object that must live as long as the folder, such as the holder of a temporary folder.

    Raises
    ------
    InputError
        If ``path`` is not a run folder.
    """

    path: Path
    keep: object = field(repr=False)

    def __init__(self, path: str | Path, keep: object = None) -> None:
        object.__setattr__(self, "path", Path(path))
        object.__setattr__(self, "keep", keep)
        if not readable_file(self.path / provenance.FILE):
            raise InputError("", f"no run folder: '{self.path}'", "a folder written by 'softway run --out'")

    @property
    def history(self) -> Table:
        """History with one row per accepted time step (slab); the first row is the initial state.

        Of a mechanism or a pile there is one row per stored instant.
        """
        needed = (
            columns.NEEDED
            if self.of_mechanism
            else pile_history.NEEDED
            if self.of_pile
            else heat_columns.NEEDED
            if self.of_heat
            else [(c.name, c.unit) for c in COLUMNS]
        )
        return table.read(self.path / history.FILE, needed)

    @property
    def of_mechanism(self) -> bool:
        """True if the bodies of the run are rigid bodies of a mechanism."""
        return (self.path / outline.FILE).is_file()

    @property
    def of_heat(self) -> bool:
        """True if the bodies of the run are conductors."""
        return (self.path / heat_outline.FILE).is_file()

    @property
    def of_pile(self) -> bool:
        """True if the run is that of a pile of balls."""
        return (self.path / pile_outline.FILE).is_file()

    @property
    def times(self) -> Array:
        """Stored instants (t,) of the places of the bodies [s]."""
        if self.of_pile:
            return self.balls.times
        return self.motion["time"] if self.of_mechanism else self.fields.times

    @property
    def pile(self) -> Mapping[str, Any]:
        """Dimension, groups, radii and walls of a pile."""
        file = self.path / pile_outline.FILE
        found = _notes(file, REMEDY, pile_outline.ENTRIES)
        if not pile_outline.sound(found):
            raise InputError(str(file), "does not tell the parts of a pile", REMEDY)
        return found

    @property
    def balls(self) -> BallMotion:
        """Motion of the balls of a pile: centres, rotations, velocities and angular velocities at the stored instants.

        Raises
        ------
        InputError
            If the run is not one of a pile.
        """
        if not self.of_pile:
            raise InputError(str(self.path), "is not the run of a pile", "run.fields of solids, run.motion of bodies")
        parts = self.pile
        return read_motion(self.path, len(parts["radii"]), parts["dim"])

    @property
    def motion(self) -> Table:
        """Motion of the rigid bodies of a mechanism, with one row per stored instant.

        Places of the centres [m], angles, or in space rotation vectors (angle times axis), up to half a turn [rad],
        velocities [m/s] and spins (angular velocities) [rad/s].

        Raises
        ------
        InputError
            If the run is not one of a mechanism.
        """
        if not self.of_mechanism:
            raise InputError(str(self.path), "is not the run of a mechanism", "run.fields, the frames of solids")
        return table.read(self.path / columns.MOTION, [("time", "s")])

    @property
    def bodies(self) -> Mapping[str, "BodyMotion"]:
        """Motion of each rigid body of a mechanism as arrays: places, rotations, velocities, angular velocities."""
        from softway.record.read.body_motion import body_motions

        return body_motions(self)

    def export(self, file: str | Path) -> Path:
        """Write the motion of the bodies of a mechanism, or of the balls of a pile, to a file.

        Parameters
        ----------
        file
            ``.csv``, a line for each instant and body; ``.json``; ``.npz``, arrays of NumPy; ``.gltf``, an animation.

        Raises
        ------
        InputError
            For another kind of file, a file that cannot be written, or the run of solids.
        """
        from softway.record.export.motion import export

        return export(self, file)

    @property
    def outline(self) -> Mapping[str, Any]:
        """Names and places of the parts of a mechanism at the start."""
        found, file = _notes(self.path / outline.FILE, REMEDY, outline.ENTRIES), self.path / outline.FILE
        if not outline.sound(found):
            raise InputError(str(file), "does not tell the parts of a mechanism", REMEDY)
        return found

    @property
    def events(self) -> Table:
        """Events with one row per touch, release, stick or slip of a node, and per finding of the audit."""
        return table.read(self.path / events.FILE, events.COLUMNS)

    @property
    def fields(self) -> Fields:
        """Frames of the fields: ``len``, ``[k]``, ``times``, ``cells``, ``to_pyvista(k)``."""
        if self.of_mechanism:
            raise InputError(str(self.path), "is the run of a mechanism, which has no fields", "its motion: motion.csv")
        if self.of_pile:
            raise InputError(str(self.path), "is the run of a pile, which has no fields", "its motion: run.balls")
        return Fields(self.path / fields.FILE, self.keep)

    @property
    def provenance(self) -> Mapping[str, Any]:
        """Versions, platform, start and stop of the run, and the reason of the stop."""
        return _notes(self.path / provenance.FILE, REMEDY, provenance.ENTRIES)

    @property
    def summary(self) -> Mapping[str, Any]:
        """Summary of the run in a few numbers, with the notes on its scenario; computed while the run has not ended."""
        written = self.path / summary.FILE
        if written.is_file():
            remedy = "delete this file: its numbers are computed again from history.csv"
            return _notes(written, remedy, summary.ENTRIES)
        return {**self.numbers, "notes": self.provenance.get("notes", [])}

    @property
    def numbers(self) -> dict[str, Any]:
        """Numbers of the summary, computed from the tables in their present state."""
        if self.of_pile:
            return summarise_pile(self.history, len(self.pile["radii"]))
        if self.of_heat:
            return summarise_heat(self.history)
        if self.of_mechanism:
            return summarise_mechanism(self.history, self.motion, self.events, self.outline)
        return summary.summarise(self.history, self.events)

    @property
    def scenario(self) -> str:
        """Text of the resolved scenario."""
        written = self.path / SCENARIO
        return written.read_text(encoding="utf-8") if written.is_file() else ""

    def plot(
        self, what: Literal["bodies", "history"] = "bodies", *, colour: str | None = None, times: Sequence[float] = ()
    ) -> "Picture":
        """Draw a picture for notebooks and files.

        Parameters
        ----------
        what
            ``bodies`` for the deformed bodies (for bars, their paths), or ``history`` for curves over time.
        colour
            Field that colours the bodies, as in ``softway plot --field``.
        times
            Instants at which the bodies are drawn [s].

        Raises
        ------
        InputError
            If there is no such picture, field or instant.
        """
        from softway.record.view.options import PictureOptions
        from softway.record.view.pictures import picture

        return picture(self, what, PictureOptions(field=colour, times=tuple(times)))

    @property
    def status(self) -> str:
        """Reason of the stop: ``done, with findings`` if the audit of a completed run found something."""
        reason = self.stop.reason
        return reason if reason == RUNNING.reason else summary.status(reason, self.summary)

    def _repr_html_(self) -> str:
        """Table and picture for notebooks; there is no picture before the first frame."""
        from softway.record.notebook import shown

        return shown(self, self.summary, self.status, self.stop.message)

    @property
    def stop(self) -> Stop:
        """Reason of the stop of the run, or ``running``; a run whose process was killed is ``interrupted``."""
        return provenance.stop_of(self.path, lambda: self.provenance)


def _notes(file: Path, remedy: str, entries: Mapping[str, type]) -> dict[str, Any]:
    """Content of a JSON file of the folder, with its ``entries`` of the given types."""
    try:
        found = dict(json.loads(plain_file(file).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError, RecursionError) as error:
        raise InputError(str(file), f"cannot be read: {error}", remedy) from None
    for key, kind in entries.items():
        if not isinstance(found.get(key), kind):
            raise InputError(str(file), f"its entry {key!r} is {found.get(key)!r:.60}", remedy)
    return found
