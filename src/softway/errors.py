"""What can go wrong, said so that a person can act: where, what, and what to try."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager


class SoftwayError(Exception):
    """Base of every error that softway raises on purpose."""


class InputError(SoftwayError):
    """The description of the problem is wrong; nothing was computed.

    Parameters
    ----------
    where
        Path in the scenario, as ``bodies.bar.material.nu``.
    problem
        What is wrong, with the value.
    remedy
        What to write instead.
    """

    def __init__(self, where: str, problem: str, remedy: str = "") -> None:
        self.where, self.problem, self.remedy = where, problem, remedy
        super().__init__(": ".join(p for p in (where, problem) if p) + (f"\n  try: {remedy}" if remedy else ""))

    def within(self, prefix: str) -> "InputError":
        """The same error seen from one level further out: ``prefix`` is put before its path."""
        path = f"{prefix}.{self.where}" if self.where else prefix
        return InputError(path, self.problem, self.remedy)


class NumericsError(SoftwayError):
    """The computation failed; every step accepted before stays valid.

    Parameters
    ----------
    what, when, remedy
        What failed (with numbers), at which time, and what to try.
    """

    def __init__(self, what: str, when: float, remedy: str = "") -> None:
        self.what, self.when, self.remedy = what, when, remedy
        super().__init__(f"t = {when:.6g} s: {what}" + (f"\n  try: {remedy}" if remedy else ""))


class StorageError(SoftwayError):
    """The records of a run could not be written; those written before stay valid, and the run can be resumed.

    Parameters
    ----------
    place, problem, remedy
        Which folder, what the system says, and what to do.
    """

    def __init__(self, place: str, problem: str, remedy: str) -> None:
        self.place, self.problem, self.remedy = place, problem, remedy
        super().__init__(f"{place}: {problem}\n  try: {remedy}")


class Cancelled(SoftwayError):
    """The caller called the computation off; what was accepted before stays valid, and a run can be resumed.

    Parameters
    ----------
    where
        How far it had come.
    """

    def __init__(self, where: str = "") -> None:
        self.where = where
        super().__init__(f"cancelled {where}".rstrip())


Cancel = Callable[[], bool]
"""Whether the caller wants no more, as ``threading.Event().is_set``: asked often, and to be answered in no time."""


def heed(cancel: Cancel | None, when: float) -> None:
    """Raise :class:`Cancelled` if the caller wants no more at a time [s] of the march.

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
    """Refuse what is no real number, before anything is computed with it.

    Examples
    --------
    >>> real("1 Pa", "E")
    Traceback (most recent call last):
    softway.errors.InputError: E: '1 Pa' is not a number
      try: a number in SI units; texts with a unit belong into a scenario file
    """
    try:
        float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        known = False
    else:
        known = not isinstance(value, str | bytes)
    if not known:
        remedy = "a number in SI units; texts with a unit belong into a scenario file"
        raise InputError(where, f"{value!r:.60} is not a number", remedy)


class NoConvergence(Exception):
    """A slab could not be solved; the march drops it and tries a shorter one. The message says what happened."""


class Unbalanced(Exception):
    """The energy balance of a slab needs a scalar beyond its bound; the march tries a shorter one."""


class Halts(Exception):
    """A body comes to rest on another one inside a slab, after a ``share`` of it; the march ends the slab there."""

    def __init__(self, share: float) -> None:
        self.share = share
        super().__init__(f"slip ends after {share:.6g} of the slab")


class TooFast(Exception):
    """A slab is too long for the approach of two surfaces; the march tries a shorter one. The message says where."""


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
