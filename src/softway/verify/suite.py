"""Cases computed in processes of their own: what one of them does, or dies of, does not reach another."""

from collections.abc import Callable, Sequence
from contextlib import closing

from softway.crew import Complaint, answers
from softway.errors import Cancel
from softway.verify.case import Case
from softway.verify.result import Result, examined, failed

Watch = Callable[[Result], None]


def verified(
    cases: Sequence[Case], *, jobs: int = 1, watch: Watch | None = None, cancel: Cancel | None = None
) -> tuple[Result, ...]:
    """Compute the cases in processes, the longest first, and compare them.

    Parameters
    ----------
    cases
        Which ones.
    jobs
        Processes beside each other; the kernels of each use its share of the threads.
    watch
        Is called with each result as it comes.
    cancel
        Asked a few times a second whether the caller wants no more.

    Raises
    ------
    Cancelled
        If it says so.

    Returns
    -------
    tuple[Result, ...]
        In the order of the cases; one that raised an error, or whose process died, is a failed one with the reason.
    """
    found: dict[str, Result] = {}
    with closing(answers(sorted(cases, key=lambda c: -c.seconds), examined, jobs, cancel)) as coming:
        for case, answer, wall in coming:
            result = failed(case, answer.text, wall) if isinstance(answer, Complaint) else answer
            found[case.id] = result
            if watch is not None:
                watch(result)
    return tuple(found[case.id] for case in cases)
