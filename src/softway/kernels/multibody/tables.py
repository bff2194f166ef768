"""Arrays of a mechanism for the compiled slabs.  The ground is the last body: it has no inverse inertia."""

from typing import NamedTuple

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.jit.by_address import passed_by_address


@passed_by_address
class Bodies(NamedTuple):
    """Rigid bodies (b + 1,), the ground last.

    ``mass`` (b + 1,) [kg], ``inertia`` (b + 1, 3, 3) about the centre in the axes of the body [kg m^2], and their
    inverses, zero where there is none; ``gravity`` (3,) [m/s^2]; ``group`` (b,) numbers of the groups of connected
    bodies, and for each group if it is ``jointed`` (g,) and ``supported`` (g,) by the ground.
    """

    mass: Array
    inertia: Array
    inverse_mass: Array
    inverse_inertia: Array
    gravity: Array
    group: IntArray
    jointed: IntArray
    supported: IntArray


@passed_by_address
class Angles(NamedTuple):
    """Angles (q,) by which the bodies b have turned about axes of the bodies a, which are also axes of b.

    ``U``, ``V`` (q, 3) are directions of a, perpendicular to each other and to the axis ``U x V``; ``W`` (q, 3) is the
    direction of b that is U at the start.
    """

    a: IntArray
    b: IntArray
    U: Array
    V: Array
    W: Array


@passed_by_address
class Drives(NamedTuple):
    """Prescribed changes (m,) of the values of rows since the start, as functions of time.

    ``row`` (m,) is the row of each; its pieces are ``first[m]`` to ``first[m + 1]`` of ``pieces`` (q, 10): the time [s]
    from which a piece counts, six coefficients of the powers of the time since then, and amplitude, angular frequency
    [rad/s] and phase of a sine.
    """

    row: IntArray
    first: IntArray
    pieces: Array


@passed_by_address
class Joints(NamedTuple):
    """Rows (r,) of the joints, see :mod:`~softway.kernels.multibody.joint_rows`.

    ``sides`` (r, s) are the bodies of each row, a and b first, and the ground where there are no more; ``pairs`` (p, 4)
    are rows i >= j that share a body, and their sides with it; ``width`` is the greatest i - j.  ``angle`` (r, 2) are
    angles that the row has with the factors ``ratio`` (r, 2), -1 for none: one between the sides 0 and 1, and one
    between the sides 2 and 3.
    """

    kind: IntArray
    a: IntArray
    b: IntArray
    sides: IntArray
    X: Array
    Y: Array
    N: Array
    B: Array
    value: Array
    pairs: IntArray
    width: int
    angles: Angles
    angle: IntArray
    ratio: Array
    drives: Drives


@passed_by_address
class Springs(NamedTuple):
    """Springs with dampers (s,) between the points X of the bodies a and Y of b, and torques (t,) on bodies.

    ``stiffness`` [N/m], ``rest`` length [m], ``damping`` [N s/m]; ``torque`` (t, 3) fixed in space on ``turned`` [N m];
    ``force`` (f, 3) fixed in space on the points F of the bodies ``pushed`` [N]; ``torsion`` (m, 4) about the angles
    ``about``: stiffness [N m/rad], angle without moment [rad], damping [N m s/rad], and constant torque [N m].
    """

    a: IntArray
    b: IntArray
    X: Array
    Y: Array
    stiffness: Array
    rest: Array
    damping: Array
    turned: IntArray
    torque: Array
    pushed: IntArray
    F: Array
    force: Array
    about: IntArray
    torsion: Array


@passed_by_address
class Motion(NamedTuple):
    """State of the bodies (b + 1,): places (b + 1, 3), unit quaternions (b + 1, 4), velocities (b + 1, 3) and angular
    velocities (b + 1, 3) in the axes of the bodies; ``angle`` (q,) with all turns [rad]; ``impulse`` (r,) through the
    joints in the slab before, ``energy`` (g,) that each group has to have, and ``work`` (2,): of forces and torques,
    motors included, and dissipated by dampers [J]; ``time`` (2,) [s], with the rounding error of its sum.
    """

    place: Array
    turn: Array
    velocity: Array
    spin: Array
    angle: Array
    impulse: Array
    energy: Array
    work: Array
    time: Array


