"""Rejected slabs (time steps): their count, and the end of a march that leads nowhere."""

from softway.errors import NumericsError
from softway.marching.slab.endings import crushed, remedy, touching
from softway.marching.slab.slab_step import Stepper
from softway.marching.start.slab_length import proposed
from softway.marching.state.march_state import MarchState, StepHistory
from softway.marching.state.step_control import CRAWL, ENDLESS


def require_progress(stepper: Stepper, march_state: MarchState, length: float) -> None:
    """End a march whose slabs stay far below the requested length, with more than ``ENDLESS`` of them ahead.

    Raises
    ------
    NumericsError
        With the length, the contacts and the last rejection, once the patience is used up.
    """
    history, now, control = march_state.step_history, march_state.state, march_state.settings.control
    left = (march_state.settings.until - now.time) / length
    if history.recent_rejections <= control.patience or length > CRAWL * history.span or left <= ENDLESS:
        return
    last = f"; the last rejection: {history.last_rejection}" if history.last_rejection else ""
    raise NumericsError(
        f"the time step stays at h = {length:.3g} s of the {history.span:.3g} s given, {left:.1g} more of them lead to "
        f"the end{last}{touching(stepper.model, now)}{crushed(stepper.model, now)}",
        now.time,
        f"{possible_remedies(stepper, march_state)}, or to go on regardless time.control.patience = "
        f"{10 * control.patience:.0f}",
    )


def recent_rejections(before: StepHistory, span: float, rejections: int, left: float = 0.0) -> float:
    """Number of recent rejections in slabs far below the requested length; four such slabs without any cancel one.

    A slab after which more than ``ENDLESS`` of its length are ``left`` counts as a rejection.

    Examples
    --------
    >>> from dataclasses import replace
    >>> history, found = StepHistory(span=1.0, length=1.0), []
    >>> for span, rejections in [(0.5, 3), (0.009, 2), (0.009, 2), (0.009, 0), (0.02, 1)]:
    ...     history = replace(history, recent_rejections=recent_rejections(history, span, rejections))
    ...     found.append(history.recent_rejections)
    >>> found
    [0.0, 2.0, 4.0, 3.75, 0.0]
    >>> recent_rejections(history, 1e-7, 0, left=9e6)
    1.0
    """
    more = rejections or (1.0 if left > ENDLESS else -0.25)
    return max(0.0, before.recent_rejections + more) if span <= CRAWL * before.span else 0.0


def possible_remedies(stepper: Stepper, march_state: MarchState) -> str:
    """Possible remedies if no time step was accepted."""
    settings = march_state.settings
    usual = proposed(stepper.model, "auto", settings.weight, settings.until, settings.method)
    return remedy(stepper, march_state, usual)
