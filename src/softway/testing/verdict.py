"""Assertions of the examinations."""

import numpy as np
from numpy.typing import ArrayLike


def require(passed: bool, subject: object, complaint: str) -> None:
    """Raise ``AssertionError`` with the subject and the complaint unless ``passed``."""
    if not passed:
        raise AssertionError(f"{subject}: {complaint}")


def close(
    got: ArrayLike, expected: ArrayLike, tolerance: float, subject: object, complaint: str, scale: float = 0.0
) -> float:
    """Require agreement within ``tolerance`` times the largest expected value, or times ``scale`` if that is larger.

    Returns the error relative to that value.

    Examples
    --------
    >>> close([1.0, 2.0], [1.0, 2.1], 1e-3, "law", "stress is off")
    Traceback (most recent call last):
    AssertionError: law: stress is off: error 0.1 of 2.1, tolerated 0.0021
    """
    a, b = np.asarray(got, float), np.asarray(expected, float)
    error, size = float(np.max(np.abs(a - b))), max(float(np.max(np.abs(b))), scale)
    allowed = tolerance * size
    require(error <= allowed, subject, f"{complaint}: error {error:.3g} of {size:.3g}, tolerated {allowed:.3g}")
    return error / size if size else 0.0
