"""Functions that are linear by pieces, and what counts as the same beside rounding: tools of the bar's exact motion."""

from dataclasses import dataclass

Profile = tuple[tuple[float, float, float, float], ...]
"""Parts (s0, s1, value at s0, value at s1) in order."""
Piece = tuple[float, float, float, float]
"""A part of a wave: (start, end, first value, last value)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Same:
    """Differences that rounding may make: of times, velocities, displacements."""

    time: float
    velocity: float
    displacement: float


def on(profile: Profile, a: float, b: float) -> tuple[float, float]:
    """Values of a profile at both ends of an interval that lies in one of its parts."""
    s0, s1, f0, f1 = next(part for part in profile if part[0] <= a and b <= part[1])
    return f0 + (f1 - f0) * (a - s0) / (s1 - s0), f0 + (f1 - f0) * (b - s0) / (s1 - s0)


def cut(piece: Piece, x: float | None, same: Same) -> tuple[Piece, Piece | None]:
    """The piece up to x and what is left of it."""
    a, b, p0, p1 = piece
    if x is None or x >= b - a - same.time:
        return piece, None
    p = p0 + (p1 - p0) * x / (b - a)
    return (a, a + x, p0, p), (a + x, b, p, p1)
