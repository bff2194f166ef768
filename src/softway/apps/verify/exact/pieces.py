"""Piecewise linear functions and rounding tolerances: tools for the exact motion of a bar."""

from dataclasses import dataclass

Profile = tuple[tuple[float, float, float, float], ...]
"""Parts (s0, s1, value at s0, value at s1) in order."""
Piece = tuple[float, float, float, float]
"""Piece of a wave: (start, end, first value, last value)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Same:
    """Rounding tolerances for times, velocities and displacements."""

    time: float
    velocity: float
    displacement: float


def on(profile: Profile, a: float, b: float) -> tuple[float, float]:
    """Values of a profile at both ends of an interval inside one of its parts."""
    s0, s1, f0, f1 = next(part for part in profile if part[0] <= a and b <= part[1])
    return f0 + (f1 - f0) * (a - s0) / (s1 - s0), f0 + (f1 - f0) * (b - s0) / (s1 - s0)


def cut(piece: Piece, x: float | None, same: Same) -> tuple[Piece, Piece | None]:
    """Cut a piece at x; return the part before it and the rest."""
    a, b, p0, p1 = piece
    if x is None or x >= b - a - same.time:
        return piece, None
    p = p0 + (p1 - p0) * x / (b - a)
    return (a, a + x, p0, p), (a + x, b, p, p1)
