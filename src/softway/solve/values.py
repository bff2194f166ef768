"""What is known at the start of a slab, and what its equations say of an iterate."""

from dataclasses import dataclass

from softway.bodies.past import Memories
from softway.contact.candidates import Candidates
from softway.typing import Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Start:
    """What is known at t0: displacement, velocity, internal force (n, d) and stored energy (parts,); the memories of
    the solids, and the part of the force (n, d) that the mean rate of the slab before has made.
    """

    displacement: Array
    velocity: Array
    force: Array
    energy: Array
    memory: Memories = ()
    viscous: Array | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Evaluation:
    """The equations at one q: residual, end values, mean force (n, d), the scalar a of each part and the
    share of the work that it closes, the contact rows
    at the end where they change, and what bulk viscosity dissipates (parts,).
    """

    residual: Array
    displacement: Array
    force: Array
    energy: Array
    mean_force: Array
    scalar: Array
    share: Array
    clipped: bool
    near: Candidates | None
    lost: Array | float = 0.0
