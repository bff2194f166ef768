"""Slab lengths (time steps) by a tolerance: rungs of a ladder, each twice as long as the one below.

The lowest rung is the requested length.  A slab above it is dropped, and taken shorter, if its error exceeds the
tolerance or if something happens inside it (docs/theory/time/control.md).
"""

from dataclasses import dataclass
from math import ceil, floor, log2

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled import material_states
from softway.bodies.assembled.material_states import any_path_dependent
from softway.marching.results.slab_result import SlabResult
from softway.marching.start.slab_length import prescribed_speed
from softway.marching.state.march_state import Settings, StepHistory
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import EARLY, ROUNDING, above
from softway.model.model import Model
from softway.model.slab import Slab

SMOOTH = 3
"""Number of successive slabs with a small error after which slabs grow."""
UNSTRAINED = 1e-9
"""Strain that is rounding."""
LEAP = 1.0
"""Greatest way of a node in a slab above the lowest rung, in edges, where surfaces might pass through each other."""


def rungs(settings: Settings) -> int:
    """Number of rungs above the lowest one; zero without a tolerance."""
    return 0 if settings.tolerance is None else max(0, floor(log2(settings.control.longest) + ROUNDING))


def on_ladder(settings: Settings, history: StepHistory, span: float) -> bool:
    """True if a slab of the length ``span`` is on a rung: a half or less of the lowest one is a cutback."""
    return settings.tolerance is not None and span > 0.5 * history.span * (1.0 + ROUNDING)


def velocity_error(now: ModelState, slab: Slab, after: ModelState) -> Array:
    """Error (n, d) of the mean velocity in a slab, from the jump of the slopes of the velocity [m/s].

    The velocity is linear in a slab.  Against an acceleration that changes at the rate ``a' = 2 |a1 - a0| / (h0 + h)``,
    h0 and h the lengths of the slab before and of this one, its mean has the error ``h^2 a' / 12``.

    Parameters
    ----------
    now, after
        States at the start and the end of the slab; ``now.span`` must not be zero.
    slab
        The slab.
    """
    return slab.span**2 * np.abs(after.acceleration - now.acceleration) / (6.0 * (now.span + slab.span))


def slowest(model: Model) -> float:
    """Velocity that strains the stiffest solid by no more than rounding [m/s]: vibrations at rest."""
    return UNSTRAINED * max(model.wave_speed(p) for p in model.parts)


def fastest(model: Model, history: StepHistory, *states: ModelState) -> float:
    """Greatest velocity component of a node with inertia so far [m/s]."""
    heavy = model.massive[:, None]
    return max(history.fastest, *(model.space.greatest(np.where(heavy, s.start.velocity, 0.0)) for s in states))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Quality:
    """Quality of a slab under a tolerance.

    Parameters
    ----------
    error
        Greatest error of the mean velocity, relative to the greatest velocity so far; infinite without an estimate.
    flow
        Energy that the materials dissipated in the slab, relative to the kinetic and stored energy.
    leap
        Greatest way of a node or tool, in the shortest edge, where surfaces might pass through each other.
    """

    error: float
    flow: float
    leap: float

    @classmethod
    def of(cls, model: Model, history: StepHistory, now: ModelState, slab: Slab, after: ModelState) -> "Quality":
        """Quality of a solved slab."""
        error = np.inf
        if now.span > 0.0:
            found = np.where(model.massive[:, None], velocity_error(now, slab, after), 0.0)
            error = _ratio(model.space.greatest(found), fastest(model, history, now, after))
        return cls(error=error, flow=_flow(model, now, after), leap=_leap(model, now, slab, after))

    def excess(self, tolerance: float) -> str:
        """Reason to drop a slab above the lowest rung; empty if there is none."""
        if self.error > tolerance:
            return f"an error of {self.error:.3g} of the velocity"
        if self.flow > tolerance:
            return f"{self.flow:.3g} of the energy dissipated by the materials"
        return f"a way of {self.leap:.3g} edges near other surfaces" if self.leap > LEAP else ""

    def allows_twice(self, tolerance: float) -> bool:
        """True if a slab of twice the length is expected to have a small error: four times that of this one."""
        return max(4.0 * self.error, 2.0 * self.flow) <= tolerance and 2.0 * self.leap <= LEAP


def _ratio(value: float, scale: float) -> float:
    return value / scale if scale > 0.0 else 0.0 if value == 0.0 else np.inf


def _flow(model: Model, now: ModelState, after: ModelState) -> float:
    """Energy that path-dependent materials dissipated in a slab, relative to the kinetic and stored energy."""
    if not any_path_dependent(model.parts):
        return 0.0
    lost = material_states.dissipated_energy(model.parts, after.start.states)
    lost -= material_states.dissipated_energy(model.parts, now.start.states)
    v = after.start.velocity
    return _ratio(max(0.0, lost), 0.5 * model.space.dot(v, model.mass @ v) + float(after.start.energy.sum()))


def _leap(model: Model, now: ModelState, slab: Slab, after: ModelState) -> float:
    """Greatest way in a slab, in the shortest edge; zero where all that may touch are half-spaces at rest.

    The gap to a half-space is negative everywhere behind it; other surfaces have a far side.
    """
    if not len(model.contacts.changing):
        return 0.0
    moved = model.space.greatest(after.start.displacement - now.start.displacement)
    return (moved + prescribed_speed(model) * slab.span) / model.space.least(model.edge)


def fault(
    model: Model,
    settings: Settings,
    history: StepHistory,
    now: ModelState,
    slab: Slab,
    out: SlabResult,
    after: ModelState,
) -> str:
    """Reason to drop a slab above the lowest rung; empty if there is none."""
    if out.events or (now.closed != after.closed).any():
        kind = out.events[0].kind if out.events else "change of contact"
        return f"{kind} inside a time step above the lowest rung"
    assert settings.tolerance is not None
    return Quality.of(model, history, now, slab, after).excess(settings.tolerance)


def before_event(slab: Slab, lowest: float, out: SlabResult) -> float:
    """Length of the next attempt [s] at a slab that was dropped: half of it, or the longest rung before its event.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from softway.model.time_weight import EndPeaks
    >>> told = SimpleNamespace(events=(SimpleNamespace(time=2.6),))
    >>> [before_event(Slab(start=s, end=s + 8.0, weight=EndPeaks()), 1.0, told) for s in (-2.0, 0.0, 2.0)]
    [4.0, 2.0, 1.0]
    """
    time = out.events[0].time - slab.start - EARLY * lowest if out.events else np.inf
    length = 0.5 * slab.span
    while above(length, lowest) and length > time:
        length *= 0.5
    return length


def next_rung(
    settings: Settings, history: StepHistory, span: float, quality: Quality, events: bool
) -> tuple[float, int]:
    """Length of the next slab [s], and the number of successive smooth slabs before it.

    Parameters
    ----------
    settings, history
        Settings of the march, and its history before the slab.
    span
        Length of the slab, on a rung [s].
    quality, events
        Its quality, and whether something happened in it.
    """
    assert settings.tolerance is not None
    length = history.span * 2.0 ** _rung(span, history.span)
    if events or not quality.allows_twice(settings.tolerance):
        return length, 0
    if history.smooth + 1 < SMOOTH or length >= history.span * 2.0 ** rungs(settings):
        return length, min(history.smooth + 1, SMOOTH)
    return 2.0 * length, 0


def _rung(span: float, lowest: float) -> int:
    """Rung of a slab: knots make slabs shorter than their rung, by less than a half."""
    return max(0, ceil(log2(span / lowest) - ROUNDING))
