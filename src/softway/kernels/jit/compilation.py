"""Compilation of kernels, with a cache on disk.

Numba looks for changes only in the file of a kernel, but kernels share parts from other files, and the types of named
tuples do not tell the order of their entries.  The name of a cached kernel therefore contains a digest of all files
with shared parts and named tuples.
"""

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any

from numba import cfunc, njit, types
from numba.extending import register_jitable

Stage = Any
"""Compiled function with an ``address``; of a point in every lane, ``(state, moduli)``, both addresses of numbers."""

# Products may be fused with sums, but nothing is reordered; division by zero raises no error.
_EXACT: dict[str, Any] = {"fastmath": {"contract"}, "error_model": "numpy"}
_KERNEL = _EXACT | {"nogil": True, "no_cfunc_wrapper": True}
_PART = _EXACT | {"forceinline": True, "no_cfunc_wrapper": True, "no_cpython_wrapper": True}
# Numba counts references to arrays by atomic operations, which take longer than a slab of a small mechanism.
_UNCOUNTED: dict[str, Any] = {"_nrt": False}
_POINT = types.void(types.CPointer(types.float64), types.CPointer(types.float64))
_SHARED = (
    "../arrays.py",
    "../tolerances.py",
    "fused/elastic.py",
    "fused/history_stages.py",
    "fused/inelastic.py",
    "fused/mean_dilatation.py",
    "fused/mean_elastic.py",
    "fused/stages.py",
    "jit/by_address.py",
    "jit/compilation.py",
    "jit/elementary.py",
    "jit/lanes.py",
    "jit/simd.py",
    "jit/threads.py",
    "mortar/dual_basis.py",
    "mortar/facing.py",
    "mortar/gap_functions.py",
    "mortar/rows/distance_slopes.py",
    "mortar/rows/fade_slopes.py",
    "mortar/rows/heights.py",
    "mortar/rows/spread.py",
    "mortar/simplices.py",
    "mortar/tables.py",
    "mortar/triangles.py",
    "multibody/angles.py",
    "multibody/band.py",
    "multibody/copies.py",
    "multibody/drives.py",
    "multibody/energy.py",
    "multibody/forces.py",
    "multibody/joint_rows.py",
    "multibody/rotations.py",
    "multibody/slab.py",
    "multibody/tables.py",
    "multibody/velocities.py",
    "pile/ends.py",
    "pile/islands.py",
    "pile/rows.py",
    "pile/search.py",
    "pile/sweeps.py",
    "pile/tables.py",
    "pile/through.py",
    "rigid_contact/closed_stops.py",
    "rigid_contact/cone.py",
    "rigid_contact/cone_call.py",
    "rigid_contact/contact.py",
    "rigid_contact/dense.py",
    "rigid_contact/routh.py",
    "rigid_contact/tables.py",
    "rigid_course/course.py",
    "slab/apart.py",
    "slab/audit.py",
    "slab/band.py",
    "slab/driven.py",
    "slab/friction.py",
    "slab/march.py",
    "slab/products.py",
    "slab/solution.py",
    "slab/stored/closure.py",
    "slab/stored/force.py",
    "slab/stored/mixing.py",
    "slab/stored/tables.py",
    "slab/stored/turning.py",
    "slab/tables.py",
    "slab/works.py",
)
SMALL = 4000
"""Numbers of entries below which kernels of whole numbers take less time without their compilation."""
_SOURCES = b"".join((Path(__file__).parents[1] / name).read_bytes() for name in _SHARED)
_ENDING = f"_{sha256(_SOURCES).hexdigest()[:12]}"


def stage(function: Callable[..., None]) -> Stage:
    """Compile a stage, which kernels call by its address, and cache it on disk."""
    return _kept(lambda **options: cfunc(_POINT, **options), function, _EXACT)


def function_at(kind: Any, function: Callable[..., int]) -> Stage:
    """Compile a function of one argument of this kind, which kernels call by its address with a
    :func:`~softway.kernels.jit.by_address.caller` of the kind, and cache it on disk.
    """
    return _kept(lambda **options: cfunc(types.int64(kind), **options), function, _EXACT)


def uncounted_function_at(kind: Any, function: Callable[..., int]) -> Stage:
    """Compile a function as :func:`function_at`, which allocates no arrays and counts no references to them."""
    return _kept(lambda **options: cfunc(types.int64(kind), **options), function, _EXACT | _UNCOUNTED)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a kernel that is compiled at its first call, cached on disk, and lets other threads run."""
    return _kept(njit, function, _KERNEL)


def unfused_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a kernel whose products and sums are rounded one by one, as in NumPy and SciPy."""
    return _kept(njit, function, _KERNEL | {"fastmath": False})


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a function that is inlined in stages and kernels."""
    return njit(**_PART)(function)


def shared(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a part of kernels that also runs as it is, where :func:`interpreted` ones call it."""
    return register_jitable(**_EXACT)(function)  # type: ignore[no-any-return]


def interpreted(kernel: Callable[..., Any], small: bool) -> Callable[..., Any]:
    """Function of a kernel of whole numbers, not compiled for ``small`` arguments: it takes less than its compilation.

    Kernels of floating-point numbers round differently when compiled.
    """
    return kernel.py_func if small else kernel  # type: ignore[attr-defined, no-any-return]


def uncounted_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a kernel that allocates no arrays and counts no references to them; its parts are ``uncounted``."""
    return _kept(njit, function, _KERNEL | _UNCOUNTED)


def uncounted(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a function that is inlined in kernels, allocates no arrays and counts no references to them."""
    return njit(**_PART, **_UNCOUNTED)(function)


def called(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a function as ``uncounted``, which is called and not inlined: it is compiled once, for a few nanoseconds
    more in each call.
    """
    return njit(**(_PART | {"forceinline": False}), **_UNCOUNTED)(function)


def merged(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a function as ``called``, whose statements are put into its callers before these are compiled: for parts of
    one kernel.  Numba optimises a function again in each function that calls it, and in the callers of these.
    """
    return njit(**(_PART | {"forceinline": False, "inline": "always"}), **_UNCOUNTED)(function)


def _kept(compiler: Callable[..., Any], function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Compile a function, with a cache on disk if there is a writable folder."""
    function.__qualname__ = function.__qualname__.removesuffix(_ENDING) + _ENDING  # safe if two threads do this at once
    try:
        return compiler(cache=True, **options)(function)
    except RuntimeError:
        return compiler(**options)(function)
