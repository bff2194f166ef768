"""Options of a picture: field, instants and size."""

import re
from dataclasses import dataclass

from softway.errors import InputError

SIZE = re.compile(r"^\s*(\d{2,5})\s*[xX×]\s*(\d{2,5})\s*$")


@dataclass(frozen=True, slots=True, kw_only=True)
class PictureOptions:
    """Options of a picture.

    Parameters
    ----------
    field
        Field that colours the bodies, such as ``von_mises``, ``velocity.x`` or ``stress.xy``; by default plastic strain
        if there is any, and von Mises stress otherwise.  Of bars that conduct heat
        the field that is drawn along them, by default the temperature; of a pile ``speed`` or ``body``, the group of a
        ball.
    times
        Instants [s]; the bodies are drawn at each of them.  By default the instant of the largest strain energy, of
        solids with a temperature that of the largest von Mises stress.
    size
        Width and height [pixels]; by default adapted to the content.
    dpi
        Pixels per inch; texts and lines become larger with it.

    Raises
    ------
    InputError
        If ``dpi`` is outside of the range from 20 to 2400.
    """

    field: str | None = None
    times: tuple[float, ...] = ()
    size: tuple[int, int] | None = None
    dpi: int = 160

    def __post_init__(self) -> None:
        if not 20 <= self.dpi <= 2400:
            raise InputError("--dpi", f"{self.dpi} is out of range", "a number from 20 to 2400")

    @property
    def inches(self) -> tuple[float, float] | None:
        """Width and height [inches]; None without a size."""
        return None if self.size is None else (self.size[0] / self.dpi, self.size[1] / self.dpi)


STANDARD = PictureOptions()


def size_of(text: str | None) -> tuple[int, int] | None:
    """Width and height from a text such as ``1280x720``.

    Examples
    --------
    >>> size_of("1280x720")
    (1280, 720)
    """
    if text is None:
        return None
    found = SIZE.match(text)
    if found is None or not all(64 <= int(n) <= 16384 for n in found.groups()):
        raise InputError("--size", f"'{text}' is no size", "width x height from 64 to 16384 pixels, such as 1280x720")
    return int(found[1]), int(found[2])
