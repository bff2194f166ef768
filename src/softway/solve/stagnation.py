"""Stagnation of an iteration: the number of iterates since its change last halved."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Stagnation:
    """Progress of an iteration.

    Parameters
    ----------
    best
        Least change at which progress was seen.
    since
        Number of iterates since then.

    Examples
    --------
    >>> seen = Stagnation()
    >>> for change in (1.0, 0.4, 0.3, 0.25):
    ...     seen = seen.after(change)
    >>> seen
    Stagnation(best=0.4, since=2)
    >>> seen.after(0.1, rounding=0.5)
    Stagnation(best=0.4, since=3)
    """

    best: float = np.inf
    since: int = 0

    def after(self, change: float, rounding: float = 0.0) -> "Stagnation":
        """Progress after an iterate with a change: a change below half of the best one is progress.

        There is none below a best change of ``rounding``: there changes fall and grow by chance.
        """
        better = change < 0.5 * self.best and self.best > rounding
        return Stagnation(change, 0) if better else Stagnation(self.best, self.since + 1)
