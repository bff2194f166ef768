"""Named examinations. Each one checks one property and can be listed, run and reported alone."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import nan
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True)
class Examination:
    """Check of one property of a subject.

    Parameters
    ----------
    name
        Property of a subject that passes.
    look
        Function that returns the largest relative error. It returns zero if there is nothing to measure and ``nan`` if
        the property does not apply. It raises ``AssertionError`` with a message if the subject fails.
    allowed
        Greatest relative error that passes; zero for a yes/no property.
    """

    name: str
    look: Callable[[Any], float]
    allowed: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Result of an examination; ``error`` and ``allowed`` are relative, ``complaint`` is empty if it passed.

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
    """Run the examinations in turn; the first failure raises its ``AssertionError``."""
    for examination in examinations:
        examination.look(subject)


def findings(subject: Any, examinations: Iterable[Examination]) -> tuple[Finding, ...]:
    """Results of all examinations; any exception raised by the subject is reported as a finding.

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
    except Exception as error:  # user code: any exception is reported as a finding
        complaint = f"{type(error).__name__}: {error}"
    return Finding(name=name, passed=False, error=nan, allowed=allowed, complaint=complaint)
