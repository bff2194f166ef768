"""Friction of stops: against sliding, greater at rest if given, against rolling and against drilling."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.kernels.multibody.joint_rows import TURN, TWIST
from softway.mechanisms.members.rows import JointRow, across
from softway.units import Metre, Pure

SQUARE = 1e-9
"""Cosine of the angle of a direction and a plane beyond which it is not along the plane."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StopFriction:
    """Friction of a stop.

    Parameters
    ----------
    friction
        Coefficient of Coulomb's friction, at rest and in motion.
    mu_s
        Coefficient at rest, if it differs.
    rolling, drilling
        Moments against rolling and drilling, over the normal force [m].

    Raises
    ------
    InputError
        For values that are negative or not finite, and a ``mu_s`` below ``friction``.
    """

    friction: Pure = 0.0
    mu_s: Pure | None = None
    rolling: Metre = 0.0
    drilling: Metre = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.friction < np.inf:
            raise InputError("friction", f"{self.friction:g} is negative, or not finite", "zero or more")
        if self.mu_s is not None and not self.friction <= self.mu_s < np.inf:
            problem = f"{self.mu_s:g} is less than friction = {self.friction:g}, or not finite"
            raise InputError("mu_s", problem, "friction or more, or omit it")
        for name in ("rolling", "drilling"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(name, f"{getattr(self, name):g} m is negative, or not finite", "zero or more")

    @property
    def at_rest(self) -> float:
        """Coefficient at rest."""
        return self.friction if self.mu_s is None else self.mu_s

    @property
    def turns(self) -> bool:
        """True if it has moments."""
        return self.rolling > 0.0 or self.drilling > 0.0

    @property
    def rough(self) -> bool:
        """True if there is any friction."""
        return self.at_rest > 0.0 or self.turns


def require_space(friction: StopFriction, dim: int) -> None:
    """Refuse drilling in the plane, where nothing turns about a normal."""
    if friction.drilling and dim == 2:
        raise InputError("drilling", f"{friction.drilling:g} m in the plane", "omit it, or places in space")


def require_belt(velocity: tuple[float, ...] | None, normal: tuple[float, ...], friction: StopFriction) -> None:
    """Refuse a velocity of a surface that leaves its plane, or drives nothing."""
    if velocity is None:
        return
    size = float(np.linalg.norm(velocity))
    if len(velocity) != len(normal) or not np.isfinite(size):
        raise InputError("velocity", f"{velocity} with the normal {normal}", f"{len(normal)} finite components")
    if abs(np.dot(velocity, normal)) > SQUARE * size * float(np.linalg.norm(normal)):
        raise InputError("velocity", f"{velocity} is not along the plane", "components without one along the normal")
    if not friction.at_rest:
        raise InputError("velocity", "of a surface without friction", "friction above zero, or omit it")


def tangents(normal: Array, dim: int) -> list[Array]:
    """Unit vectors (3,) across a normal: one in the plane, two in space."""
    if dim == 2:
        return [np.array([normal[1], -normal[0], 0.0])]
    return list(across(normal))


def turns_on_plane(row: JointRow, friction: StopFriction, dim: int) -> list[JointRow]:
    """Rows of the rolling, one in the plane and two in space, and there of the drilling, of a body on a plane."""
    axes = [np.array([0.0, 0.0, 1.0])] if dim == 2 else [*tangents(row.n, dim), row.n]
    return _turning(row, friction, TURN, axes)


def turns_on_line(row: JointRow, friction: StopFriction, dim: int) -> list[JointRow]:
    """The same rows of two bodies that touch on the line between two points."""
    numbers = [1.0] if dim == 2 else [0.0, 1.0, 2.0]
    return _turning(row, friction, TWIST, [np.array([k, 0.0, 0.0]) for k in numbers])


def _turning(row: JointRow, friction: StopFriction, kind: int, directions: list[Array]) -> list[JointRow]:
    """Rows of the turning about directions; of nothing if there is no such friction."""
    zero = np.zeros(3)
    if not friction.turns:
        return [JointRow(kind=TURN, first=row.first, second=row.second, n=zero, m=zero) for _ in directions]
    return [JointRow(kind=kind, first=row.first, second=row.second, n=zero, m=one) for one in directions]
