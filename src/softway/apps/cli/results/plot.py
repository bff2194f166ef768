"""Command plot: pictures and films of a run."""

from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from rich.console import Console
from rich.markup import escape

from softway.apps.cli.output.progress import waiting
from softway.record.run import Run
from softway.record.view.film import film as make_film
from softway.record.view.options import PictureOptions, size_of
from softway.record.view.pictures import pictures
from softway.scenario.hints.units_text import Units


def plot(
    folder: Path,
    /,
    *,
    out: Path | None = None,
    field: str | None = None,
    at: str | None = None,
    times: str | None = None,
    film: Path | None = None,
    size: str | None = None,
    dpi: int | None = None,
) -> None:
    """Draw the bodies and the history of a run, or a film.

    Parameters
    ----------
    folder
        Run folder.
    out
        File of the first picture (.png, .pdf, .svg), the second is next to it; by default both are in the run folder.
    field
        Field that colours the bodies, such as von_mises, contact_pressure, velocity.x, stress.xy; by default the
        plastic strain if there is any, otherwise the von Mises stress. Of conductors: temperature, liquid or
        heat_flux.x, for bars drawn along them. Of a pile: speed or body.
    at
        Time of the picture, such as "2 ms"; by default the time of the greatest strain energy.
    times
        Several times side by side: "1 ms, 2 ms, 3 ms"; for a film, two times give its start and end.
    film
        Write a film to this file (.mp4 with ffmpeg, .gif) instead of pictures.
    size
        Width and height in pixels, such as 1280x720.
    dpi
        Pixels per inch, which also scales texts and lines; by default 160, for films 120.
    """
    instants = _instants("--at", (at,) if at is not None else ())
    instants += _instants("--times", times.split(",") if times is not None else ())
    run, console = Run(folder), Console()
    look = PictureOptions(field=field, times=instants, size=size_of(size), dpi=_dots(dpi, film))
    if film is None:
        with waiting(console, "drawing"):
            files = pictures(run, out, look)
        for file in files:
            console.print(escape(str(file)), soft_wrap=True)
        return
    begun = perf_counter()
    with console.status("first picture") as status:

        def told(done: int, of: int) -> None:
            ahead = (perf_counter() - begun) * (of - done) / done
            status.update(f"picture {done} of {of}, ETA {ahead:.0f} s")

        file = make_film(run, film, look, told)
    console.print(escape(str(file)), soft_wrap=True)


def _dots(dpi: int | None, film: Path | None) -> int:
    """Pixels per inch; the default is smaller for films."""
    if dpi is None:
        return 160 if film is None else 120
    return dpi


def _instants(where: str, texts: Sequence[str]) -> tuple[float, ...]:
    """Times [s] from texts such as "2 ms" or plain numbers."""
    units, found = Units.standard(), []
    for text in texts:
        try:
            value: float | str = float(text)
        except ValueError:
            value = text.strip()
        found.append(units.number(value, "s", where))
    return tuple(found)
