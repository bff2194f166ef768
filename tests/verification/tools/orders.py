"""Observed orders of convergence."""

from collections.abc import Iterable

import numpy as np


def order(errors: Iterable[float], steps: Iterable[float]) -> float:
    """Least observed order between successive steps.

    >>> round(order([4e-4, 1e-4, 2.5e-5], [0.04, 0.02, 0.01]), 12)
    2.0
    """
    e, h = np.array(list(errors)), np.array(list(steps))
    return float(np.min(np.log(e[:-1] / e[1:]) / np.log(h[:-1] / h[1:])))
