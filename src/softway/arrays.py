"""Types of arrays and their greatest magnitude. Docstrings write shapes with the letters defined in ARCHITECTURE.md."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


def greatest(values: Array) -> float:
    """Greatest magnitude of values of any shape, without a copy of them; zero for empty arrays.

    Examples
    --------
    >>> greatest(np.array([[0.5, -2.0]])), greatest(np.zeros(0))
    (2.0, 0.0)
    """
    return max(float(values.max(initial=0.0)), -float(values.min(initial=0.0)))
