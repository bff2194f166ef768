"""Transfer of the motion of a solid from one adapted mesh to another, with its momentum, spin and energy."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.balances import RigidMotions, balanced, rigid_motions_of, spin
from softway.adaptivity.linked_solids import AnyBody, LinkedSolids
from softway.adaptivity.memory import remembered
from softway.adaptivity.projections.conditions import ClosedRows
from softway.adaptivity.projections.projection import AnyProjection, projection
from softway.arrays import Array
from softway.bodies.internal_force.material_state import MaterialState


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Motion:
    """Motion of a solid of n nodes at one time.

    Parameters
    ----------
    displacement, velocity
        (n, d) [m], [m/s].
    state
        Material state; None for an elastic solid.
    """

    displacement: Array
    velocity: Array
    state: MaterialState | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Settled:
    """Solid on a new mesh before its velocity is known.

    Parameters
    ----------
    displacement
        (m, d) [m].
    state
        Material state; None for an elastic solid.
    before
        Stored energy on the mesh before, less what is not to pass over, such as energy dissipated on the way [J].
    energy
        Stored energy now [J].
    """

    displacement: Array
    state: MaterialState | None
    before: float
    energy: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Transferred:
    """Motion of a solid after a transfer, and what the transfer has changed.

    Parameters
    ----------
    motion
        The motion on the new mesh.
    scalar
        Scalar s that closes the energy; one where none does.
    momentum, spin, energy
        Defects of the projection alone: momentum (d,) [kg m/s], angular momentum (3,) about the origin [kg m^2/s], and
        energy [J], new less old.
    booked
        Energy that the solid has lost in the transfer [J]: rounding where the scalar closes it.
    projection
        Projections of other fields: accelerations.
    """

    motion: Motion
    scalar: float
    momentum: Array
    spin: Array
    energy: float
    booked: float
    projection: AnyProjection


def transfer(
    before: AnyBody,
    after: AnyBody,
    motion: Motion,
    cast: AnyProjection | None = None,
    there: Settled | None = None,
    closed: ClosedRows | None = None,
) -> Transferred:
    """Transfer a motion to another mesh of the same base; that of several solids that ties link, as one.

    Velocities are projected with the consistent mass, displacements with mass and stiffness.  Then a rigid motion, in
    the mass matrices of the march, gives the momentum and spin before, and a scalar times the rest of the motion the
    energy (docs/theory/bodies/adaptive.md#transfer).  With supports this holds for the rigid motions that they leave
    free.

    Parameters
    ----------
    before, after
        The solid, or the solids, on both meshes.
    motion
        Its motion on the mesh before.
    cast
        Projections from one mesh to the other, where they are known.
    there
        The solid on the new mesh, with massless nodes in equilibrium; by default the projected displacement with the
        memory of the material.  Linked solids need it.
    closed
        Contact rows on the new mesh that stay closed, of nodes with inertia; None without.

    Raises
    ------
    InputError
        If the meshes have different bases.

    Examples
    --------
    >>> import softway as sw
    >>> from softway.adaptivity.adapted_solid import adapted_solid
    >>> from softway.meshes.adaptive.refinement import refined
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=2), material=sw.LinearElastic(E=1.0), density=1.0)
    >>> fine, coarse = (adapted_solid("bar", bar, refined(bar.mesh.build(), np.full(2, k)), ()) for k in (3, 1))
    >>> x = fine.points
    >>> found = transfer(fine, coarse, Motion(displacement=0.1 * x**2, velocity=1.0 + x**3))
    >>> abs(found.booked) < 1e-15, abs(found.scalar - 1.0) < 0.02
    (True, True)
    """
    cast = projection(before, after) if cast is None else cast
    velocity = after.following(cast.velocity(before.following(motion.velocity)))
    if there is None:
        assert isinstance(before, AdaptedSolid) and isinstance(after, AdaptedSolid)
        there = _at_once(before, after, motion, cast)
    displacement, new = there.displacement, there.energy
    places = before.points + motion.displacement, after.points + displacement
    momenta = before.mass @ motion.velocity, after.mass @ velocity
    total = before.kinetic(motion.velocity) + there.before
    rigid = _rigid_motions(before, after, places)
    given = rigid.before.T @ momenta[0].ravel()
    found, scalar = balanced(after, rigid.after, velocity, given, total - new, closed=closed)
    found = after.following(found)
    return Transferred(
        motion=Motion(displacement=displacement, velocity=found, state=there.state),
        scalar=scalar,
        momentum=np.asarray(momenta[1].sum(axis=0) - momenta[0].sum(axis=0)),
        spin=spin(places[1], momenta[1]) - spin(places[0], momenta[0]),
        energy=after.kinetic(velocity) + new - total,
        booked=total - after.kinetic(found) - new,
        projection=cast,
    )


def _rigid_motions(before: AnyBody, after: AnyBody, places: tuple[Array, Array]) -> RigidMotions:
    """Rigid motions that the supports leave free, of each of several solids that touch."""
    if not (isinstance(before, LinkedSolids) and isinstance(after, LinkedSolids) and after.touching):
        return rigid_motions_of(before, after, places)
    own = zip(before.solids, after.solids, before.split(places[0]), after.split(places[1]), strict=True)
    found = [rigid_motions_of(one, other, (x, y)) for one, other, x, y in own]
    return RigidMotions(
        before=block_diag(*(motions.before for motions in found)), after=block_diag(*(m.after for m in found))
    )


def _at_once(before: AdaptedSolid, after: AdaptedSolid, motion: Motion, cast: AnyProjection) -> Settled:
    """The solid at its projected displacement."""
    displacement = cast.displacement(motion.displacement)
    state = None if motion.state is None else remembered(before, after, motion.state, displacement)
    old, new = _stored(before, motion.state, motion.displacement), _stored(after, state, displacement)
    return Settled(displacement=displacement, state=state, before=old, energy=new)


def _stored(solid: AdaptedSolid, state: MaterialState | None, displacement: Array) -> float:
    """Stored energy [J] of a solid in its material state."""
    internal = solid.part.internal
    return internal.energy(displacement) if state is None else internal.stored_force(state, displacement)[0]
