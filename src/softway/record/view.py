"""Pictures of a run: its history, the paths of a bar, the deformed body with its stress."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from softway.errors import InputError
from softway.record.look import STANDARD, Look
from softway.record.run import Run
from softway.record.view_body import bodies
from softway.record.view_history import history
from softway.record.view_paths import paths
from softway.record.view_style import styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pictures(run: Run, out: Path | None = None, look: Look = STANDARD) -> tuple[Path, ...]:
    """Draw a run into PNG files: the bodies (bars: their paths), and the history.

    Parameters
    ----------
    run
        The run.
    out
        File of the first picture, by default ``bodies.png`` in the run folder; the history goes beside it, with
        ``_history`` added to the name.
    look
        Field, instants and size of the pictures.
    """
    bars = is_bars(run)
    if bars and (look.times or look.field is not None):
        raise InputError("--field, --at", "the picture of bars shows every time and no field", "to leave them out")
    first = out or run.path / "bodies.png"
    second = first.with_name(f"{first.stem}_history{first.suffix}") if out else run.path / "history.png"
    return save(paths if bars else bodies, run, first, look), save(history, run, second, look)


def is_bars(run: Run) -> bool:
    """Whether there are bars only: they are shown by their paths."""
    return set(run.fields.cells.blocks()) <= {"bar2", "bar3"}


def drawn(run: Run, look: Look = STANDARD) -> bytes:
    """The picture of the bodies as PNG."""
    out = io.BytesIO()
    with styled():
        (paths if is_bars(run) else bodies)(run, look).savefig(out, format="png", dpi=look.dpi, facecolor="white")
    return out.getvalue()


def save(draw: "Callable[[Run, Look], Figure]", run: Run, file: Path, look: Look = STANDARD) -> Path:
    """Draw one picture into a file; its ending names the format."""
    with styled():
        figure = draw(run, look)
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            figure.savefig(file, dpi=look.dpi, facecolor="white")
        except (OSError, ValueError) as error:
            raise InputError("out", f"cannot write '{file}': {error}", "a file such as picture.png") from None
    return file
