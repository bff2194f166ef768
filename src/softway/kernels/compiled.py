"""How kernels are compiled, and the only types they need."""

from collections.abc import Callable
from typing import Any

from numba import cfunc, njit, types

Stage = Any
"""A compiled function ``(state, moduli)`` of one point of the lanes; both arguments are addresses of numbers."""

# Products may be fused with sums, but nothing is reordered; a division by zero is no error.
_EXACT: dict[str, Any] = {"fastmath": {"contract"}, "error_model": "numpy"}
_KERNEL = _EXACT | {"nogil": True, "cache": True, "no_cfunc_wrapper": True}
_PART = _EXACT | {"forceinline": True, "no_cfunc_wrapper": True, "no_cpython_wrapper": True}
_POINT = types.void(types.CPointer(types.float64), types.CPointer(types.float64))


def stage(function: Callable[..., None]) -> Stage:
    """A stage that kernels call by its address; kept on disk."""
    return cfunc(_POINT, cache=True, **_EXACT)(function)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """A kernel, compiled at its first call and kept on disk; it lets other threads run."""
    return njit(**_KERNEL)(function)


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """A part of a stage or a kernel."""
    return njit(**_PART)(function)
