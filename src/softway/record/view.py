"""Pictures of a run: its history, the paths of a bar, the deformed body with its stress."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from softway.errors import InputError
from softway.record.run import Run
from softway.record.view_body import bodies
from softway.record.view_history import history
from softway.record.view_paths import paths
from softway.record.view_style import STYLE, library

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pictures(run: Run, out: Path | None = None) -> tuple[Path, ...]:
    """Draw a run into PNG files: the bodies (bars: their paths), and the history.

    Parameters
    ----------
    run
        The run.
    out
        File of the first picture, by default ``bodies.png`` in the run folder; the history goes beside it, with
        ``_history`` added to the name.
    """
    bars = set(run.fields.cells.blocks()) <= {"bar2", "bar3"}
    first = out or run.path / "bodies.png"
    second = first.with_name(f"{first.stem}_history{first.suffix}") if out else run.path / "history.png"
    return save(paths if bars else bodies, run, first), save(history, run, second)


def save(draw: "Callable[[Run], Figure]", run: Run, file: Path) -> Path:
    """Draw one picture into a file; its ending names the format."""
    matplotlib = library()
    with matplotlib.rc_context(STYLE):
        figure = draw(run)
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            figure.savefig(file, dpi=160, facecolor="white")
        except (OSError, ValueError) as error:
            raise InputError("out", f"cannot write '{file}': {error}", "a file such as picture.png") from None
    return file
