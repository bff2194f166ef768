"""Contest of several methods with the same scene, initial state, slab length and tolerance."""

import time as clock
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.arrays import Array
from softway.errors import Cancel, InputError, NumericsError
from softway.heat.coupled.build import build
from softway.marching.audit.ledger import initial_ledger
from softway.marching.march import march
from softway.marching.start.initial_state import initial_state
from softway.marching.start.slab_length import proposed
from softway.marching.state.model_state import join_states, split_states
from softway.marching.state.step_control import StepControl
from softway.model.model import Model
from softway.model.scene import Scene, State
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.studies.race.penalised import penalised
from softway.studies.race.penalty import Penalty
from softway.studies.race.result import Entrant, Lap, Result
from softway.units import Second

Watch = Callable[[str, Second], None]
LEAST = 1e-2
"""Shortest slab as a fraction of the given length; a method that needs shorter ones has failed."""


def entrants(tolerance: float = 1e-11) -> dict[str, Entrant]:
    """Methods by name, all with the same tolerance.

    Examples
    --------
    >>> list(entrants())
    ['plain', 'accelerated', 'modified', 'newton', 'penalty']
    """
    return {
        "plain": FixedPoint(depth=0, handover=False, tolerance=tolerance),
        "accelerated": FixedPoint(tolerance=tolerance),
        "modified": Newton(renew="slab", handover=False, tolerance=tolerance),
        "newton": Newton(handover=False, tolerance=tolerance),
        "penalty": Penalty(tolerance=tolerance),
    }


def contest(
    scene: Scene | Model,
    *,
    until: Second,
    step: Second | Literal["auto"] = "auto",
    methods: Mapping[str, Entrant] | Sequence[str] = (),
    slabs: int | None = None,
    tolerance: float = 1e-11,
    weight: TimeWeight = EndPeaks(),
    control: StepControl = StepControl(),
    watch: Watch | None = None,
    cancel: Cancel | None = None,
) -> tuple[Result, ...]:
    """Compute a scene by several methods, from the same initial state and with the same slab length.

    A slab (time step) that fails is tried again with half the length, as in :func:`~softway.marching.march.march`,
    down to the fraction ``LEAST``. A method that needs shorter slabs has failed; its result holds the reason.

    Parameters
    ----------
    scene
        Scene, or a model that is already built.
    until
        End time [s].
    step
        Slab length [s], shortened to divide the duration evenly.
    methods
        Methods by name, or names from :func:`entrants`; all of those if empty.
    slabs
        Number of slabs to compute; by default all.
    tolerance
        Change of velocity, relative to the greatest velocity, below which the named methods accept an iterate.
    weight, control
        Time weighting and step control, as in a march; the penalty method always uses the trapezoidal rule.
    watch
        Called after every slab with the name of the method and the time.
    cancel
        Function that returns True to stop; called in every iteration, by the penalty method in every slab.

    Raises
    ------
    InputError
        If a name is unknown, or ``slabs`` is not positive.
    Cancelled
        If ``cancel`` returns True.

    Examples
    --------
    >>> import softway as sw
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=2), material=sw.LinearElastic(E=1.0), density=1.0,
    ...                velocity=sw.bodies.Uniform(value=1.0))
    >>> wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.25, normal=-1.0))
    >>> scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    >>> for result in contest(scene, until=4.0, step=0.05, methods=("accelerated", "penalty")):
    ...     print(result.name, len(result.laps), result.drift < 1e-12, result.penetration > 1e-6)
    accelerated 80 True False
    penalty 80 False True
    """
    chosen = _chosen(methods, tolerance)
    model = scene if isinstance(scene, Model) else build(scene)
    state = split_states(model, initial_state(model, cancel=cancel))
    span = proposed(model, step, weight, until - state.time)
    end = until if slabs is None else min(until, state.time + _positive(slabs) * span)
    limits = replace(control, least=max(control.least, LEAST))
    course = _Course(model=model, state=state, until=end, span=span, weight=weight, control=limits, cancel=cancel)
    for _ in march(
        model, until=state.time + span, step=span, weight=weight, state=state, control=limits, cancel=cancel
    ):
        break  # one slab, to load the kernels
    return tuple(_raced(name, method, course, watch) for name, method in chosen.items())


