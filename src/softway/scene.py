"""Scene (what there is) and State (how it stands at one time)."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from softway.bodies.inertia import Full, Inertia
from softway.bodies.loads import Load
from softway.bodies.memory import Memory
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact
from softway.typing import Array, BoolArray


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
        Loads of the equilibrium, let go at the start; the loads of the scene if empty.

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
        Which tagged nodes may touch which tool, and by which rule.
    loads
        Dead loads: gravity, tractions.
    start
        How the march starts.
    inertia
        Full, off (quasi-static) or scaled.
    """

    bodies: Mapping[str, Solid | Tool]
    contacts: tuple[Contact, ...] = ()
    loads: tuple[Load, ...] = ()
    start: AsGiven | StaticStart = AsGiven()
    inertia: Inertia = Full()


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """The situation at one time; arrays are read-only.

    Parameters
    ----------
    time
        [s].
    displacement, velocity, acceleration
        Body name -> (n, d) nodal arrays [m], [m/s], [m/s^2]; acceleration: slope of the velocity in the slab before.
    closed
        Contact name -> (c,) which candidate nodes touch.
    pressure
        Contact name -> (c,) normal force of the obstacle on each candidate node, >= 0 [N].
    memory
        Body name -> past of the solids whose law has a history.
    traction, sliding
        Contact name -> (c, d) tangential force of the obstacle on each candidate node [N], and (c,) which of them
        slip; both empty where there is no friction.
    """

    time: float
    displacement: Mapping[str, Array]
    velocity: Mapping[str, Array]
    acceleration: Mapping[str, Array]
    closed: Mapping[str, BoolArray]
    pressure: Mapping[str, Array]
    memory: Mapping[str, Memory] = field(default_factory=dict)
    traction: Mapping[str, Array] = field(default_factory=dict)
    sliding: Mapping[str, BoolArray] = field(default_factory=dict)
