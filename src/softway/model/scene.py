"""Scene: bodies, contacts and loads.  State: the fields at one time."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from softway.arrays import Array, BoolArray
from softway.bodies.inertia.inertia_scaling import Full, Inertia
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.setup.heat_loads import HeatLoad
from softway.bodies.setup.loads import Load
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.tie import Tie
from softway.contact.contact import Contact
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.step import BodyState


@dataclass(frozen=True, slots=True, kw_only=True)
class AsGiven:
    """The march starts from the initial fields of the solids.

    Examples
    --------
    >>> AsGiven()
    AsGiven()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class StaticStart:
    """The march starts from a static equilibrium of the supported solids.

    Parameters
    ----------
    loads
        Loads of the equilibrium, removed at the start; the loads of the scene if empty.

    Examples
    --------
    >>> StaticStart()
    StaticStart(loads=())
    """

    loads: tuple[Load, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """Bodies, the contacts between them, and the loads: an immutable description.

    Parameters
    ----------
    bodies
        Solids and tools by name.
    contacts
        Contacts between tagged surfaces and tools or other surfaces.
    ties
        Permanent ties between surfaces of solids.
    loads
        Dead loads: gravity, tractions; and heat loads on solids with a temperature.
    start
        Initial fields as given, or static equilibrium.
    inertia
        Full, off (quasi-static) or scaled inertia.
    mechanism
        Rigid bodies with their joints; contacts name those that have a shape like tools.
    """

    bodies: Mapping[str, Solid | Tool]
    contacts: tuple[Contact, ...] = ()
    ties: tuple[Tie, ...] = ()
    loads: tuple[Load | HeatLoad, ...] = ()
    start: AsGiven | StaticStart = AsGiven()
    inertia: Inertia = Full()
    mechanism: Mechanism | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """State at one time; arrays are read-only.

    Parameters
    ----------
    time
        [s].
    displacement, velocity, acceleration
        Body name -> (n, d) nodal arrays [m], [m/s], [m/s^2]; acceleration: slope of the velocity in the slab before.
    closed
        Contact name -> (c,) contact rows that touch.
    pressure
        Contact name -> (c,) normal force of the obstacle on the node of each row, >= 0 [N].
    memory
        Body name -> history variables of path-dependent materials.
    traction, sliding, slip
        Contact name -> (c, d) tangential force of the obstacle on the node of each row [N], (c,) rows that slip, and
        (c, d) mean velocity of their slip in the slab before [m/s]; empty without friction.
    span
        Length of the slab before, zero at the start [s].
    fields
        Companion field -> body name -> (n, components); of rigid bodies (1, components).
    rigid
        Name of a rigid body -> its state.
    """

    time: float
    displacement: Mapping[str, Array]
    velocity: Mapping[str, Array]
    acceleration: Mapping[str, Array]
    closed: Mapping[str, BoolArray]
    pressure: Mapping[str, Array]
    memory: Mapping[str, MaterialState] = field(default_factory=dict)
    traction: Mapping[str, Array] = field(default_factory=dict)
    sliding: Mapping[str, BoolArray] = field(default_factory=dict)
    slip: Mapping[str, Array] = field(default_factory=dict)
    span: float = 0.0
    fields: Mapping[str, Mapping[str, Array]] = field(default_factory=dict)
    rigid: Mapping[str, BodyState] = field(default_factory=dict)
