"""Exceptions of softway, and notes on a scenario. Each one names the place, the problem and a remedy."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import inf


class SoftwayError(Exception):
    """Base of every error that softway raises on purpose."""


class InputError(SoftwayError):
    """Error in the description of the problem; nothing was computed.

    Parameters
    ----------
    where
        Path in the scenario, such as ``bodies.bar.material.nu``.
    problem
        Description of the error, with the value.
    remedy
        Text or value to write instead.
    """

    def __init__(self, where: str, problem: str, remedy: str = "") -> None:
        self.where, self.problem, self.remedy = where, problem, remedy
        super().__init__(": ".join(p for p in (where, problem) if p) + (f"\n  try: {remedy}" if remedy else ""))

    def within(self, prefix: str) -> "InputError":
        """Return this error with ``prefix`` put before its path."""
        path = f"{prefix}.{self.where}" if self.where else prefix
        return InputError(path, self.problem, self.remedy)


@dataclass(frozen=True, slots=True, kw_only=True)
class Note:
    """Remark on a scenario that is computed, although its results may be wrong.

    Parameters
    ----------
    where
        Path in the scenario, such as ``bodies.bar.mesh``.
    problem
        Description of the doubt, with numbers.
    remedy
        Text or value to write instead.

    Examples
    --------
    >>> print(Note(where="mesh", problem="2 parts that share no node").within("bodies.bar"))
    bodies.bar.mesh: 2 parts that share no node
    """

    where: str
    problem: str
    remedy: str = ""

    def __str__(self) -> str:
        """Text of the note, with its remedy in a second line."""
        return f"{self.where}: {self.problem}" + (f"\n  try: {self.remedy}" if self.remedy else "")

    def within(self, prefix: str) -> "Note":
        """Return this note with ``prefix`` put before its path."""
        return Note(where=f"{prefix}.{self.where}", problem=self.problem, remedy=self.remedy)


class NumericsError(SoftwayError):
    """Failure of the computation; all steps accepted before it stay valid.

    Parameters
    ----------
    what, when, remedy
        Description of the failure (with numbers), its time [s], and a remedy.
    """

    def __init__(self, what: str, when: float, remedy: str = "") -> None:
        self.what, self.when, self.remedy = what, when, remedy
        super().__init__(f"t = {when:.6g} s: {what}" + (f"\n  try: {remedy}" if remedy else ""))


class StorageError(SoftwayError):
    """Failure to write the records of a run; records already written stay valid and the run can be resumed.

    Parameters
    ----------
    place, problem, remedy
        Folder, message of the operating system, and a remedy.
    """

    def __init__(self, place: str, problem: str, remedy: str) -> None:
        self.place, self.problem, self.remedy = place, problem, remedy
        super().__init__(f"{place}: {problem}\n  try: {remedy}")


class Cancelled(SoftwayError):
    """Cancellation of the computation by the caller; accepted steps stay valid and a run can be resumed.

    Parameters
    ----------
    where
        Point that the computation had reached.
    """

    def __init__(self, where: str = "") -> None:
        self.where = where
        super().__init__(f"cancelled {where}".rstrip())


Cancel = Callable[[], bool]
"""Function that returns True to cancel, such as ``threading.Event().is_set``. It is called often and must be fast."""


def heed(cancel: Cancel | None, when: float) -> None:
    """Raise :class:`Cancelled` if the caller has cancelled; ``when`` is the current time [s] of the march.

    Examples
    --------
    >>> heed(lambda: False, 0.25)
    >>> heed(lambda: True, 0.25)
    Traceback (most recent call last):
    softway.errors.Cancelled: cancelled in the slab at t = 0.25 s
    """
    if cancel is not None and cancel():
        raise Cancelled(f"in the slab at t = {when:.6g} s")


def real(value: object, where: str) -> None:
    """Raise :class:`InputError` if a value is not a real number.

    Examples
    --------
    >>> real("1 Pa", "E")
    Traceback (most recent call last):
    softway.errors.InputError: E: '1 Pa' is not a number
      try: a number in SI units; text with a unit is accepted only in a scenario file
    """
    try:
        float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        known = False
    else:
        known = not isinstance(value, str | bytes)
    if not known:
        remedy = "a number in SI units; text with a unit is accepted only in a scenario file"
        raise InputError(where, f"{value!r:.60} is not a number", remedy)


def positive(**values: float) -> None:
    """Raise :class:`InputError` for a value that is not positive and finite; the error has its name as the place.

    Examples
    --------
    >>> positive(area=-1.0)
    Traceback (most recent call last):
    softway.errors.InputError: area: -1 is not positive
      try: a positive number
    """
    for name, value in values.items():
        if not 0.0 < value < inf:
            raise InputError(name, f"{value:g} is not positive", "a positive number")


class NoConvergence(Exception):
    """Failure to solve a slab; the march rejects it and tries a shorter one. The message gives the reason.

    ``contracting`` tells that an iteration was on its way to a solution when it reached its limit.
    """

    def __init__(self, reason: str, contracting: bool = False) -> None:
        self.contracting = contracting
        super().__init__(reason)


class Unbalanced(Exception):
    """Energy balance of a slab that needs a scalar beyond its bound; the march tries a shorter slab."""


class Halts(Exception):
    """End of the slip between two bodies after a ``fraction`` of the slab; the march ends the slab there."""

    def __init__(self, fraction: float) -> None:
        self.fraction = fraction
        super().__init__(f"slip ends after {fraction:.6g} of the slab")


class TooFast(Exception):
    """Slab that is too long for the approach of two surfaces; the march tries a shorter one. The message says where."""


@contextmanager
def within(path: str) -> Iterator[None]:
    """Put ``path`` before the place of an :class:`InputError` raised inside.

    Examples
    --------
    >>> try:
    ...     with within("bodies.bar"):
    ...         raise InputError("density", "-1 kg/m^3 is not positive")
    ... except InputError as error:
    ...     print(error)
    bodies.bar.density: -1 kg/m^3 is not positive
    """
    try:
        yield
    except InputError as error:
        raise error.within(path) from None
