"""The bars of the verification cases as scenes of softway, and their marches as arrays.

In every scene the body is ``bar``, the obstacle ``stop`` and the contact ``stop``.  The tip is the node that may touch.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.bodies.mass import MassRule
from softway.contact.timing import Timing
from softway.laws.law import StoredEnergy
from softway.march.step import Step
from softway.scene import State
from softway.time.weight import TimeWeight
from softway.typing import Array

ELASTIC = sw.LinearElastic(E=1.0)
MIDDLE = sw.Collocation(at=(0.5,), weights=(1.0,))
FOURTH = sw.Collocation(at=(0.0, 0.5, 1.0), weights=(-1.0 / 6.0, 4.0 / 3.0, -1.0 / 6.0))
"""Moments 1/2 and 1/6: a phase of fourth order, as in the scheme of Fox and Goodwin; stable for omega h <= sqrt(6)."""
OUT_OF_REACH = 100.0
"""A gap that no bar of the cases closes: the rule is that of the contact, but nothing touches."""
HAT = sw.Profile(at=(0.0, 0.5, 1.0), values=(0.0, 0.0, 1.0))
STRUCK_TIP = sw.OnTag(tag="right", value=1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """A ``touch`` or ``release`` and its instant."""

    kind: str
    time: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """A march of m slabs as arrays.

    Parameters
    ----------
    times, displacement, velocity
        (m + 1,) ends of the slabs, (m + 1, n) displacement and velocity of the nodes there.
    kinetic, strain, dissipation, error
        (m,) energies at the end of each slab, what jumps have lost up to there, and what the balance lacks.
    momentum
        (m,) at the end of each slab.
    force, gap, power
        (m,) mean force of the stop over each slab, least gap at its end, |F v| dt over it.
    events
        Touches and releases in order.
    """

    times: Array
    displacement: Array
    velocity: Array
    kinetic: Array
    strain: Array
    dissipation: Array
    error: Array
    momentum: Array
    force: Array
    gap: Array
    power: Array
    events: tuple[Event, ...]

    @property
    def middles(self) -> Array:
        """Middle (m,) of each slab."""
        return 0.5 * (self.times[1:] + self.times[:-1])

    @property
    def energy(self) -> Array:
        """Kinetic and strain energy (m,)."""
        return self.kinetic + self.strain

    @property
    def impulse(self) -> float:
        """Impulse of the stop over the march."""
        return float(self.force @ np.diff(self.times))

    @property
    def kinds(self) -> list[str]:
        """Kinds of the events."""
        return [e.kind for e in self.events]

    @property
    def instants(self) -> Array:
        """Instants of the events."""
        return np.array([e.time for e in self.events])

    def first(self, kind: str) -> float:
        """Instant of the first event of a kind."""
        return next(e.time for e in self.events if e.kind == kind)

    def norm(self, error: Array) -> float:
        """L2 norm in time of what is given at the ends of the slabs (m + 1,)."""
        return float(np.sqrt(np.trapezoid(error**2, self.times)))

    def at(self, instants: Array | list[float]) -> Array:
        """Displacement (j, n) at instants, linear between the ends of the slabs."""
        return np.stack([np.interp(instants, self.times, u) for u in self.displacement.T], axis=1)

    def contacts(self, apart: float) -> list[tuple[float, float]]:
        """Intervals of contact; openings shorter than ``apart`` belong to them, and an end that is missing is nan."""
        found: list[tuple[float, float]] = []
        for event in self.events:
            if event.kind == "release":
                found[-1] = (found[-1][0], event.time)
            elif not found or event.time - found[-1][1] > apart:
                found.append((event.time, np.nan))
        return found

    def mean_force(self, start: float, end: float) -> float:
        """Mean force over the slabs whose middles lie between two instants."""
        inside = (self.middles > start) & (self.middles < end)
        return float(np.average(self.force[inside], weights=np.diff(self.times)[inside]))

    def force_error(self, start: float, end: float, level: float) -> float:
        """Root mean square of force - level over the slabs whose middles lie between two instants."""
        inside = (self.middles > start) & (self.middles < end)
        return float(np.sqrt(np.average((self.force[inside] - level) ** 2, weights=np.diff(self.times)[inside])))


def recorded(steps: Iterable[Step]) -> Record:
    """The march of a scene of this module."""
    states: list[State] = []
    rows: list[tuple[float, ...]] = []
    events: list[Event] = []
    for step in steps:
        states += [step.after] if states else [step.before, step.after]
        ledger = step.ledger
        stop = ledger.contacts.get("stop")
        rows.append(
            (
                ledger.energy_kinetic,
                ledger.energy_strain,
                ledger.dissipation,
                ledger.energy_error,
                ledger.momentum[0],
                *((stop.force_n, stop.min_gap, stop.power_residual) if stop else (0.0, np.inf, 0.0)),
            )
        )
        events += [Event(kind=e.kind, time=e.time) for e in step.events]
    names = ("kinetic", "strain", "dissipation", "error", "momentum", "force", "gap", "power")
    columns = dict(zip(names, np.array(rows).T, strict=True))
    return Record(
        times=np.array([s.time for s in states]),
        displacement=np.array([s.displacement["bar"][:, 0] for s in states]),
        velocity=np.array([s.velocity["bar"][:, 0] for s in states]),
        events=tuple(events),
        **columns,
    )


def run(
    bar: sw.Solid,
    stop: sw.HalfSpace | None,
    rule: Timing,
    *,
    tip: str = "right",
    until: float,
    step: float | None = None,
    weight: TimeWeight = sw.EndPeaks(),
    loads: tuple[sw.Gravity, ...] = (),
) -> Record:
    """March a bar with a stop, or without; ``step`` is ``auto`` when it is not given."""
    bodies: dict[str, sw.Solid | sw.Tool] = {"bar": bar}
    contacts: tuple[sw.Contact, ...] = ()
    if stop is not None:
        bodies["stop"] = sw.Tool(shape=stop)
        contacts = (sw.Contact(between=(f"bar.{tip}", "stop"), name="stop", timing=rule),)
    scene = sw.Scene(bodies=bodies, contacts=contacts, loads=loads)
    return recorded(sw.march(scene, until=until, step="auto" if step is None else step, weight=weight))


def thrown(
    cells: int,
    rule: Timing,
    *,
    gap: float = 0.3,
    until: float = 4.0,
    step: float | None = None,
    mass: MassRule = sw.Consistent(),
    weight: TimeWeight = sw.EndPeaks(),
    material: StoredEnergy = ELASTIC,
    speed: float = 1.0,
    density: float = 1.0,
    area: float = 1.0,
) -> Record:
    """A free bar of unit length thrown at a wall (A02, A03, A12)."""
    bar = sw.Solid(
        mesh=sw.Interval(length=1.0, cells=cells),
        material=material,
        density=density,
        section=sw.Bar(area=area),
        velocity=sw.Uniform(value=speed),
        mass=mass,
    )
    wall = sw.HalfSpace(point=1.0 + gap, normal=-1.0)
    return run(bar, wall, rule, until=until, step=step, weight=weight)


def struck(
    cells: int,
    rule: Timing,
    *,
    gap: float = OUT_OF_REACH,
    side: float = 1.0,
    until: float = 10.0,
    step: float | None = None,
    mass: MassRule = sw.Consistent(),
    weight: TimeWeight = sw.EndPeaks(),
    material: StoredEnergy = ELASTIC,
    velocity: sw.OnTag | sw.Profile = STRUCK_TIP,
) -> Record:
    """A bar of unit length fixed at its left end, with a stop at side * u_tip = gap (A04, A05, A06)."""
    bar = sw.Solid(
        mesh=sw.Interval(length=1.0, cells=cells),
        material=material,
        density=1.0,
        velocity=velocity,
        mass=mass,
        supports=(sw.Fixed(on="left"),),
    )
    stop = sw.HalfSpace(point=1.0 + side * gap, normal=-side)
    return run(bar, stop, rule, until=until, step=step, weight=weight)


def dropped(
    cells: int,
    rule: Timing,
    *,
    until: float,
    step: float | None = None,
) -> Record:
    """The bar of A09: L = 10, E = 900, g = 10, its lower end 5 above the floor."""
    bar = sw.Solid(
        mesh=sw.Interval(length=10.0, cells=cells, origin=5.0),
        material=sw.LinearElastic(E=900.0),
        density=1.0,
    )
    floor = sw.HalfSpace(point=0.0, normal=1.0)
    loads = (sw.Gravity(acceleration=-10.0),)
    return run(bar, floor, rule, tip="left", until=until, step=step, loads=loads)


def pulled(
    cells: int,
    rule: Timing,
    *,
    until: float = 9.0,
    step: float | None = None,
) -> Record:
    """The bar of A11: released from u = 1/2 - x/2, x = 1 fixed, u >= 0 at x = 0."""
    bar = sw.Solid(
        mesh=sw.Interval(length=1.0, cells=cells),
        material=ELASTIC,
        density=1.0,
        displacement=sw.Affine(value=0.5, gradient=-0.5),
        supports=(sw.Fixed(on="right"),),
    )
    return run(bar, sw.HalfSpace(point=0.0, normal=1.0), rule, tip="left", until=until, step=step)
