"""What a picture shall show, and how large it is."""

import re
from dataclasses import dataclass

from softway.errors import InputError

SIZE = re.compile(r"^\s*(\d{2,5})\s*[xX×]\s*(\d{2,5})\s*$")


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """Choices of a picture.

    Parameters
    ----------
    field
        What colours the bodies, such as ``von_mises``, ``velocity.x`` or ``stress.xy``; by default plastic strain where
        there is any, else von Mises stress.
    times
        Instants [s], a picture of the bodies for each; by default that of the greatest strain energy.
    size
        Width and height [pixels]; by default as it fits.
    dpi
        Pixels of an inch: texts and lines get larger with it.

    Raises
    ------
    InputError
        If a number cannot be.
    """

    field: str | None = None
    times: tuple[float, ...] = ()
    size: tuple[int, int] | None = None
    dpi: int = 160

    def __post_init__(self) -> None:
        if not 20 <= self.dpi <= 2400:
            raise InputError("--dpi", f"{self.dpi}", "a number from 20 to 2400")

    @property
    def inches(self) -> tuple[float, float] | None:
        """The size in inches."""
        return None if self.size is None else (self.size[0] / self.dpi, self.size[1] / self.dpi)


STANDARD = Look()


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
        raise InputError("--size", f"'{text}'", "width and height in pixels from 64 to 16384, such as 1280x720")
    return int(found[1]), int(found[2])
