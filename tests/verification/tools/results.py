"""Cases of the suite computed once for all tests of a process."""

from functools import cache
from typing import Any

from softway.apps.verify import Quantity, chosen, compared, examined
from softway.apps.verify.case import sheet

Results = dict[str, Any]
case = cache(sheet)


@cache
def verdicts(name: str) -> dict[str, Quantity]:
    """The comparison of a case by quantity."""
    (found,) = chosen([name])
    return {quantity.name: quantity for quantity in examined(found).quantities}


def missed(name: str) -> set[str]:
    """Quantities of a case that are not within their tolerance."""
    return {name for name, quantity in verdicts(name).items() if not quantity.passed}


def outside(name: str, found: Results) -> set[str]:
    """Quantities of a case that are not within their tolerance, of results computed elsewhere."""
    return {quantity.name for quantity in compared(case(name), found) if not quantity.passed}
