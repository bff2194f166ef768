"""Balances of a transfer: rigid correction for momentum and spin, and a scalar for the energy
(docs/theory/bodies/adaptive.md#balances).
"""

from dataclasses import dataclass

import numpy as np

from softway.adaptivity.projections.conditions import ClosedRows, MassiveSolid, conditions_of
from softway.arrays import Array
from softway.bodies.assembled.rigid_body_modes import motion_names
from softway.bodies.elements.section import Axisymmetric

HELD = 1e-9
"""Supported part of a rigid motion, relative to the motion, below which supports leave it free."""
MOST = 0.1
"""Greatest ``|s^2 - 1|`` of the scalar s; beyond it the difference of energies is booked.

Upwards also that of the energy of the rest ``s w``, relative to its energy before: what a projection has lost comes
back.
"""
SMALL = 1e-13
"""Energy, relative to that of the body, below which the rest of the motion is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidMotions:
    """Free rigid motions (n d, m) of a solid on two meshes, at its places there."""

    before: Array
    after: Array


def rigid_motions_of(before: MassiveSolid, after: MassiveSolid, places: tuple[Array, Array]) -> RigidMotions:
    """Rigid motions that the supports leave free, the same ones at the ``places`` (n, d) and (m, d) of both meshes."""
    d = after.points.shape[1]
    names = motion_names(d, isinstance(after.section, Axisymmetric))
    centre = places[1].mean(axis=0)
    size = float(np.abs(places[1] - centre).max())
    own, others = (_motions(x, names, centre, size) for x in (places[1], places[0]))
    held = after.dofs.supported
    rows = np.stack([held(mode.reshape(-1, d)).ravel() for mode in own.T], axis=1)
    _, values, right = np.linalg.svd(rows[rows.any(axis=1)], full_matrices=True)
    largest = float(np.sqrt(len(own)))
    free = right[int((values > HELD * largest).sum()) :].T
    return RigidMotions(before=others @ free, after=own @ free)


def _motions(places: Array, names: tuple[str, ...], centre: Array, size: float) -> Array:
    """Rigid motions (n d, m) by name about a centre (d,), rotations divided by a size [m]."""
    n, d = places.shape
    arm = np.zeros((n, 3))
    arm[:, :d] = (places - centre) / size
    columns = []
    for name in names:
        axis = np.eye(3)["xyz".index(name[-1])]
        field = np.cross(axis, arm) if name.startswith("rotation") else np.tile(axis, (n, 1))
        columns.append(field[:, :d].ravel())
    return np.array(columns).T


def spin(places: Array, momenta: Array) -> Array:
    """Angular momentum (3,) about the origin of nodal momenta (n, d) at places (n, d) [kg m^2/s].

    Examples
    --------
    >>> spin(np.array([[2.0, 0.0]]), np.array([[0.0, 3.0]])).tolist()
    [0.0, 0.0, 6.0]
    """
    both = np.zeros((2, len(places), 3))
    both[0, :, : places.shape[1]], both[1, :, : places.shape[1]] = places, momenta
    return np.asarray(np.cross(both[0], both[1]).sum(axis=0))


def balanced(
    after: MassiveSolid,
    motions: Array,
    velocity: Array,
    momenta: Array,
    kinetic: float,
    most: float = MOST,
    closed: ClosedRows | None = None,
    before: float = 0.0,
) -> tuple[Array, float]:
    """Velocity (n, d) with given momenta of the free rigid motions and, where a scalar allows it, kinetic energy.

    The velocity is ``g + b + s w``: its part g on supports, the velocity b of least energy with the momenta and the
    normal velocities of closed rows, and the rest w, which has neither.  Without closed rows b is a rigid motion.

    Parameters
    ----------
    after
        The solid.
    motions
        Free rigid motions Z (n d, m).
    velocity
        (n, d) velocity [m/s].
    momenta
        (m,) momenta ``Z^T M v`` to have.
    kinetic
        Kinetic energy to have [J].
    most
        Greatest ``|s^2 - 1|`` of the scalar s.
    closed
        Contact rows with given normal velocities, of nodes with inertia; None without.
    before
        Kinetic energy of the rest w before a projection [J].

    Returns
    -------
    The velocity, and the scalar s; one where it would have to differ much from one, or the rest is rounding.
    """
    given = after.dofs.supported(velocity)
    rest, conditions = velocity - given, conditions_of(after, motions, closed)
    wanted = momenta if closed is None else np.concatenate([closed.velocity, momenta])
    base = given + conditions.change(wanted - conditions.of(given))
    for _ in range(2):  # a second time removes the rounding of the first
        rest = rest - conditions.change(conditions.of(rest))
        base = base + conditions.change(wanted - conditions.of(base + rest))
    return base + (scalar := _scalar(after, base, rest, kinetic, most, before)) * rest, scalar


def rest_energy(solid: MassiveSolid, motions: Array, velocity: Array) -> float:
    """Kinetic energy [J] of a velocity (n, d) beside its part on supports and the free rigid motions (n d, m).

    Examples
    --------
    Of two unit masses on a line one moves with 2 m/s: both with 1 m/s, and each with 1 m/s against that.

    >>> import scipy.sparse as sp
    >>> from types import SimpleNamespace
    >>> from softway.bodies.dof_map import NodalDofs
    >>> mass = sp.csr_array(sp.eye_array(2))
    >>> kinetic = lambda v: 0.5 * float((v * (mass @ v)).sum())
    >>> pair = SimpleNamespace(dofs=NodalDofs(np.ones((2, 1), bool)), mass=mass, kinetic=kinetic)
    >>> round(rest_energy(pair, np.ones((2, 1)), np.array([[2.0], [0.0]])), 12)
    1.0
    """
    rest = velocity - solid.dofs.supported(velocity)
    conditions = conditions_of(solid, motions)
    return solid.kinetic(rest - conditions.change(conditions.of(rest)))


def _scalar(after: MassiveSolid, base: Array, rest: Array, kinetic: float, most: float, before: float) -> float:
    """Scalar s near one with ``T(base + s rest) = kinetic``; one if there is none."""
    quadratic, constant = after.kinetic(rest), after.kinetic(base) - kinetic
    half = 0.5 * float((base * (after.mass @ rest)).sum())
    root = half**2 - quadratic * constant
    if quadratic <= SMALL * max(abs(kinetic), after.kinetic(base)) or root < 0.0:
        return 1.0
    found = (-half + float(np.sqrt(root))) / quadratic
    near = 1.0 - most <= found**2 <= (1.0 + most) * max(1.0, before / quadratic)
    return found if near and found > 0.0 else 1.0
