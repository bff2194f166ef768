"""First step of a march, computed before there is a folder to record it in."""

from collections.abc import Iterator
from typing import TypeVar

from softway.errors import Cancelled, NumericsError

S = TypeVar("S")


def first_step(steps: Iterator[S]) -> tuple[S | None, BaseException | None]:
    """Compute the first step, or return the exception that prevented it; an InputError is raised at once.

    Examples
    --------
    >>> first_step(iter([1, 2]))
    (1, None)
    """
    try:
        return next(steps, None), None
    except (KeyboardInterrupt, Cancelled, NumericsError) as error:
        return None, error


def chained(first: S | None, early: BaseException | None, rest: Iterator[S]) -> Iterator[S]:
    """All steps, with the first one and the exception of :func:`first_step`.

    Examples
    --------
    >>> steps = iter([1, 2, 3])
    >>> list(chained(*first_step(steps), steps))
    [1, 2, 3]
    """
    if early is not None:
        raise early
    if first is not None:
        yield first
        yield from rest
