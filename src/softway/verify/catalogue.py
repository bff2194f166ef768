"""The cases there are."""

import difflib
from collections.abc import Iterable

from softway.errors import InputError
from softway.verify.case import Case

QUICK = 12.0
"""Seconds that a case of the quick suite may take."""


def listed() -> tuple[Case, ...]:
    """All cases in order, with the seconds that each takes alone on one core.

    Examples
    --------
    >>> [case.id for case in listed()][:3]
    ['A01', 'A02', 'A03']
    """
    return (
        Case(id="A01", seconds=0.1),
        Case(id="A02", seconds=3.0),
        Case(id="A03", seconds=11.0),
        Case(id="A04", seconds=4.0),
        Case(id="A05", seconds=6.0),
        Case(id="A06", seconds=11.0),
        Case(id="A07", seconds=14.0),
        Case(id="A08", seconds=45.0),
        Case(id="A09", seconds=45.0),
        Case(id="A10", seconds=4.0),
        Case(id="A11", seconds=12.0),
        Case(id="A12", seconds=1.5),
        Case(id="B01", seconds=3.0),
        Case(id="B02", seconds=17.0),
        Case(id="B03", seconds=0.3),
        Case(id="B04", seconds=1.0),
        Case(id="B05", seconds=1.0),
        Case(id="B06", seconds=0.5),
        Case(id="B07", seconds=1.0),
        Case(id="B08", seconds=2.0),
        Case(id="B09", seconds=90.0),
        Case(id="C01", seconds=8.0),
        Case(id="C02", seconds=11.0),
        Case(id="C04", seconds=6.0),
        Case(id="C08", seconds=8.0),
        Case(id="C09", seconds=8.0),
        Case(id="classic", seconds=1.0),
        Case(id="peers", seconds=3.0),
    )


def chosen(ids: Iterable[str] = (), *, quick: bool = False) -> tuple[Case, ...]:
    """The cases of some ids, capitals aside, or of the beginnings of ids; all without any.

    Parameters
    ----------
    ids
        ``A02`` is that case, ``B`` all whose id begins with B.
    quick
        Only those that take at most :data:`QUICK` seconds.

    Raises
    ------
    InputError
        There is no such case, or none is left.

    Examples
    --------
    >>> [case.id for case in chosen(["a02"])]
    ['A02']
    """
    everything = listed()
    wanted = [word.upper() for word in ids]
    for word in wanted:
        if not any(case.id.upper().startswith(word) for case in everything):
            raise _unknown(word, [case.id for case in everything])
    found = [c for c in everything if not wanted or any(c.id.upper().startswith(word) for word in wanted)]
    kept = tuple(case for case in found if not quick or case.seconds <= QUICK)
    if not kept:
        names = ", ".join(case.id for case in found)
        raise InputError("--quick", f"none of {names} takes less than {QUICK:g} s", "the same without --quick")
    return kept


def _unknown(word: str, known: list[str]) -> InputError:
    near = difflib.get_close_matches(word, known, n=1, cutoff=0.5)
    guess = f"did you mean {near[0]}? " if near else ""
    return InputError("IDS", f"no case '{word}'", f"{guess}known: {', '.join(known)}")
