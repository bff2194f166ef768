"""The cases there are."""

import difflib
from collections.abc import Iterable, Mapping

from softway.errors import InputError
from softway.verify.case import Case

QUICK = 11.0
"""Seconds that a case of the quick suite may take."""


SECONDS: Mapping[str, float] = {
    "A01": 0.1,
    "A02": 3.0,
    "A03": 11.0,
    "A04": 4.0,
    "A05": 6.0,
    "A06": 11.0,
    "A07": 14.0,
    "A08": 45.0,
    "A09": 45.0,
    "A10": 4.0,
    "A11": 12.0,
    "A12": 1.5,
    "B01": 3.0,
    "B02": 17.0,
    "B03": 0.3,
    "B04": 1.0,
    "B05": 1.0,
    "B06": 0.5,
    "B07": 1.0,
    "B08": 2.0,
    "B09": 90.0,
    "C01": 8.0,
    "C02": 10.0,
    "C03": 30.0,
    "C04": 6.0,
    "C05": 120.0,
    "C06": 100.0,
    "C07": 0.1,
    "C08": 8.0,
    "C09": 8.0,
    "D01": 0.6,
    "D02": 0.3,
    "D03": 0.3,
    "D04": 7.0,
    "D05": 75.0,
    "D06": 50.0,
    "D07": 0.5,
    "D08": 0.6,
    "D09": 80.0,
    "D10": 1.7,
    "E01": 2.0,
    "E02": 8.0,
    "E03": 10.0,
    "E04": 4.0,
    "E05": 6.0,
    "E06": 1.5,
    "classic": 1.0,
    "peers": 3.0,
}
"""Seconds that each case takes alone on one core."""


def listed() -> tuple[Case, ...]:
    """All cases in order.

    Examples
    --------
    >>> [case.id for case in listed()][:3]
    ['A01', 'A02', 'A03']
    """
    return tuple(Case(id=name, seconds=seconds) for name, seconds in SECONDS.items())


def chosen(ids: Iterable[str] = (), *, quick: bool = False) -> tuple[Case, ...]:
    """The cases of some ids, capitals aside, or of the beginnings of ids; all without any.

    Parameters
    ----------
    ids
        ``A02`` is that case, ``B`` all whose id begins with B.
    quick
        Only those that take at most ``QUICK`` seconds.

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
