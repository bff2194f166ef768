"""Door of Warp: ``wp`` is the library, or a stand-in that lets the kernels be imported where it is not installed."""

from typing import Any

__all__ = ["wp"]


class Absent:
    """Stand-in for Warp: attributes are itself, and decorators give their function back; nothing can be launched."""

    def __getattr__(self, name: str) -> Any:
        return self

    def __call__(self, *values: Any, **named: Any) -> Any:
        return values[0] if values and callable(values[0]) else self


try:
    import warp
except ImportError:
    wp: Any = Absent()
else:
    wp = warp
    warp.config.log_level = warp.LOG_WARNING
