"""Checks shared by the settings of iterative methods."""

from softway.errors import InputError, real


def check_accuracy(tolerance: float, limit: int) -> None:
    """Refuse a tolerance that is out of range, and a limit below one iteration.

    Examples
    --------
    >>> check_accuracy(1e-11, 60)
    """
    real(tolerance, "tolerance")
    if not 0.0 < tolerance <= 1e-2:
        raise InputError("tolerance", f"{tolerance:g}", "a number above 0, at most 1e-2; 1e-11 is usual")
    if limit < 1:
        raise InputError("limit", f"{limit} iterations", "at least 1")


def check_products(tolerance: float, limit: int) -> None:
    """Refuse conjugate gradients that do not reduce the residual, and a limit below one product.

    Examples
    --------
    >>> check_products(1e-2, 500)
    """
    real(tolerance, "tolerance")
    if not 0.0 < tolerance < 1.0:
        raise InputError("tolerance", f"{tolerance:g}", "a number between 0 and 1")
    if limit < 1:
        raise InputError("limit", f"{limit} products", "at least 1")
