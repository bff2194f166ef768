"""Records of a run as pictures and readers need them: tables and frames, wherever they come from."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from softway.arrays import Array
from softway.record.pile.motion import BallMotion
from softway.record.read.frames import Fields
from softway.record.storage.table import Table


class Records(Protocol):
    """Tables and frames of a run; :class:`softway.record.run.Run` reads them from a run folder."""

    @property
    def path(self) -> Path:
        """Path of the folder that the records are in."""
        ...

    @property
    def history(self) -> Table:
        """History with one row per accepted time step (slab)."""
        ...

    @property
    def events(self) -> Table:
        """Contact events with one row per touch, release, stick or slip of a node."""
        ...

    @property
    def fields(self) -> Fields:
        """Frames of the fields."""
        ...

    @property
    def of_mechanism(self) -> bool:
        """True if the run is that of a mechanism, which has a motion and an outline instead of fields."""
        ...

    @property
    def of_pile(self) -> bool:
        """True if the run is that of a pile of balls."""
        ...

    @property
    def of_heat(self) -> bool:
        """True if the bodies of the run are conductors."""
        ...

    @property
    def times(self) -> Array:
        """Stored instants (t,) of the places of the bodies [s]."""
        ...

    @property
    def pile(self) -> Mapping[str, Any]:
        """Dimension, groups, radii and walls of a pile."""
        ...

    @property
    def balls(self) -> BallMotion:
        """Motion of the balls of a pile."""
        ...

    @property
    def motion(self) -> Table:
        """Motion of the rigid bodies of a mechanism."""
        ...

    @property
    def outline(self) -> Mapping[str, Any]:
        """Parts of a mechanism at the start."""
        ...

    @property
    def provenance(self) -> Mapping[str, Any]:
        """Title, versions and times of the run."""
        ...
