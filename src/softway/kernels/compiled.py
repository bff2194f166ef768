"""How kernels are compiled and kept on disk.

Numba looks for a change of a kernel in the file of the kernel alone, but kernels share parts from other files: the name
under which one is kept therefore holds a digest of those.
"""

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any

from numba import cfunc, njit, types

Stage = Any
"""A compiled function ``(state, moduli)`` of one point of the lanes; both arguments are addresses of numbers."""

# Products may be fused with sums, but nothing is reordered; a division by zero is no error.
_EXACT: dict[str, Any] = {"fastmath": {"contract"}, "error_model": "numpy"}
_KERNEL = _EXACT | {"nogil": True, "no_cfunc_wrapper": True}
_PART = _EXACT | {"forceinline": True, "no_cfunc_wrapper": True, "no_cpython_wrapper": True}
_POINT = types.void(types.CPointer(types.float64), types.CPointer(types.float64))
_SHARED = ("compiled.py", "functions.py", "fused_past.py", "lanes.py", "past.py", "stages.py", "vectors.py")
_SOURCES = b"".join(Path(__file__).with_name(name).read_bytes() for name in _SHARED)
_ENDING = f"_{sha256(_SOURCES).hexdigest()[:12]}"


def stage(function: Callable[..., None]) -> Stage:
    """A stage, which kernels call by its address; kept on disk."""
    return _kept(lambda **options: cfunc(_POINT, **options), function, _EXACT)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """A kernel, compiled at its first call and kept on disk; it lets other threads run."""
    return _kept(njit, function, _KERNEL)


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """A part of a stage or a kernel."""
    return njit(**_PART)(function)


def _kept(compiler: Callable[..., Any], function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """The compiled function, kept on disk where there is a folder to write to."""
    function.__qualname__ = function.__qualname__.removesuffix(_ENDING) + _ENDING  # by two threads at once, too
    try:
        return compiler(cache=True, **options)(function)
    except RuntimeError:
        return compiler(**options)(function)
