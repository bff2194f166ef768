"""Films: all stored frames in the same view, written as MP4 with ffmpeg or as GIF with Pillow."""

import logging
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.record.read.records import Records
from softway.record.view.bodies.bodies import caption, stage_of
from softway.record.view.bodies.colour_field import colour_of
from softway.record.view.bodies.surroundings import ruler
from softway.record.view.mechanism.positions import film_of
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.pile.balls import film_of_pile
from softway.record.view.plots.paths import diagrams
from softway.record.view.plots.profiles import is_of_bars, profile_film
from softway.record.view.style import BLACK, canvas, library, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

log = logging.getLogger(__name__)
FAST = 20
"""Pictures per second."""
LONGEST = 300
"""Maximum number of pictures in a film; in longer runs some frames are skipped."""
FINE = 16000
"""Maximum number of small triangles on a surface."""
SIZE, DPI = (1280, 720), 120

Draw = Callable[[int], None]
"""Function that draws the frame with a given number into the figure."""


def film(
    run: Records, file: Path, look: PictureOptions = STANDARD, watch: Callable[[int, int], None] | None = None
) -> Path:
    """Write a film of a run; without ffmpeg a GIF is written instead of an MP4.

    Parameters
    ----------
    run
        Run to show.
    file
        File to write, ``.mp4`` or ``.gif``.
    look
        Field and size; ``times``, if given, are the first and the last instant.
    watch
        Callback with the number of finished pictures and the total number.

    Returns
    -------
    Path
        File that has been written.

    Raises
    ------
    InputError
        For another file extension, a folder that cannot be written, or fewer than two frames.
    """
    file = Path(file)
    if file.suffix.lower() not in (".mp4", ".gif"):
        raise InputError("--film", f"'{file.name}' is not a film file", "a file such as film.mp4 or film.gif")
    numbers = _numbers(run, look)
    if len(numbers) < 2:
        raise InputError("--film", "fewer than two frames", "a run with more frames: a smaller output.fields_every")
    with styled(**{"animation.ffmpeg_path": _ffmpeg() or "ffmpeg"}):
        import matplotlib.animation as animation

        file, writer = _writer(animation, file)
        look = replace(look, size=look.size or SIZE, dpi=look.dpi if look != STANDARD else DPI)
        figure, draw = _drawn(run, look, numbers)
        part = file.with_name(f".{file.stem}.part{file.suffix}")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            with writer.saving(figure, str(part), look.dpi):
                for done, number in enumerate(numbers):
                    draw(number)
                    writer.grab_frame(facecolor="white")
                    figure.set_layout_engine("none")
                    if watch is not None:
                        watch(done + 1, len(numbers))
            part.replace(file)
        except (OSError, subprocess.CalledProcessError) as error:
            raise InputError("--film", f"cannot write '{file}': {error}", "a folder that can be written") from None
        finally:
            if part.is_file():
                part.unlink()
    return file


def _numbers(run: Records, look: PictureOptions) -> list[int]:
    """Numbers of the frames to show; evenly spaced frames are chosen if there are too many."""
    times = run.times
    if look.times and len(look.times) != 2:
        raise InputError("--times", f"{len(look.times)} instants for a film", "two: the first and the last one")
    begin, end = look.times or (times[0], times[-1])
    slack = 1e-9 * times[-1]
    inside = np.flatnonzero((times >= begin - slack) & (times <= end + slack))
    chosen = np.unique(np.linspace(0, len(inside) - 1, min(len(inside), LONGEST)).round().astype(int))
    return [int(k) for k in inside[chosen]]


def _ffmpeg() -> str | None:
    """Path of ffmpeg on the system or in the package imageio-ffmpeg; None without either."""
    found = shutil.which("ffmpeg")
    if found is None:
        try:
            import imageio_ffmpeg
        except ImportError:
            return None
        found = str(imageio_ffmpeg.get_ffmpeg_exe())
    return found


