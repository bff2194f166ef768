"""Scenario: bodies, contacts, loads, start, time, solver and output of a run as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Literal

from softway.bodies.conductor import Conductor
from softway.bodies.inertia.inertia_scaling import Full, Inertia
from softway.bodies.internal_force.materials import laws_of
from softway.bodies.setup.heat_loads import HeatLoad
from softway.bodies.setup.loads import Load
from softway.bodies.solid import Solid, Tool
from softway.contact.assembly.tie import Tie
from softway.contact.contact import Contact
from softway.errors import InputError, real
from softway.heat.heat_contact import HeatContact
from softway.html_tables import table as html_table
from softway.marching.state.step_control import StepControl
from softway.mechanisms.members.couplings import Gear, HeatLink
from softway.mechanisms.members.joints import Joint
from softway.mechanisms.members.motors import Motor
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.members.springs import HingeTorque, PointForce, Spring, Torque, TorsionSpring
from softway.mechanisms.members.stops import AngleStop, Impacts, Restitution, Stop
from softway.meshes.mesh import Mesh
from softway.model.scene import AsGiven, Scene, StaticStart
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.piles.contacts import PileContacts
from softway.piles.groups import BallGroup
from softway.record.storage.checkpoint import Checkpoints
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.units import Metre, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Time:
    """End time and time steps (slabs) of a run.

    Parameters
    ----------
    end
        End time [s].
    step
        Length of a time step (slab) [s]; with ``auto`` a wave crosses the smallest edge in sqrt(2) slabs, and without
        inertia tools and driven supports move by at most a quarter of the smallest edge in a slab.
    weight
        Virtual time function of the weighted momentum balance.
    control
        Limits for the acceptance of a slab; a rejected slab is repeated with a shorter length.
    tolerance
        Error of the mean velocity of a node in a slab, relative to the greatest velocity so far, up to which slabs grow
        beyond ``step``, to at most ``control.longest`` of it, while nothing touches, parts, sticks or slips.  ``auto``
        is 0.001 with ``step = "auto"``, where something estimates the error, and ``off`` with a given step; ``off``
        keeps all slabs at the length ``step``.  0.01 to 0.1 are fast, where vibrations need not keep their phase.

    Examples
    --------
    >>> Time(end=4.0).step
    'auto'
    """

    end: Second
    step: Second | Literal["auto"] = "auto"
    weight: TimeWeight = EndPeaks()
    control: StepControl = StepControl()
    tolerance: float | Literal["auto", "off"] = "auto"

    def __post_init__(self) -> None:
        real(self.end, "end")
        if self.step != "auto":
            real(self.step, "step")
        if not (isfinite(self.end) and self.end > 0.0):
            raise InputError("end", f"{self.end:g} s is not positive", 'a time after the start, such as "2 ms"')
        if self.step != "auto" and not (isfinite(self.step) and self.step > 0.0):
            raise InputError("step", f"{self.step:g} s is not positive", 'a time such as "1 us", or "auto"')


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """Probe: one quantity at one place, recorded in a column of the history.

    Parameters
    ----------
    name
        Name of the column.
    of
        Name of the body.
    tag
        Tag of the nodes; the mean over the nodes is recorded, or the sum for a reaction.
    at
        Reference point whose nearest node is recorded, instead of a tag; of a rigid body, and of a solid whose mesh
        adapts, the point itself; for a rigid body by default its centre [m].
    quantity
        Recorded quantity; rotation and spin (angular velocity) belong to rigid bodies, temperature to conductors
        and to solids with heat.
    component
        Recorded component; ``norm`` is the magnitude of the vector.  A rigid body in the plane turns about ``z``.

    Examples
    --------
    >>> Probe(name="tip", of="bar", tag="right").quantity
    'displacement'
    """

    name: str
    of: str
    tag: str | None = None
    at: tuple[Metre, ...] | None = None
    quantity: Literal["displacement", "velocity", "position", "reaction", "rotation", "spin", "temperature"] = (
        "displacement"
    )
    component: Literal["x", "y", "z", "norm"] = "x"


@dataclass(frozen=True, slots=True, kw_only=True)
class Output:
    """Output of a run in addition to the history.

    Parameters
    ----------
    fields_every
        Time between two stored frames of the fields [s]; ``auto`` stores about one hundred frames in total.  Of a
        mechanism it is the time between two lines of its tables, and ``auto`` stores at most one thousand.
    probes
        Further columns of the history.
    checkpoints
        Schedule of the checkpoints from which a stopped run can be resumed.
    audit
        True if the overlaps of all surfaces, inverted cells and the balances are looked at, independently of the
        contact, at the stored frames (at most every tenth slab) and at the end; findings are among the events.

    Examples
    --------
    >>> Output().fields_every
    'auto'
    """

    fields_every: Second | Literal["auto"] = "auto"
    probes: tuple[Probe, ...] = ()
    checkpoints: Checkpoints = Checkpoints()
    audit: bool = True

    def __post_init__(self) -> None:
        if self.fields_every != "auto":
            real(self.fields_every, "fields_every")
        if self.fields_every != "auto" and not self.fields_every > 0.0:
            raise InputError("fields_every", f"{self.fields_every:g} s is not positive", 'a time, or "auto"')


Body = Solid | Tool | Rigid | BallGroup | Conductor
"""Body of a scenario."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """Complete description of a run.

    Parameters
    ----------
    bodies
        Solids and tools by name, rigid bodies of a :class:`~softway.mechanisms.Mechanism`, groups of balls, or
        conductors.
    time
        End time and time steps.
    title
        Title of the run, in one line.
    contacts, ties, loads
        Contact pairs, permanent ties and loads on the bodies, as in :class:`~softway.model.scene.Scene`; conductors
        have loads of heat.
    start
        Initial fields as given, or a static equilibrium.
    inertia
        Inertia: full, off (quasi-static) or scaled.
    solver
        Solution method for a time step.
    output
        Stored frames, probes and checkpoints.
    joints
        Joints between rigid bodies by name, as in :class:`~softway.mechanisms.Mechanism`.
    stops
        Stops, unilateral joints between rigid bodies, by name.
    springs
        Springs and dampers between rigid bodies, or about hinges.
    torques, forces
        Constant torques on rigid bodies or about hinges, and constant forces at points of rigid bodies.
    gears, motors
        Gears between joints and motors that prescribe the motion of joints, by name.
    impacts
        Law of impacts at several stops at once: ``simultaneous``, or ``sequential``, one after the other.
    restitution
        What the coefficients of restitution are ratios of: velocities (``Newton``) or impulses (``Poisson``).
    pile
        Walls around balls, and laws of their contacts.
    heat_links
        Heat between rigid bodies with a temperature, as in :class:`~softway.mechanisms.Mechanism`.
    heat_contacts
        Exchange of heat between conductors that touch, as in :class:`~softway.heat.HeatScene`.
    """

    bodies: Mapping[str, Body]
    time: Time
    title: str = ""
    contacts: tuple[Contact, ...] = ()
    ties: tuple[Tie, ...] = ()
    loads: tuple[Load | HeatLoad, ...] = ()
    start: AsGiven | StaticStart = AsGiven()
    inertia: Inertia = Full()
    solver: FixedPoint | Newton | Explicit = FixedPoint()
    output: Output = Output()
    joints: Mapping[str, Joint] = field(default_factory=dict)
    stops: Mapping[str, Stop] = field(default_factory=dict)
    springs: tuple[Spring | TorsionSpring, ...] = ()
    torques: tuple[Torque | HingeTorque, ...] = ()
    forces: tuple[PointForce, ...] = ()
    gears: Mapping[str, Gear] = field(default_factory=dict)
    motors: Mapping[str, Motor] = field(default_factory=dict)
    impacts: Impacts = "simultaneous"
    restitution: Restitution = "Newton"
    pile: PileContacts = PileContacts()
    heat_links: tuple[HeatLink, ...] = ()
    heat_contacts: tuple[HeatContact, ...] = ()

    def _repr_html_(self) -> str:
        """HTML table for notebooks."""
        step = self.time.step if isinstance(self.time.step, str) else f"{self.time.step:.4g} s"
        rows = {
            "bodies": "\n".join(_described(name, body) for name, body in self.bodies.items()),
            "contacts": "\n".join(
                f"{c.label}: {type(c.timing).__name__}, {type(c.friction).__name__}" for c in self.contacts
            )
            or "none",
            "loads": ", ".join(type(load).__name__ for load in self.loads) or "none",
            **self._links(),
            "time": f"{self.time.end:.4g} s, step {step}",
            "solver": type(self.solver).__name__,
            "inertia": type(self.inertia).__name__,
        }
        return html_table(self.title or "Scenario", rows)

    def _links(self) -> dict[str, str]:
        """Rows of joints and stops for notebooks; none for solids."""
        rows = {"joints": self.joints, "stops": self.stops}
        return {
            key: "\n".join(f"{n}: {type(p).__name__} of {_linked(p)}" for n, p in parts.items())
            for key, parts in rows.items()
            if parts
        }

    @property
    def mechanical_loads(self) -> tuple[Load, ...]:
        """Loads that are forces."""
        return tuple(load for load in self.loads if isinstance(load, Load))

    @property
    def scene(self) -> Scene:
        """Scene of solids and tools; its meshes are still recipes."""
        return Scene(
            bodies={name: body for name, body in self.bodies.items() if isinstance(body, Solid | Tool)},
            contacts=self.contacts,
            ties=self.ties,
            loads=self.loads,
            start=self.start,
            inertia=self.inertia,
        )


def _linked(part: Joint | Stop) -> str:
    """What a joint or a stop connects."""
    return part.joint if isinstance(part, AngleStop) else " and ".join(part.between)


def _described(name: str, body: Body) -> str:
    """Description of a body for notebooks."""
    if isinstance(body, BallGroup):
        return f"{name}: {type(body).__name__}"
    if isinstance(body, Conductor):
        return f"{name}: Conductor of {type(body.mesh).__name__}"
    if isinstance(body, Rigid):
        return f"{name}: Rigid, {body.mass:.4g} kg"
    if isinstance(body, Tool):
        return f"{name}: {type(body.shape).__name__}, {type(body.motion).__name__}"
    size = f" of {body.mesh.n_nodes} nodes" if isinstance(body.mesh, Mesh) else ""
    laws = ", ".join(dict.fromkeys(type(law).__name__ for law in laws_of(body.material)))
    return f"{name}: {type(body.mesh).__name__}{size}, {laws}"
