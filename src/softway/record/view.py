"""Pictures of a run: its history, the paths of a bar, the deformed body with its stress."""

import io
from dataclasses import dataclass
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
    return picture(run, "bodies", look).save(first), picture(run, "history", look).save(second)


def is_bars(run: Run) -> bool:
    """Whether there are bars only: they are shown by their paths."""
    return set(run.fields.cells.blocks()) <= {"bar2", "bar3"}


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture that a notebook shows, and ``save`` writes; ``figure`` is Matplotlib's, to be changed before."""

    figure: "Figure"
    dpi: int

    def _repr_png_(self) -> bytes:
        """The picture for notebooks."""
        out = io.BytesIO()
        with styled():
            self.figure.savefig(out, format="png", dpi=self.dpi, facecolor="white")
        return out.getvalue()

    def save(self, file: str | Path) -> Path:
        """Write it; the ending of the file names the format.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        path = Path(file)
        with styled():
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                self.figure.savefig(path, dpi=self.dpi, facecolor="white")
            except (OSError, ValueError) as error:
                raise InputError("out", f"cannot write '{path}': {error}", "a file such as picture.png") from None
        return path


def picture(run: Run, what: str = "bodies", look: Look = STANDARD) -> Picture:
    """The bodies of a run (of bars: their paths), or its history.

    Raises
    ------
    InputError
        There is no such picture, or nothing to draw.
    """
    if what not in ("bodies", "history"):
        raise InputError("what", f"no picture {what!r}", "bodies or history")
    if run.history.rows == 0 or not len(run.fields):
        raise InputError(str(run.path), "nothing has been recorded yet", "a run that has begun")
    with styled():
        return Picture((history if what == "history" else paths if is_bars(run) else bodies)(run, look), look.dpi)
