"""The bars of the verification cases as scenes of softway, and their marches as arrays."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

import softway as sw
from exact_waves import Array

HAT = sw.Profile(at=(0.0, 0.5, 1.0), values=(0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """A ``touch`` or ``release`` with its instant."""

    kind: str
    time: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """A march as arrays: m slabs, m + 1 instants, k watched nodes.

    Parameters
    ----------
    times, displacement
        (m + 1,) and (m + 1, k).
    kinetic, strain, work, error
        (m,) energies at the ends of the slabs, work of the loads, and what the balance lacks.
    dissipation, momentum
        (m,) energy lost in jumps up to each end, momentum.
    force, gap, power, scalar
        (m,) mean force of a slab, gap at its end, |F v| dt over it, scalar of the energy rule.
    events
        Touches and releases in order.
    """

    times: Array
    displacement: Array
    kinetic: Array
    strain: Array
    work: Array
    error: Array
    dissipation: Array
    momentum: Array
    force: Array
    gap: Array
    power: Array
    scalar: Array
    events: tuple[Event, ...]

    @property
    def middles(self) -> Array:
        """Middle (m,) of each slab."""
        return 0.5 * (self.times[1:] + self.times[:-1])

    @property
    def impulse(self) -> float:
        """Impulse of the contact over the march."""
        return float(self.force @ np.diff(self.times))

    def at(self, instants: Array) -> Array:
        """Displacement (j, k) at instants, linear between the ends of the slabs."""
        return np.stack([np.interp(instants, self.times, u) for u in self.displacement.T], axis=1)

    def kinds(self) -> list[str]:
        """Kinds of the events."""
        return [e.kind for e in self.events]

    def instants(self) -> Array:
        """Instants of the events."""
        return np.array([e.time for e in self.events])

    def contacts(self, apart: float) -> list[tuple[float, float]]:
        """Intervals of contact; openings shorter than ``apart`` count as contact, and an open end is nan."""
        found: list[tuple[float, float]] = []
        for event in self.events:
            if event.kind == "release":
                found[-1] = (found[-1][0], event.time)
            elif not found or event.time - found[-1][1] > apart:
                found.append((event.time, np.nan))
        return found

    def mean_force(self, start: float, end: float) -> float:
        """Mean of the force over the slabs whose middles lie in an interval."""
        inside = (self.middles > start) & (self.middles < end)
        return float(np.average(self.force[inside], weights=np.diff(self.times)[inside]))


def record(steps: Iterable[sw.march.__annotations__.get("return", object)], contact: str | None, nodes: slice) -> Record:
    ...
