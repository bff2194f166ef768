"""Collision of two rigid bodies at one point in the plane, with friction: Routh's impulse path.

During the collision the normal impulse p grows while the positions are fixed. With the inverse W of the effective
inertia at the contact point (tangential, normal), the velocities follow the impulses, ``dv = W dp``. Coulomb's law
holds at every p: friction opposes slip with ``mu dp``; where slip ends, the point sticks if friction can hold it,
otherwise it slips in the other direction. Velocities are piecewise linear in p, so the transitions are exact.
Compression ends where the normal velocity vanishes; Poisson restitution then adds ``e`` times its impulse.
"""

from dataclasses import dataclass
from math import inf

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, NumericsError

PIECES = 4
"""Greatest number of linear pieces; slip ends once at most during compression and restitution."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Collision:
    """Result of a collision.

    Parameters
    ----------
    impulse
        (2,) tangential and normal impulse on the body [N s].
    velocity
        (2,) tangential and normal velocity of the contact point after the collision [m/s].
    dissipated
        Dissipated energy [J].
    """

    impulse: Array
    velocity: Array
    dissipated: float


def collide(inverse_inertia: Array, velocity: Array, *, mu: float = 0.0, restitution: float = 0.0) -> Collision:
    """Collide a contact point whose velocity changes by ``inverse_inertia @ impulse``.

    Parameters
    ----------
    inverse_inertia
        (2, 2) W, symmetric positive definite, tangential before normal [1/kg].
    velocity
        (2,) velocity before the collision, with a negative normal component [m/s].
    mu, restitution
        Friction coefficient, and coefficient of restitution e in [0, 1].

    Raises
    ------
    InputError
        If a number is out of range, or the bodies do not approach.

    References
    ----------
    Routh (1860), Dynamics of a system of rigid bodies; Wang, Mason (1992), Two-dimensional rigid-body collisions with
    friction, J. Appl. Mech. 59, 635-642.

    Examples
    --------
    >>> bounced = collide(np.eye(2), np.array([0.0, -1.0]), restitution=0.5)
    >>> bounced.velocity.tolist()
    [0.0, 0.5]
    """
    W, v = np.asarray(inverse_inertia, float), np.asarray(velocity, float)
    _examine(W, v, mu, restitution)
    impulse, until = np.zeros(2), inf
    for _ in range(PIECES):
        rate = np.array([_friction(W, v[0], mu), 1.0])
        change = W @ rate
        ends = {"slip": _span(v[0], change[0]), "compression": inf, "restitution": until - impulse[1]}
        if until == inf:
            ends["compression"] = _span(v[1], change[1])
        first = min(ends, key=lambda name: ends[name])
        if ends[first] == inf:
            raise NumericsError("the collision jams: friction increases the normal force", 0.0, "a smaller mu")
        impulse, v = impulse + ends[first] * rate, v + ends[first] * change
        if first == "restitution":
            break
        v[0 if first == "slip" else 1] = 0.0
        until = (1.0 + restitution) * impulse[1] if first == "compression" else until
    taken = 0.5 * float(impulse @ (np.asarray(velocity, float) + v))
    return Collision(impulse=impulse, velocity=v, dissipated=-taken)


def _friction(W: Array, slip: float, mu: float) -> float:
    """Tangential impulse per unit of normal impulse."""
    if slip != 0.0:
        return -mu * float(np.sign(slip))
    return float(np.clip(-W[0, 1] / W[0, 0], -mu, mu))


def _span(value: float, rate: float) -> float:
    """Normal impulse after which a velocity vanishes; infinite if it does not."""
    return -value / rate if value * rate < 0.0 else inf


def _examine(W: Array, v: Array, mu: float, restitution: float) -> None:
    if W.shape != (2, 2) or not np.allclose(W, W.T, rtol=1e-9) or not (np.linalg.eigvalsh(W) > 0.0).all():
        raise InputError("inverse_inertia", f"{W.tolist()}", "a symmetric positive definite (2, 2) matrix [1/kg]")
    if v.shape != (2,) or not v[1] < 0.0:
        raise InputError("velocity", f"{v.tolist()} does not approach", "a negative normal component")
    if not mu >= 0.0:
        raise InputError("mu", f"{mu:g} is negative", "zero or more")
    if not 0.0 <= restitution <= 1.0:
        raise InputError("restitution", f"{restitution:g}", "a number between 0 and 1")
