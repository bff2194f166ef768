"""Scenes of the bars of the verification cases, with their marches as arrays.

In every scene the body is ``bar``, the obstacle ``stop`` and the contact ``stop``. The tip is the contact node.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.arrays import Array
from softway.bodies.inertia.mass_matrix import MassRule
from softway.contact.impact_rule import ImpactRule
from softway.laws.law import StoredEnergy
from softway.marching.results.step import Step
from softway.model.scene import State
from softway.model.time_weight import TimeWeight

ELASTIC = sw.LinearElastic(E=1.0)
MIDDLE = sw.model.Collocation(at=(0.5,), weights=(1.0,))
FOURTH = sw.model.Collocation(at=(0.0, 0.5, 1.0), weights=(-1.0 / 6.0, 4.0 / 3.0, -1.0 / 6.0))
"""Moments 1/2 and 1/6: a fourth-order phase error, as in the Fox-Goodwin scheme; stable for omega h <= sqrt(6)."""
OUT_OF_REACH = 100.0
"""Gap that no bar of the cases closes: the contact rule applies, but there is no contact."""
HAT = sw.bodies.Profile(at=(0.0, 0.5, 1.0), values=(0.0, 0.0, 1.0))
STRUCK_TIP = sw.bodies.OnTag(tag="right", value=1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Event ``touch`` or ``release``, with its time."""

    kind: str
    time: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """Record of a march of m slabs as arrays.

    Parameters
    ----------
    times, displacement, velocity
        (m + 1,) ends of the slabs, (m + 1, n) nodal displacement and velocity there.
    kinetic, strain, dissipation, error
        (m,) energies at the end of each slab, dissipation of jumps so far, and error of the energy balance.
    momentum
        (m,) momentum at the end of each slab.
    force, gap, power
        (m,) mean force of the stop over each slab, smallest gap at its end, |F v| dt over it.
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
        """Midpoint (m,) of each slab."""
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
        """Times of the events."""
        return np.array([e.time for e in self.events])

    def first(self, kind: str) -> float:
        """Time of the first event of a kind."""
        return next(e.time for e in self.events if e.kind == kind)

    def norm(self, error: Array) -> float:
        """L2 norm in time of values (m + 1,) at the ends of the slabs."""
        return float(np.sqrt(np.trapezoid(error**2, self.times)))

    def at(self, instants: Array | list[float]) -> Array:
        """Displacement (j, n) at given times, interpolated linearly between the ends of the slabs."""
        return np.stack([np.interp(instants, self.times, u) for u in self.displacement.T], axis=1)

    def contacts(self, apart: float) -> list[tuple[float, float]]:
        """Intervals of contact; openings shorter than ``apart`` are ignored, and a missing end is nan."""
        found: list[tuple[float, float]] = []
        for event in self.events:
            if event.kind == "release":
                found[-1] = (found[-1][0], event.time)
            elif not found or event.time - found[-1][1] > apart:
                found.append((event.time, np.nan))
        return found

    def mean_force(self, start: float, end: float) -> float:
        """Mean force over the slabs whose midpoints lie between two times."""
        inside = (self.middles > start) & (self.middles < end)
        return float(np.average(self.force[inside], weights=np.diff(self.times)[inside]))

    def force_error(self, start: float, end: float, level: float) -> float:
        """Root mean square of force - level over the slabs whose midpoints lie between two times."""
        inside = (self.middles > start) & (self.middles < end)
        return float(np.sqrt(np.average((self.force[inside] - level) ** 2, weights=np.diff(self.times)[inside])))


def recorded(steps: Iterable[Step]) -> Record:
    """Record the march of a scene of this module."""
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
    stop: sw.obstacles.HalfSpace | None,
    rule: ImpactRule,
    *,
    tip: str = "right",
    until: float,
    step: float | None = None,
    weight: TimeWeight = sw.model.EndPeaks(),
    loads: tuple[sw.Gravity, ...] = (),
) -> Record:
    """March a bar with or without a stop; ``step`` is ``auto`` by default."""
    bodies: dict[str, sw.Solid | sw.Tool] = {"bar": bar}
    contacts: tuple[sw.Contact, ...] = ()
    if stop is not None:
        bodies["stop"] = sw.Tool(shape=stop)
        contacts = (sw.Contact(between=(f"bar.{tip}", "stop"), name="stop", timing=rule),)
    scene = sw.Scene(bodies=bodies, contacts=contacts, loads=loads)
    return recorded(sw.march(scene, until=until, step="auto" if step is None else step, weight=weight))


def thrown(
    cells: int,
    rule: ImpactRule,
    *,
    gap: float = 0.3,
    until: float = 4.0,
    step: float | None = None,
    mass: MassRule = sw.bodies.Consistent(),
    weight: TimeWeight = sw.model.EndPeaks(),
    material: StoredEnergy = ELASTIC,
    speed: float = 1.0,
    density: float = 1.0,
    area: float = 1.0,
) -> Record:
    """March a free bar of unit length thrown at a wall (A02, A03, A12)."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=material,
        density=density,
        section=sw.bodies.Bar(area=area),
        velocity=sw.bodies.Uniform(value=speed),
        mass=mass,
    )
    wall = sw.obstacles.HalfSpace(point=1.0 + gap, normal=-1.0)
    return run(bar, wall, rule, until=until, step=step, weight=weight)


def struck(
    cells: int,
    rule: ImpactRule,
    *,
    gap: float = OUT_OF_REACH,
    side: float = 1.0,
    until: float = 10.0,
    step: float | None = None,
    mass: MassRule = sw.bodies.Consistent(),
    weight: TimeWeight = sw.model.EndPeaks(),
    material: StoredEnergy = ELASTIC,
    velocity: sw.bodies.OnTag | sw.bodies.Profile = STRUCK_TIP,
) -> Record:
    """March a bar of unit length, fixed at its left end, with a stop at side * u_tip = gap (A04, A05, A06)."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=material,
        density=1.0,
        velocity=velocity,
        mass=mass,
        supports=(sw.Fixed(on="left"),),
    )
    stop = sw.obstacles.HalfSpace(point=1.0 + side * gap, normal=-side)
    return run(bar, stop, rule, until=until, step=step, weight=weight)


def dropped(
    cells: int,
    rule: ImpactRule,
    *,
    until: float,
    step: float | None = None,
) -> Record:
    """March the bar of A09: L = 10, E = 900, g = 10, lower end 5 above the floor."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=10.0, cells=cells, origin=5.0),
        material=sw.LinearElastic(E=900.0),
        density=1.0,
    )
    floor = sw.obstacles.HalfSpace(point=0.0, normal=1.0)
    loads = (sw.Gravity(acceleration=-10.0),)
    return run(bar, floor, rule, tip="left", until=until, step=step, loads=loads)


def pulled(
    cells: int,
    rule: ImpactRule,
    *,
    until: float = 9.0,
    step: float | None = None,
) -> Record:
    """March the bar of A11: released from u = 1/2 - x/2, x = 1 fixed, u >= 0 at x = 0."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=ELASTIC,
        density=1.0,
        displacement=sw.bodies.Affine(value=0.5, gradient=-0.5),
        supports=(sw.Fixed(on="right"),),
    )
    return run(bar, sw.obstacles.HalfSpace(point=0.0, normal=1.0), rule, tip="left", until=until, step=step)
