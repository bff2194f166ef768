"""The verb plot: pictures and films of a run."""

from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from rich.console import Console
from rich.markup import escape

from softway.cli.progress import waiting
from softway.record.look import Look, size_of
from softway.record.run import Run
from softway.record.view import pictures
from softway.record.view_film import film as make_film
from softway.scenario.quantity import Units


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
        File of the first picture (.png, .pdf, .svg), the second beside it; by default both go into the run folder.
    field
        What colours the bodies, such as von_mises, contact_pressure, velocity.x, stress.xy; by default the plastic
        strain where there is any, else von Mises stress.
    at
        Instant of the picture, such as "2 ms"; by default that of the greatest strain energy.
    times
        Several instants side by side: "1 ms, 2 ms, 3 ms"; two of them are the ends of a film.
    film
        Write a film (.mp4 with ffmpeg, .gif) instead.
    size
        Width and height in pixels, such as 1280x720.
    dpi
        Pixels of an inch: texts and lines grow with it; by default 160, of films 120.
    """
    instants = _instants("--at", (at,) if at is not None else ())
    instants += _instants("--times", times.split(",") if times is not None else ())
    run, console = Run(folder), Console()
    look = Look(field=field, times=instants, size=size_of(size), dpi=_dots(dpi, film))
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
    """Pixels of an inch, where nothing is asked for a few less in films."""
    if dpi is None:
        return 160 if film is None else 120
    return dpi


def _instants(where: str, texts: Sequence[str]) -> tuple[float, ...]:
    """Times [s] from texts such as "2 ms", or bare numbers."""
    units, found = Units.standard(), []
    for text in texts:
        try:
            value: float | str = float(text)
        except ValueError:
            value = text.strip()
        found.append(units.number(value, "s", where))
    return tuple(found)
