"""A case that was computed, or could not be, beside its reference."""

import time as clock
from dataclasses import dataclass

from softway.record.view_curves import Panel
from softway.verify.case import Beside, Case
from softway.verify.quantity import Quantity, compared


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """A case compared with its reference.

    Parameters
    ----------
    case
        Which one.
    quantities
        In the order of its file.
    panels, tables
        For the report.
    wall
        Seconds it took.
    complaint
        Why it could not be computed; empty if it was.
    """

    case: Case
    quantities: tuple[Quantity, ...]
    panels: tuple[Panel, ...] = ()
    tables: tuple[Beside, ...] = ()
    wall: float = 0.0
    complaint: str = ""

    @property
    def passed(self) -> bool:
        """Whether every quantity is within its tolerance."""
        return all(quantity.passed for quantity in self.quantities)


def examined(case: Case) -> Result:
    """Compute a case here and compare it.

    Examples
    --------
    >>> from softway.verify.catalogue import chosen
    >>> [(q.name, q.passed) for q in examined(chosen(["A01"])[0]).quantities][2]
    ('stability limit of const weighting', True)
    """
    start = clock.perf_counter()
    outcome = case.compute()
    return Result(
        case=case,
        quantities=compared(case.sheet, outcome.values),
        panels=outcome.panels,
        tables=outcome.tables,
        wall=clock.perf_counter() - start,
    )


def failed(case: Case, complaint: str, wall: float = 0.0) -> Result:
    """A case that could not be computed: all its quantities are missing."""
    return Result(case=case, quantities=compared(case.sheet, {}), wall=wall, complaint=complaint)
