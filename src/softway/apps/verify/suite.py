"""Cases computed in separate processes: a failure or crash of one case does not affect the others."""

from collections.abc import Callable, Sequence
from contextlib import closing

from softway.apps.verify.case import Case
from softway.apps.verify.result import Result, examined, failed
from softway.errors import Cancel
from softway.studies.processes import Complaint, answers

Watch = Callable[[Result], None]


def verified(
    cases: Sequence[Case], *, jobs: int = 1, watch: Watch | None = None, cancel: Cancel | None = None
) -> tuple[Result, ...]:
    """Compute the cases in processes, the longest first, and compare them.

    Parameters
    ----------
    cases
        Cases to compute.
    jobs
        Number of parallel processes; the threads are shared equally among their kernels.
    watch
        Called with each result when it is ready.
    cancel
        Called several times per second; returns True to stop.

    Raises
    ------
    Cancelled
        If ``cancel`` returns True.

    Returns
    -------
    tuple[Result, ...]
        Results in the order of the cases; a case that raised an error or crashed is failed, with the reason.
    """
    found: dict[str, Result] = {}
    with closing(answers(sorted(cases, key=lambda c: -c.seconds), examined, jobs, cancel)) as coming:
        for case, answer, wall in coming:
            result = failed(case, answer.text, wall) if isinstance(answer, Complaint) else answer
            found[case.id] = result
            if watch is not None:
                watch(result)
    return tuple(found[case.id] for case in cases)
