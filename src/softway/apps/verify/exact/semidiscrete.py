"""Exact motion in time of a bar of finite elements whose tip hits a rigid stop, for the rules that stop the node.

Between two events M u'' + K u = f is solved by its modes, with the tip free or held at the stop. Events are located in
this solution. A touch is the time at which the tip reaches the stop; a release is the time at which the force of the
stop would start to pull. At a touch the velocity v of the tip becomes zero, by one of two rules:

- ``impulse``: M (v1 - v0) = G^T p, a jump of the whole mesh; the energy v^2 / (2 G M^-1 G^T) is lost;
- ``literal``: only the tip stops, its neighbours keep their velocities. Both rules agree for a diagonal mass.

The solution does not depend on a step size: it is the limit that a time integration on the same mesh approaches.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, nan, pi

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

from softway.arrays import Array

GRAZING = 1e-12  # a smaller penetration of the stop is rounding, not a touch


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mesh:
    """Bar of equal linear elements; the tip is the last node.

    ``mass``, ``stiffness`` are (n, n); ``load`` is (n,). The far end is node 0; a fixed far end is left out.
    """

    mass: Array
    stiffness: Array
    load: Array


def bar(
    elements: int,
    *,
    lumped: bool = False,
    fixed: bool = False,
    length: float = 1.0,
    youngs: float = 1.0,
    density: float = 1.0,
) -> Mesh:
    """Matrices of a bar of unit area.

    >>> bar(2, lumped=True).mass.tolist(), bar(2, fixed=True).stiffness.tolist()
    ([[0.25, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.25]], [[4.0, -2.0], [-2.0, 2.0]])
    """
    edge, n = length / elements, elements + 1
    pairs = np.arange(elements)[:, None] + np.arange(2)
    inertia = density * edge * (np.eye(2) / 2.0 if lumped else np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0)
    spring = youngs / edge * np.array([[1.0, -1.0], [-1.0, 1.0]])
    mass, stiffness = np.zeros((n, n)), np.zeros((n, n))
    for pair in pairs:
        mass[np.ix_(pair, pair)] += inertia
        stiffness[np.ix_(pair, pair)] += spring
    keep = slice(1, None) if fixed else slice(None)
    return Mesh(mass=mass[keep, keep], stiffness=stiffness[keep, keep], load=np.zeros(n)[keep])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Modes:
    """Modal solution from the time ``start`` on: u = held + shapes @ y(t)."""

    start: float
    shapes: Array
    frequencies: Array
    first: Array
    rate: Array
    force: Array
    held: Array

    def __call__(self, t: float | Array) -> tuple[Array, Array]:
        """Displacement and velocity (n,) at a time, or (times, n)."""
        s, w = np.asarray(t, float)[..., None] - self.start, self.frequencies
        still = w == 0.0
        safe = np.where(still, 1.0, w)
        rest = np.where(still, 0.0, self.force / safe**2)
        swing = (self.first - rest) * np.cos(safe * s) + self.rate * np.sin(safe * s) / safe + rest
        turn = -(self.first - rest) * safe * np.sin(safe * s) + self.rate * np.cos(safe * s)
        y = np.where(still, self.first + self.rate * s + 0.5 * self.force * s**2, swing)
        dy = np.where(still, self.rate + self.force * s, turn)
        return self.held + y @ self.shapes.T, dy @ self.shapes.T


def modes(mesh: Mesh, start: float, u: Array, v: Array, *, held: bool = False) -> Modes:
    """Motion from (u, v) at ``start``, with the tip free or held where it is."""
    n = len(u)
    moving = np.arange(n - 1 if held else n)
    square, local = eigh(mesh.stiffness[np.ix_(moving, moving)], mesh.mass[np.ix_(moving, moving)])
    square[square < 1e-12 * max(square[-1], 1.0)] = 0.0
    shapes = np.zeros((n, len(moving)))
    shapes[moving] = local
    tip = np.zeros(n)
    if held:
        tip[-1] = u[-1]
    project = shapes.T @ mesh.mass
    force = shapes.T @ (mesh.load - mesh.stiffness @ tip)
    frequencies = np.sqrt(square)
    return Modes(
        start=start,
        shapes=shapes,
        frequencies=frequencies,
        first=project @ (u - tip),
        rate=project @ v,
        force=force,
        held=tip,
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Event:
    """Event ``touch`` or ``release`` of the tip, with the state (n,) and the impulse of the stop on the tip."""

    kind: str
    time: float
    displacement: Array
    before: Array
    after: Array
    impulse: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Motion as a sequence of free and held phases, with the events between them."""

    mesh: Mesh
    phases: tuple[tuple[float, bool, Modes], ...]
    events: tuple[Event, ...]
    side: float

    def at(self, t: float) -> tuple[Array, Array, float]:
        """Displacement and velocity (n,) and the force of the stop on the tip, positive in compression."""
        _, held, motion = [p for p in self.phases if p[0] <= t][-1]
        u, v = motion(t)
        return u, v, float(_push(self.mesh, motion, u, self.side)) if held else 0.0

    def energy(self, t: float) -> float:
        """Kinetic and strain energy minus the work of the load."""
        u, v, _ = self.at(t)
        return float(0.5 * v @ self.mesh.mass @ v + 0.5 * u @ self.mesh.stiffness @ u - self.mesh.load @ u)

    def mean_velocity(self, t: float) -> float:
        """Velocity of the centre of mass, with a free far end."""
        weights = self.mesh.mass.sum(axis=0)
        return float(weights @ self.at(t)[1] / weights.sum())

    def times(self, kind: str) -> list[float]:
        """Times of the events of a kind."""
        return [e.time for e in self.events if e.kind == kind]


