"""Result of a case, compared with its reference."""

import time as clock
from dataclasses import dataclass

from softway.apps.verify.case import Beside, Case
from softway.apps.verify.quantity import Quantity, compared
from softway.record.view.plots.curves import Panel


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """Result of a case, compared with its reference.

    Parameters
    ----------
    case
        The case.
    quantities
        Quantities in the order of the data file.
    panels, tables
        Curves and comparison tables for the report.
    wall
        Wall time [s].
    complaint
        Reason why the case could not be computed; empty if it was computed.
    """

    case: Case
    quantities: tuple[Quantity, ...]
    panels: tuple[Panel, ...] = ()
    tables: tuple[Beside, ...] = ()
    wall: float = 0.0
    complaint: str = ""

    @property
    def passed(self) -> bool:
        """True if every quantity is within its tolerance."""
        return all(quantity.passed for quantity in self.quantities)


def examined(case: Case) -> Result:
    """Compute a case in this process and compare it with its reference.

    Examples
    --------
    >>> from softway.apps.verify.catalogue import chosen
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
    """Result of a case that could not be computed; all quantities are missing."""
    return Result(case=case, quantities=compared(case.sheet, {}), wall=wall, complaint=complaint)
