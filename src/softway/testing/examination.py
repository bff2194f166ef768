"""Examinations with a name: each looks at one property of a subject and can be listed, run and reported alone."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import nan
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True)
class Examination:
    """One property that a subject must have.

    Parameters
    ----------
    name
        What is true of a subject that passes.
    look
        Returns the worst relative error that it met, zero where there is nothing to measure, ``nan`` where the property
        does not apply; raises ``AssertionError`` saying what is wrong.
    allowed
        Relative error that passes; zero for yes or no.
    """

    name: str
    look: Callable[[Any], float]
    allowed: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What an examination found; ``error`` and ``allowed`` are relative, ``complaint`` is empty if it passed.

    Examples
    --------
    >>> Finding(name="symmetric", passed=True, error=0.0, allowed=1e-13).complaint
    ''
    """

    name: str
    passed: bool
    error: float
    allowed: float
    complaint: str = ""


def require_all(subject: Any, examinations: Iterable[Examination]) -> None:
    """Run the examinations in turn; the first that fails raises its ``AssertionError``."""
    for examination in examinations:
        examination.look(subject)


def findings(subject: Any, examinations: Iterable[Examination]) -> tuple[Finding, ...]:
    """What every examination found; an error of any kind in the subject is a finding too.

    Examples
    --------
    >>> def positive(x: float) -> float:
    ...     assert x > 0.0, "is not positive"
    ...     return 0.0
    >>> [f.complaint for f in findings(-1.0, [Examination(name="positive", look=positive)])]
    ['is not positive']
    """
    return tuple(_found(subject, examination) for examination in examinations)


def _found(subject: Any, examination: Examination) -> Finding:
    name, allowed = examination.name, examination.allowed
    try:
        return Finding(name=name, passed=True, error=float(examination.look(subject)), allowed=allowed)
    except AssertionError as error:
        complaint = str(error).removeprefix(f"{subject}: ")
    except Exception as error:  # the subject is the user's own: whatever it raises is what is wrong with it
        complaint = f"{type(error).__name__}: {error}"
    return Finding(name=name, passed=False, error=nan, allowed=allowed, complaint=complaint)