def solve(
    mesh: Mesh, u: Array, v: Array, *, gap: float, until: float, rule: str = "impulse", side: float = +1.0
) -> Motion:
    """Motion from (u, v) at t = 0 with the constraint side * u_tip <= gap.

    >>> thrown = solve(bar(2), np.zeros(3), np.ones(3), gap=0.0, until=3.0)
    >>> [(e.kind, round(e.time, 10)) for e in thrown.events], round(thrown.energy(3.0) / 0.5, 12)
    ([('touch', 0.0), ('release', 1.841154983)], 0.857142857143)
    """
    t, u, v = 0.0, np.array(u, float), np.array(v, float)
    phases: list[tuple[float, bool, Modes]] = []
    events: list[Event] = []
    held = False
    if side * u[-1] >= gap and side * v[-1] > 0.0:
        events.append(_touch(mesh, t, u, v, rule, side))
        v, held = events[-1].after, True
    while t < until:
        motion = modes(mesh, t, u, v, held=held)
        phases.append((t, held, motion))
        found = _first(*_event_function(mesh, motion, gap, side, held), t, until, _sampling(mesh))
        if found is None:
            break
        t = found
        u, v = motion(t)
        if held:
            events.append(Event(kind="release", time=t, displacement=u, before=v, after=v))
        else:
            u = np.append(u[:-1], side * gap)
            events.append(_touch(mesh, t, u, v, rule, side))
            v = events[-1].after
        held = not held
    return Motion(mesh=mesh, phases=tuple(phases), events=tuple(events), side=side)


def _touch(mesh: Mesh, t: float, u: Array, v: Array, rule: str, side: float) -> Event:
    """Velocity jump that stops the tip."""
    if rule == "literal":
        return Event(kind="touch", time=t, displacement=u, before=v, after=np.append(v[:-1], 0.0), impulse=nan)
    response = np.linalg.solve(mesh.mass, np.eye(len(v))[-1])
    impulse = v[-1] / response[-1]
    after = np.append((v - response * impulse)[:-1], 0.0)
    return Event(kind="touch", time=t, displacement=u, before=v, after=after, impulse=side * impulse)


def _push(mesh: Mesh, motion: Modes, u: Array, side: float) -> Array:
    """Force of the stop on the held tip: the residual of its row of M u'' + K u - f."""
    row, load = _balance(mesh, motion)
    return -side * (u @ row - load)


def _balance(mesh: Mesh, motion: Modes) -> tuple[Array, float]:
    """Row r and number l with M u'' + K u - f = r u - l at the held tip, where u'' = S S^T (f - K u)."""
    back = mesh.mass[-1] @ motion.shapes @ motion.shapes.T
    return mesh.stiffness[-1] - back @ mesh.stiffness, float(mesh.load[-1] - back @ mesh.load)


Scalar = Callable[[float | Array], Array]


def _event_function(mesh: Mesh, motion: Modes, gap: float, side: float, held: bool) -> tuple[Scalar, Scalar]:
    """Function whose upward zero crossing is the next event, and its rate."""
    if not held:
        return (lambda t: side * motion(t)[0][..., -1] - gap), (lambda t: side * motion(t)[1][..., -1])
    row, _ = _balance(mesh, motion)
    return (lambda t: -_push(mesh, motion, motion(t)[0], side)), (lambda t: side * (motion(t)[1] @ row))


def _sampling(mesh: Mesh) -> float:
    """Sampling interval: 1/32 of the shortest period."""
    return 2.0 * pi / 32.0 / float(np.sqrt(eigh(mesh.stiffness, mesh.mass, eigvals_only=True)[-1]))


def _first(f: Scalar, rate: Scalar, start: float, end: float, step: float) -> float | None:
    """First time after which f exceeds zero, found between samples or at a maximum between two of them.

    It is ``start`` if f is above zero there.
    """
    times = np.linspace(start, end, max(ceil((end - start) / step), 1) + 1)
    values, rates = f(times), rate(times)
    if values[0] > GRAZING:
        return start
    crosses = values[1:] > GRAZING
    peaks = (rates[:-1] > 0.0) & (rates[1:] < 0.0)
    for k in np.flatnonzero(crosses | peaks):
        a, b = float(times[k]), float(times[k + 1])
        if not crosses[k]:
            b = _zero(rate, a, b)
            if float(f(b)) <= GRAZING:
                continue
        level = 0.0 if values[k] < 0.0 else GRAZING
        return _zero(_above(f, level), a, b)
    return None


def _above(f: Scalar, level: float) -> Scalar:
    return lambda t: f(t) - level


def _zero(f: Scalar, a: float, b: float) -> float:
    """Zero of f between a and b; if rounding hides the sign change, the end with the smaller value."""
    fa, fb = float(f(a)), float(f(b))
    if fa * fb > 0.0:
        return a if abs(fa) < abs(fb) else b
    return float(brentq(lambda t: float(f(t)), a, b, xtol=1e-15, rtol=1e-15))
