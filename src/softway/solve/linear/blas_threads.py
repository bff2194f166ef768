"""One thread of OpenBLAS while a slab (time step) is computed.

OpenBLAS divides the products of long vectors among its threads, which then spin for a while, waiting for the next one.
They take the processors from the threads of the kernels and of PARDISO, for products that the memory bounds anyway.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cache, partial

from threadpoolctl import ThreadpoolController


def one_blas_thread() -> Callable[[], AbstractContextManager[object]]:
    """Function that makes contexts in which every loaded OpenBLAS has one thread; afterwards it has those before.

    Examples
    --------
    >>> import numpy as np
    >>> alone = one_blas_thread()
    >>> with alone():
    ...     float(np.ones(3) @ np.ones(3))
    3.0
    """
    found = _loaded()
    if all(each["num_threads"] == 1 for each in found.info()):
        return nullcontext
    return partial(found.limit, limits=1)


@cache
def _loaded() -> ThreadpoolController:
    """Every OpenBLAS that is loaded; finding them takes some milliseconds."""
    return ThreadpoolController().select(internal_api="openblas")
