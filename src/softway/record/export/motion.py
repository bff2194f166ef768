"""Export of the motion of a mechanism or a pile by the ending of the name of the file."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from softway.arrays import Array
from softway.errors import InputError
from softway.record.export.animation import animation
from softway.record.export.piles import balls_csv, balls_gltf, balls_npz
from softway.record.export.tables import csv_file, json_file, npz_file
from softway.record.read.body_motion import BodyMotion, body_motions
from softway.record.read.records import Records

TABLES: Mapping[str, Callable[[Path, Array, Mapping[str, BodyMotion]], None]] = MappingProxyType(
    {".csv": csv_file, ".json": json_file, ".npz": npz_file}
)
"""Writers of numbers by the ending of the name."""
ANIMATION = ".gltf"
PILES: Mapping[str, Callable[[Path, Records], None]] = MappingProxyType(
    {".csv": balls_csv, ".npz": balls_npz, ANIMATION: balls_gltf}
)
"""Writers of the motion of balls by the ending of the name."""


def export(run: Records, file: str | Path) -> Path:
    """Write the motion of the bodies of a mechanism, or of the balls of a pile, to a file.

    Parameters
    ----------
    run
        Run of a mechanism or a pile.
    file
        ``.csv`` for a table with a line for each instant and body, ``.json`` for nested lists, ``.npz`` for arrays of
        NumPy named ``time`` and ``BODY.place`` and so on, with all digits; ``.gltf`` for an animation.  Of a pile
        ``.csv``, ``.gltf``, or ``.npz`` with ``time``, ``centres``, ``turns``, ``velocities``, ``spins``, ``radii`` and
        ``groups``.

    Raises
    ------
    InputError
        For another kind of file, a file that cannot be written, or the run of solids.
    """
    path = Path(file)
    known = PILES if run.of_pile else (*TABLES, ANIMATION)
    if path.suffix not in known:
        raise InputError("--to", f"'{path}' is of no known kind", f"a name that ends in {', '.join(known)}")
    try:
        if run.of_pile:
            PILES[path.suffix](path, run)
        elif path.suffix == ANIMATION:
            path.write_text(animation(run, body_motions(run)), encoding="utf-8")
        else:
            TABLES[path.suffix](path, run.motion["time"], body_motions(run))
    except OSError as error:
        raise InputError("--to", f"cannot write '{path}': {error.strerror}", "a folder that exists") from None
    return path