def _chosen(methods: Mapping[str, Entrant] | Sequence[str], tolerance: float) -> Mapping[str, Entrant]:
    if isinstance(methods, Mapping) and methods:
        return methods
    known = entrants(tolerance)
    for name in methods:
        if name not in known:
            raise InputError("methods", f"no method '{name}'", ", ".join(known))
    return {name: known[name] for name in methods or known}


def _positive(slabs: int) -> int:
    if slabs < 1:
        raise InputError("slabs", f"{slabs}", "1 or more")
    return slabs


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Course:
    """Data shared by all methods of a contest."""

    model: Model
    state: State
    until: float
    span: float
    weight: TimeWeight
    control: StepControl
    cancel: Cancel | None


Reached = tuple[Lap, Mapping[str, Array]]


def _started(course: _Course, method: Entrant) -> tuple[float, Iterator[Reached]]:
    """Initial energy [J], and an iterator over the slabs."""
    if isinstance(method, Penalty):
        return _penalty(course, method)
    steps = march(
        course.model,
        until=course.until,
        step=course.span,
        weight=course.weight,
        method=method,
        state=course.state,
        control=course.control,
        cancel=course.cancel,
    )
    first = initial_ledger(course.model, join_states(course.model, course.state))
    return first.energy_kinetic + first.energy_strain, (
        (
            Lap(
                time=s.after.time,
                iterations=s.report.iterations,
                rejected=len(s.report.rejections),
                factorisations=s.report.factorisations,
                energy=s.ledger.energy_kinetic + s.ledger.energy_strain,
                error=s.ledger.energy_error,
                gap=_finite(s.certificate.min_gap),
                force=s.certificate.min_force if s.ledger.contacts else None,
            ),
            s.after.displacement,
        )
        for s in steps
    )


def _penalty(course: _Course, method: Penalty) -> tuple[float, Iterator[Reached]]:
    rules, first, steps = penalised(
        course.model.scene, course.state, course.until, course.span, method, course.control, course.cancel
    )
    return first.energy, (
        (
            Lap(
                time=s.time,
                iterations=s.iterations,
                rejected=s.rejected,
                factorisations=s.factorisations,
                energy=s.energy,
                error=s.energy - first.energy - s.work,
                gap=_finite(s.gap),
                force=float(s.pressure.min()) if len(s.pressure) else None,
            ),
            rules.model.split(s.displacement),
        )
        for s in steps
    )


def _finite(gap: float) -> float | None:
    return gap if np.isfinite(gap) else None


def _raced(name: str, method: Entrant, course: _Course, watch: Watch | None) -> Result:
    """Run one method to its end."""
    initial, steps = _started(course, method)
    last = clock.perf_counter(), clock.process_time()
    laps: list[Lap] = []
    moved: Mapping[str, Array] = {}
    reason = ""
    try:
        for lap, moved in steps:  # noqa: B007  (the last value is used)
            now = clock.perf_counter(), clock.process_time()
            laps.append(replace(lap, wall=now[0] - last[0], cpu=now[1] - last[1]))
            if watch is not None:
                watch(name, lap.time)
            last = clock.perf_counter(), clock.process_time()
    except NumericsError as error:
        reason = str(error)
    failing = (clock.perf_counter() - last[0], clock.process_time() - last[1]) if reason else (0.0, 0.0)
    return Result(
        name=name,
        method=method,
        laps=tuple(laps),
        wall=sum(lap.wall for lap in laps) + failing[0],
        cpu=sum(lap.cpu for lap in laps) + failing[1],
        initial=initial,
        reason=reason,
        displacement=moved,
    )