@passed_by_address
class Space(NamedTuple):
    """Work space of the slabs (n bodies with the ground, r rows).

    ``R0``, ``R1`` (n, 3, 3) rotations at both ends, and ``place`` (n, 3) and ``angle`` (q,) at the end; ``turn`` (q, 3)
    moments on b that belong to the angles; values ``g`` (r,) and Jacobians ``G`` (r, s, 6) of the rows, ``MG`` = M^-1
    G^T at the start, with the ``mobility`` (n, 3, 3), the inverse inertia in space; ``matrix`` and ``lower`` (r, w +
    1), ``pivot`` (r,) of G M^-1 G^T; motions ``z`` and ``new`` (n, 6); ``force`` (n, 6) times h; ``push`` (r,) of the
    rows; ``given`` (n - 1, 4, 3), or none: mean force on each body by solids, and its products ``Y f`` with the places
    Y in the body that it acts on; ``kept`` (r,) impulses of the slab before; ``active`` (r,) rows that take part: all
    of the joints, and the closed ones of the stops; ``target`` (r,) prescribed changes of the values at the end,
    ``rate`` (r,) prescribed rates at the present state, ``jump`` (r,) impulses of the projection, and ``drive`` (m, 3)
    of each drive: the change in the slab, the rate at its start, and the mean force; ``driven`` (g,) groups whose
    drives move; ``kinetic``, ``rest`` (without the drives) and ``potential`` (g,) energies, ``mean`` (g, 3, 3) motions,
    ``own`` (n, 3, 3) inertia in space, ``three`` (4, 3, 3) for systems of three equations; ``cone`` (1,) the address of
    the solution of contacts, where there are stops.
    """

    R0: Array
    R1: Array
    place: Array
    angle: Array
    turn: Array
    G: Array
    MG: Array
    g: Array
    mobility: Array
    matrix: Array
    lower: Array
    pivot: Array
    z: Array
    new: Array
    force: Array
    given: Array
    push: Array
    kept: Array
    active: IntArray
    target: Array
    rate: Array
    jump: Array
    drive: Array
    driven: IntArray
    kinetic: Array
    rest: Array
    potential: Array
    mean: Array
    own: Array
    three: Array
    cone: IntArray


def space(joints: Joints, bodies: int, groups: int, given: bool = False) -> Space:
    """Work space for joints of a number of ``bodies`` without the ground, in a number of groups; ``given`` with forces
    by solids.
    """
    n, (rows, sides), angles = bodies + 1, joints.sides.shape, len(joints.angles.a)
    eye = np.tile(np.eye(3), (n, 1, 1))
    return Space(
        R0=eye.copy(),
        R1=eye.copy(),
        place=np.zeros((n, 3)),
        angle=np.zeros(angles),
        turn=np.zeros((angles, 3)),
        G=np.zeros((rows, sides, 6)),
        MG=np.zeros((rows, sides, 6)),
        g=np.zeros(rows),
        mobility=np.zeros((n, 3, 3)),
        matrix=np.zeros((rows, joints.width + 1)),
        lower=np.zeros((rows, joints.width + 1)),
        pivot=np.zeros(rows),
        z=np.zeros((n, 6)),
        new=np.zeros((n, 6)),
        force=np.zeros((n, 6)),
        given=np.zeros((n - 1 if given else 0, 4, 3)),
        push=np.zeros(rows),
        kept=np.zeros(rows),
        active=np.ones(rows, dtype=np.int64),
        target=np.zeros(rows),
        rate=np.zeros(rows),
        jump=np.zeros(rows),
        drive=np.zeros((len(joints.drives.row), 3)),
        kinetic=np.zeros(groups),
        rest=np.zeros(groups),
        driven=np.zeros(groups, dtype=np.int64),
        potential=np.zeros(groups),
        mean=np.zeros((groups, 3, 3)),
        own=np.zeros((n, 3, 3)),
        three=np.zeros((4, 3, 3)),
        cone=np.zeros(1, dtype=np.int64),
    )