def _writer(animation: Any, file: Path) -> tuple[Path, Any]:
    """File and writer of the film."""
    if file.suffix.lower() == ".mp4" and animation.FFMpegWriter.isAvailable():
        return file, animation.FFMpegWriter(fps=FAST, extra_args=["-pix_fmt", "yuv420p"])
    if file.suffix.lower() == ".mp4":
        log.warning("ffmpeg was not found (pip install 'softway[film]'): a GIF is written instead of an MP4")
    return file.with_suffix(".gif"), animation.PillowWriter(fps=FAST)


def _drawn(run: Records, look: PictureOptions, numbers: list[int]) -> "tuple[Figure, Draw]":
    """Figure of the bodies, and the function that draws a frame into it."""
    if run.of_pile or run.of_mechanism:
        return rigid_film(run, look)
    if is_of_bars(run):
        return profile_film(run, look) if run.of_heat else _bars(run, look, numbers)
    return _solids(run, look, numbers)


def rigid_film(run: Records, look: PictureOptions) -> "tuple[Figure, Draw]":
    """Figure of a mechanism, a pile or conductors, and the function that draws a stored instant into it."""
    if run.of_heat:
        numbers = list(range(len(run.fields)))
        return profile_film(run, look) if is_of_bars(run) else _solids(run, look, numbers)
    return film_of_pile(run, look) if run.of_pile else film_of(run, look)


def _solids(run: Records, look: PictureOptions, numbers: list[int]) -> "tuple[Figure, Draw]":
    """Figure of deformed bodies, with one window, camera and colour scale for all frames."""
    stage = stage_of(run, colour_of(run, look.field), numbers, FINE)
    figure = canvas(*(look.inches or (8.0, 4.5)))
    axis = figure.subplots()
    stage.bar(figure, [axis])
    axis.set_axis_off()
    caption(figure, run, stage, [stage.shown(run.fields[numbers[0]])], "")
    figure.draw_without_rendering()
    low, high = _window(stage.box, np.array(axis.get_window_extent().size))

    def draw(number: int) -> None:
        axis.clear()
        shown = stage.shown(run.fields[number])
        stage.draw(axis, shown)
        axis.set_anchor("C")
        ruler(axis, stage.cells.reference, (stage.box[0, 0], stage.box[0, 1]))
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        caption(figure, run, stage, [shown], "")

    return figure, draw


def _window(box: Array, size: Array) -> tuple[Array, Array]:
    """Corners (2,) of a window around a box (2, 2) with a margin, with the aspect ratio of axes of a size (2,)."""
    margin = 0.1 * float(np.linalg.norm(np.ptp(box, axis=0)))
    low, high = box[0] - margin * np.array([1.0, 1.3]), box[1] + margin
    unit = float(((high - low) / size).max())
    middle = 0.5 * (low + high)
    return middle - 0.5 * unit * size, middle + 0.5 * unit * size


def _bars(run: Records, look: PictureOptions, numbers: list[int]) -> "tuple[Figure, Draw]":
    """Figure of the diagrams of bars, drawn once, with lines that mark the present instant."""
    if look.field is not None:
        raise InputError("--field", "the film of bars shows no field", "omit this option")
    made, times = diagrams(run, look), run.fields.times
    made.figure.set_dpi(look.dpi)
    still = library().backends.backend_agg.FigureCanvasAgg(made.figure)
    still.draw()
    figure = canvas(*(look.inches or (8.0, 4.5)))
    figure.set_dpi(look.dpi)
    figure.figimage(np.asarray(still.buffer_rgba()))
    boxes = [axis.get_position() for axis in (*made.left, made.right)]
    lines = [library().lines.Line2D([b.x0, b.x1], [b.y0, b.y1], color=BLACK, lw=1.0) for b in boxes]
    for line in lines:
        figure.add_artist(line)

    def draw(number: int) -> None:
        now = made.second * float(times[number])
        place = made.figure.transFigure.inverted()
        for line, axis in zip(lines, made.left, strict=False):
            line.set_xdata([place.transform(axis.transData.transform((now, 0.0)))[0]] * 2)
        lines[-1].set_ydata([place.transform(made.right.transData.transform((0.0, now)))[1]] * 2)

    return figure, draw
