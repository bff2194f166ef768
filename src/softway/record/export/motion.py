"""Export of the motion of the bodies of a mechanism by the ending of the name of the file."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from softway.arrays import Array
from softway.errors import InputError
from softway.record.export.animation import animation
from softway.record.export.tables import csv_file, json_file, npz_file
from softway.record.read.body_motion import BodyMotion, body_motions
from softway.record.read.records import Records

TABLES: Mapping[str, Callable[[Path, Array, Mapping[str, BodyMotion]], None]] = MappingProxyType(
    {".csv": csv_file, ".json": json_file, ".npz": npz_file}
)
"""Writers of numbers by the ending of the name."""
ANIMATION = ".gltf"


def export(run: Records, file: str | Path) -> Path:
    """Write the motion of the bodies of a mechanism to a file.

    Parameters
    ----------
    run
        Run of a mechanism.
    file
        ``.csv`` for a table with a line for each instant and body, ``.json`` for nested lists, ``.npz`` for arrays of
        NumPy named ``time`` and ``BODY.place`` and so on, with all digits; ``.gltf`` for an animation.

    Raises
    ------
    InputError
        For another kind of file, a file that cannot be written, or the run of solids.
    """
    path = Path(file)
    if path.suffix not in (*TABLES, ANIMATION):
        raise InputError(
            "--to", f"'{path}' is of no known kind", f"a name that ends in {', '.join((*TABLES, ANIMATION))}"
        )
    time, bodies = run.motion["time"], body_motions(run)
    try:
        if path.suffix == ANIMATION:
            path.write_text(animation(run, bodies), encoding="utf-8")
        else:
            TABLES[path.suffix](path, time, bodies)
    except OSError as error:
        raise InputError("--to", f"cannot write '{path}': {error.strerror}", "a folder that exists") from None
    return path
