"""What a scene of solids with rigid bodies cannot have."""

from collections.abc import Sequence

import numpy as np

from softway.bodies.elements.section import Axisymmetric
from softway.bodies.solid import Solid
from softway.contact.impact_rule import Energy
from softway.errors import InputError
from softway.mechanisms.members.mechanism import Mechanism
from softway.model.rigid.rigid_bodies import RigidBodies
from softway.model.scene import Scene, StaticStart

SIDEWAYS = 1e-9
"""Part of a unit velocity across the axis that joints leave, above which a body can leave the axis."""


def require_fitting(scene: Scene, rigid: RigidBodies, solids: Sequence[Solid]) -> None:
    """Refuse what does not go together with rigid bodies.

    Raises
    ------
    InputError
        For scaled inertia, a static start, rules of impact other than Energy with one scalar, the name of a rigid body
        that another body has, contacts with a body without a surface or without inertia, and bodies that can leave the
        axis of bodies of revolution.
    """
    if scene.inertia.factor != 1.0:
        problem = f"{type(scene.inertia).__name__} with rigid bodies, which have their full mass"
        raise InputError("inertia", problem, "omit it, or tools in place of the rigid bodies")
    if isinstance(scene.start, StaticStart):
        problem = "StaticStart with rigid bodies, which are not in equilibrium"
        raise InputError("start", problem, 'start = "AsGiven", or tools in place of the rigid bodies')
    _require_names(scene, rigid.mechanism)
    for k, contact in enumerate(scene.contacts):
        if not isinstance(contact.timing, Energy) or contact.timing.located:
            problem = f"{contact.timing} in a scene with rigid bodies"
            raise InputError(f"contacts[{k}].timing", problem, "the rule Energy, located = false")
    if any(isinstance(solid.section, Axisymmetric) for solid in solids):
        _require_on_axis(rigid)


def _require_names(scene: Scene, mechanism: Mechanism) -> None:
    """Refuse names that two bodies have, and contacts with bodies without a surface or without inertia."""
    twice = sorted(scene.bodies.keys() & mechanism.bodies.keys())
    if twice:
        raise InputError(f"mechanism.bodies.{twice[0]}", "is the name of another body of the scene", "another name")
    for k, contact in enumerate(scene.contacts):
        body = mechanism.bodies.get(contact.opponent)
        if body is not None and body.shape is None:
            problem = f"{contact.opponent!r} has no surface"
            raise InputError(f"contacts[{k}].between", problem, f"a shape of bodies.{contact.opponent}")
        if body is not None and not body.tensor.any():
            problem = "zero for a body with contact: nothing that touches it would turn it"
            remedy = "its moment of inertia, or a density in place of mass, centre and inertia"
            raise InputError(f"bodies.{contact.opponent}.inertia", problem, remedy)


def _require_on_axis(rigid: RigidBodies) -> None:
    """Refuse bodies that can move across the axis x = 0 or turn, among bodies of revolution."""
    left = rigid.allowed(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    for name in rigid.mechanism.bodies:
        if np.abs(left[rigid.number(name)][[0, 5]]).max() > SIDEWAYS:
            remedy = f'a Slider of {name!r} along y: [joints.axis] kind = "Slider", between = ["ground", "{name}"]'
            raise InputError(f"bodies.{name}", "can leave the axis of the bodies of revolution", remedy)
