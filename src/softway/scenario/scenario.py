"""Scenario: a scene with its start, its time, its solver and its output, as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite
from typing import Literal

from softway.bodies.inertia import Full, Inertia
from softway.bodies.loads import Load
from softway.bodies.placement import Placement
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact
from softway.errors import InputError, real
from softway.march.control import StepControl
from softway.markup import table as html_table
from softway.record.checkpoint import Checkpoints
from softway.scene import AsGiven, Scene, StaticStart
from softway.solve.explicit import Explicit
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.space.mesh import Mesh
from softway.time.weight import EndPeaks, TimeWeight
from softway.units import Metre, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Time:
    """How long, and in which slabs.

    Parameters
    ----------
    end
        Last instant [s].
    step
        Length of a slab [s]; ``auto``: a wave crosses the smallest edge in sqrt(2) slabs.
    weight
        Virtual time function.
    control
        Limits of a slab; one that breaks them is tried again shorter.

    Examples
    --------
    >>> Time(end=4.0).step
    'auto'
    """

    end: Second
    step: Second | Literal["auto"] = "auto"
    weight: TimeWeight = EndPeaks()
    control: StepControl = StepControl()

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
    """A column of the history: one quantity of one place.

    Parameters
    ----------
    name
        Head of the column.
    of
        Body.
    tag
        Nodes; the mean over them is recorded, for a reaction the sum.
    at
        Or a reference point, whose nearest node is taken [m].
    quantity, component
        What is recorded; ``norm`` is the length of the vector.

    Examples
    --------
    >>> Probe(name="tip", of="bar", tag="right").quantity
    'displacement'
    """

    name: str
    of: str
    tag: str | None = None
    at: tuple[Metre, ...] | None = None
    quantity: Literal["displacement", "velocity", "position", "reaction"] = "displacement"
    component: Literal["x", "y", "z", "norm"] = "x"


@dataclass(frozen=True, slots=True, kw_only=True)
class Output:
    """What is recorded besides the history.

    Parameters
    ----------
    fields_every
        Time between stored fields [s]; ``auto``: about a hundred in all.
    probes
        Further columns of the history.
    checkpoints
        How often the run notes where it stands, so that it can be resumed.

    Examples
    --------
    >>> Output().fields_every
    'auto'
    """

    fields_every: Second | Literal["auto"] = "auto"
    probes: tuple[Probe, ...] = ()
    checkpoints: Checkpoints = Checkpoints()

    def __post_init__(self) -> None:
        if self.fields_every != "auto":
            real(self.fields_every, "fields_every")
        if self.fields_every != "auto" and not self.fields_every > 0.0:
            raise InputError("fields_every", f"{self.fields_every:g} s is not positive", 'a time, or "auto"')


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """Everything that a run needs.

    Parameters
    ----------
    title
        One line for people.
    bodies, contacts, loads
        As in :class:`~softway.scene.Scene`.
    start
        The initial fields as given, or a static equilibrium.
    inertia
        Full, off (quasi-static) or scaled.
    time, solver, output
        Slabs, method, records.
    """

    bodies: Mapping[str, Solid | Tool]
    time: Time
    title: str = ""
    contacts: tuple[Contact, ...] = ()
    loads: tuple[Load, ...] = ()
    start: AsGiven | StaticStart = AsGiven()
    inertia: Inertia = Full()
    solver: FixedPoint | Newton | Explicit = FixedPoint()
    output: Output = Output()

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        step = self.time.step if isinstance(self.time.step, str) else f"{self.time.step:.4g} s"
        rows = {
            "bodies": "\n".join(_described(name, body) for name, body in self.bodies.items()),
            "contacts": "\n".join(
                f"{c.between[0]} – {c.between[1]}: {type(c.timing).__name__}, {type(c.friction).__name__}"
                for c in self.contacts
            )
            or "none",
            "loads": ", ".join(type(load).__name__ for load in self.loads) or "none",
            "time": f"{self.time.end:.4g} s, step {step}",
            "solver": type(self.solver).__name__,
            "inertia": type(self.inertia).__name__,
        }
        return html_table(self.title or "Scenario", rows)

    @property
    def scene(self) -> Scene:
        """What there is, with the meshes as recipes."""
        return Scene(
            bodies=self.bodies,
            contacts=self.contacts,
            loads=self.loads,
            start=self.start,
            inertia=self.inertia,
        )


def _described(name: str, body: Solid | Tool) -> str:
    """A body in words."""
    if isinstance(body, Tool):
        return f"{name}: {type(body.shape).__name__}, {type(body.motion).__name__}"
    size = f" of {body.mesh.n_nodes} nodes" if isinstance(body.mesh, Mesh) else ""
    return f"{name}: {type(body.mesh).__name__}{size}, {type(body.material).__name__}"


def built(scenario: Scenario) -> Scene:
    """The scene with every mesh made and put into its place.

    Raises
    ------
    InputError
        With the path of the mesh: missing file, inverted cell, impossible size.
    """
    bodies = {}
    for name, body in scenario.bodies.items():
        bodies[name] = _built(body, f"bodies.{name}") if isinstance(body, Solid) else body
    return replace(scenario.scene, bodies=bodies)


def _built(solid: Solid, where: str) -> Solid:
    """The solid with a mesh in place of the recipe."""
    try:
        mesh = solid.mesh if isinstance(solid.mesh, Mesh) else solid.mesh.build()
    except InputError as error:
        raise error.within(f"{where}.mesh") from None
    try:
        return replace(solid, mesh=solid.place.applied(mesh), place=Placement())
    except InputError as error:
        raise error.within(f"{where}.place") from None
