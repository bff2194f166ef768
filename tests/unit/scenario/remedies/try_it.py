"""Remedies that are tried: a change that is refused, what its remedy says, and the change that follows the remedy."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softway.errors import InputError
from softway.scenario.checks.check import check
from softway.scenario.files import loads
from softway.scenario.hints.units_text import Units
from softway.scenario.text.user_modules import Modules

UNITS = Units.standard()
SOLID = """
kind = "Solid"
material = { kind = "LinearElastic", E = 1, nu = 0.3 }
density = 1
"""
TIME = """
[time]
end = 0.01
"""
PLANE = f"""
[bodies.b]
mesh = {{ kind = "Rectangle", size = [1, 1], cells = [3, 3], origin = [0, 0.01] }}
{SOLID}
[bodies.w]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0, 0], normal = [0, 1] }}
[[contacts]]
between = ["b.bottom", "w"]
{TIME}
"""
"""A square above a floor."""
TWO = f"""
[bodies.b]
mesh = {{ kind = "Rectangle", size = [1, 1], cells = [3, 3], origin = [0, 0.01] }}
{SOLID}
[bodies.c]
mesh = {{ kind = "Rectangle", size = [1, 1], cells = [3, 3], origin = [0, -1] }}
{SOLID}
[[contacts]]
between = ["b.bottom", "c.top"]
{TIME}
"""
"""Two squares, one above the other."""
SPACE = f"""
[bodies.b]
mesh = {{ kind = "Box", size = [1, 1, 1], cells = [3, 3, 3], origin = [0, 0, 0.01] }}
{SOLID}
[bodies.w]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0, 0, 0], normal = [0, 0, 1] }}
[[contacts]]
between = ["b.bottom", "w"]
{TIME}
"""
"""A cube above a floor."""
BAR = f"""
[bodies.b]
mesh = {{ kind = "Interval", length = 1, cells = 4, origin = 0.01 }}
{SOLID}
[bodies.w]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = 0, normal = 1 }}
[[contacts]]
between = ["b.left", "w"]
{TIME}
"""
"""A bar in front of a wall."""


@dataclass(frozen=True, slots=True)
class Try:
    """Scenario that is refused, and what follows its remedy.

    Parameters
    ----------
    text
        Scenario that is right.
    wrong
        Changes, "&" between several, with which it is refused.
    remedy
        Part of the remedy.
    follow
        Changes after these that follow the remedy.
    then
        Part of the next message, where following leads to another one.
    """

    text: str
    wrong: str
    remedy: str
    follow: str
    then: str = ""

    def begin(self, folder: Path) -> None:
        """Check what is refused."""
        _checked(self.text, _split(self.wrong), folder)

    def go_on(self, folder: Path) -> None:
        """Check what follows the remedy."""
        _checked(self.text, [*_split(self.wrong), *_split(self.follow)], folder)


@dataclass(frozen=True, slots=True)
class Call:
    """Call from Python, with the folder of the files, that is refused, and the one that follows its remedy."""

    wrong: Callable[[Path], object]
    remedy: str
    follow: Callable[[Path], object]
    then: str = ""

    def begin(self, folder: Path) -> None:
        """Call what is refused."""
        self.wrong(folder)

    def go_on(self, folder: Path) -> None:
        """Call what follows the remedy."""
        self.follow(folder)


Table = Mapping[str, Try | Call]


def refusal(call: Callable[[], object]) -> InputError | None:
    """Refusal of a call; None if it ends."""
    try:
        call()
    except InputError as error:
        return error
    return None


def _split(changes: str) -> list[str]:
    return changes.split(" & ") if changes else []


def _checked(text: str, changes: list[str], folder: Path) -> None:
    """Read and check a scenario with changes."""
    check(loads(text, changes=changes, units=UNITS, modules=Modules(folder=folder)))


def sites(error: BaseException | None) -> set[tuple[str, int]]:
    """File below the package and line of every refusal that led to an error, those whose place was completed too."""
    found = set()
    while error is not None:
        trace: Any = error.__traceback__
        while trace is not None:
            last, trace = trace, trace.tb_next
        name = last.tb_frame.f_code.co_filename.replace("\\", "/")
        found.add((name.rpartition("/softway/")[2], last.tb_lineno))
        error = error.__context__
    return found
