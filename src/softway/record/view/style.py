"""Common style of all pictures: Matplotlib, canvas, colours, lighting, and units with prefixes."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import floor, log10
from threading import RLock
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.arrays import Array
from softway.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLUE, ORANGE, GREEN, PURPLE, RED, BLACK = "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#333333"
"""Colours of Okabe and Ito, which colour-blind readers can distinguish."""
CYCLE = (BLUE, RED, GREEN, ORANGE, PURPLE, BLACK)
STYLE = {
    "font.size": 10,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "axes.edgecolor": "#666666",
    "lines.linewidth": 1.6,
}
LAMP = (-0.35, 0.75, 0.6)
"""Direction of the light source in the axes of a picture: right, up, towards the viewer."""
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


def library():  # type: ignore[no-untyped-def]  # the module object
    """Import Matplotlib, or raise an error with a remedy."""
    try:
        import matplotlib.backends.backend_agg
        import matplotlib.figure
        import matplotlib.lines
    except ImportError:
        raise InputError("plot", "Matplotlib is not installed", "pip install matplotlib") from None
    return matplotlib


_ONE_AT_A_TIME = RLock()  # Matplotlib has one global style and is not thread-safe


@contextmanager
def styled(**more: Any) -> Iterator[None]:
    """Context with the style of all pictures, updated by ``more``; only one thread draws at a time."""
    with _ONE_AT_A_TIME, library().rc_context(STYLE | more):
        yield


def canvas(width: float, height: float) -> "Figure":
    """Create an empty figure of a width and height [inches], without a window."""
    made: Figure = library().figure.Figure(figsize=(width, height), layout="constrained")
    return made


def stops(name: str, count: int = 24) -> tuple[str, ...]:
    """Colours of a colour map from its low end to its high end, as #rrggbb."""
    chosen = library().colormaps[name](np.linspace(0.0, 1.0, count))
    return tuple(library().colors.to_hex(colour) for colour in chosen)


def lit(normal: Array) -> Array:
    """Cosines (e,) of the angles between normals (e, 3) and the direction of the light source."""
    return np.asarray(normal @ (np.array(LAMP) / np.linalg.norm(LAMP)))


def scaled(values: Array | float, unit: str) -> tuple[float, str]:
    """Factor and unit with prefix that make the largest of the finite ``values`` legible.

    Examples
    --------
    >>> scaled(3.2e8, "Pa")
    (1e-06, 'MPa')
    """
    sizes = np.abs(np.atleast_1d(values))
    greatest = float(sizes[np.isfinite(sizes)].max(initial=0.0))
    power = 3 * floor(log10(greatest) / 3 + 1e-9) if greatest > 0.0 else 0
    power = min(max(power, -12), 0 if unit == "s" else 12)
    if unit == "m" and power == 0 and greatest < 10.0 or unit in ("m", "s") and greatest == 0.0:
        power = 0
    return 10.0**-power, PREFIXES[power] + unit
