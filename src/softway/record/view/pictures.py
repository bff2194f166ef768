"""Pictures of a run: its history, the paths of bars, the deformed bodies with a field."""

import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from softway.errors import InputError
from softway.record.read.findings import gathered, sentences, stored
from softway.record.read.records import Records
from softway.record.view.bodies.bodies import bodies
from softway.record.view.mechanism.positions import positions
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.pile.balls import piles
from softway.record.view.plots.history import history
from softway.record.view.plots.paths import paths
from softway.record.view.plots.profiles import is_of_bars, profiles
from softway.record.view.style import RED, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pictures(run: Records, out: Path | None = None, look: PictureOptions = STANDARD) -> tuple[Path, ...]:
    """Draw a run into PNG files: the bodies (for bars, their paths), and the history.

    Parameters
    ----------
    run
        Run to draw.
    out
        File of the first picture, by default ``bodies.png`` in the run folder.  The history is written to the same
        folder, with ``_history`` added to the name; by default to ``history.png``.
    look
        Field, instants and size of the pictures.
    """
    bars = not (run.of_mechanism or run.of_pile or run.of_heat) and is_bars(run)
    if bars and (look.times or look.field is not None):
        raise InputError("--field, --at", "the picture of bars shows all times and no field", "omit these options")
    first = out or run.path / "bodies.png"
    second = first.with_name(f"{first.stem}_history{first.suffix}") if out else run.path / "history.png"
    return picture(run, "bodies", look).save(first), picture(run, "history", look).save(second)


def is_bars(run: Records) -> bool:
    """Check whether all bodies are bars; bars are shown by their paths, or their temperatures."""
    return is_of_bars(run)


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """Picture that a notebook shows and ``save`` writes; ``figure`` is the Matplotlib figure, which may be modified."""

    figure: "Figure"
    dpi: int

    def _repr_png_(self) -> bytes:
        """PNG data for notebooks."""
        out = io.BytesIO()
        with styled():
            self.figure.savefig(out, format="png", dpi=self.dpi, facecolor="white")
        return out.getvalue()

    def save(self, file: str | Path) -> Path:
        """Write the picture to a file; the file extension gives the format.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        path = Path(file)
        with styled():
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                self.figure.savefig(path, dpi=self.dpi, facecolor="white")
            except (OSError, ValueError) as error:
                raise InputError("out", f"cannot write '{path}': {error}", "a file such as picture.png") from None
        return path


def picture(run: Records, what: str = "bodies", look: PictureOptions = STANDARD) -> Picture:
    """Draw the bodies of a run (for bars, their paths), or its history.

    Raises
    ------
    InputError
        If there is no such picture, or nothing to draw.
    """
    if what not in ("bodies", "history"):
        raise InputError("what", f"no picture {what!r}", "bodies or history")
    if run.history.rows == 0 or not len(run.times):
        raise InputError(str(run.path), "nothing has been recorded yet", "a run with recorded steps")
    with styled():
        figure = (history if what == "history" else _scene_of(run))(run, look)
        found = sentences(gathered(stored(run.events)))
        if found:
            lines = [*filter(None, [figure.get_supxlabel()]), *found]
            figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=8, color=RED)
        return Picture(figure, look.dpi)


def _scene_of(run: Records) -> "Callable[[Records, PictureOptions], Figure]":
    """Function that draws the bodies of a run."""
    if run.of_pile:
        return piles
    if run.of_mechanism:
        return positions
    if is_bars(run):
        return profiles if run.of_heat else paths
    return bodies
