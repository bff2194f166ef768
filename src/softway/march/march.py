"""March: propose a slab (time step), solve and audit it, and yield the step."""

import logging
from collections.abc import Iterator
from typing import Literal

import numpy as np

from softway.errors import Cancel
from softway.heat.coupled.build import build
from softway.march.attempts import DAMPED, AcceptedSlab, accept_slab, recent_rejections, require_progress
from softway.march.audit.ledger import update_account
from softway.march.march_state import MarchState, Settings, StepHistory
from softway.march.model_state import split_states
from softway.march.results.step import Report, Step
from softway.march.results.trying import TryWatch
from softway.march.rules.slab_rule import Method
from softway.march.slab.slab_step import Stepper
from softway.march.start.knots import slab_length
from softway.march.start.ladder import Quality, fastest, next_rung, on_ladder
from softway.march.start.preparation import prepare
from softway.march.step_control import StepControl, crushing, may_grow
from softway.model.model import Model
from softway.model.scene import Scene, State
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.equations.energy_balance import SLIGHT
from softway.solve.methods.fixed_point import FixedPoint
from softway.units import Second

log = logging.getLogger(__name__)
STRAINED = 0.2
"""Fraction of the requested length below which a large scalar does not shorten slabs further."""


def march(
    scene: Scene | Model,
    *,
    until: Second,
    step: Second | Literal["auto"] = "auto",
    weight: TimeWeight = EndPeaks(),
    method: Method = FixedPoint(),
    state: State | MarchState | None = None,
    control: StepControl = StepControl(),
    tolerance: float | None = None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step]:
    """Accepted slabs from the start, or from ``state``, to the time ``until``.

    Parameters
    ----------
    scene
        Scene, or a built model.
    until
        End time [s].
    step
        Slab length [s], shortened to divide the duration evenly, and the times between the knots of loads and
        prescribed motions (``control.knots``); ``auto`` is the time in which a wave crosses the
        shortest edge, divided by the square root of 2: there the leading dispersion of a consistent mass and of the end
        peaks cancel (docs/theory/time/time.md).  Without inertia it is the time in which tools and driven supports move
        by a quarter of the shortest edge, at most a twentieth of the duration.
    weight
        Virtual time function.
    method
        Fixed point, Newton, or explicit method.
    state
        Initial state: a state, or the march state of another march after a step, ``step.march_state``; by default the
        start of the scene.
    control
        Limits of a slab; a slab that exceeds them is tried again with half the length.
    tolerance
        Error of the mean velocity of a node in a slab, relative to the greatest velocity so far, up to which slabs grow
        beyond ``step``: to two, four, ... ``control.longest`` lengths, in smooth motion without events
        (docs/theory/time/control.md).  None for slabs of the length ``step``.
    cancel
        Callback at every iteration, from the first equilibrium on, that may cancel the march.
    trying
        Callback with a :class:`~softway.march.results.trying.Trying` after every iteration in a slab.

    Raises
    ------
    InputError
        Before the first step: if the step is beyond the stability limit, a body starts inside an obstacle, or nothing
        estimates the error of a slab that a tolerance asks for.
    NumericsError
        If a slab fails at every attempted length; earlier steps stay valid.
    Cancelled
        If ``cancel`` requests it; earlier steps stay valid.

    Examples
    --------
    >>> import softway as sw
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=2), material=sw.LinearElastic(E=1.0), density=1.0,
    ...                velocity=sw.bodies.Uniform(value=1.0))
    >>> wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.25, normal=-1.0))
    >>> scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    >>> steps = list(march(scene, until=4.0, step=0.05))
    >>> abs(steps[-1].ledger.energy_error) < 1e-12
    True
    """
    model = scene if isinstance(scene, Model) else build(scene)
    settings = Settings(until=until, step=step, weight=weight, method=method, control=control, tolerance=tolerance)
    prepared = prepare(model, settings, state, cancel, trying)
    return _steps(prepared.stepper, prepared.march_state)


def _steps(stepper: Stepper, march_state: MarchState) -> Iterator[Step]:
    model, settings, span = stepper.model, march_state.settings, march_state.step_history.span
    until, memory, before = settings.until, march_state.memory, split_states(model, march_state.state)
    cells = crushing(model, stepper.method)
    while march_state.state.time < until - 1e-9 * span:
        length = slab_length(stepper.ends, march_state)
        require_progress(stepper, march_state, length)
        found = accept_slab(stepper, march_state, length, memory)
        if memory.choice is None and found.memory.choice is not None:
            log.info("operator %s: %s", found.memory.choice.operator, found.memory.choice.reason)
        following, smooth = _next(model, march_state, found)
        if cells.edges:
            following = min(following, span * cells.shortest_ratio(found.after.start.displacement))
        march_state = MarchState(
            settings=settings,
            state=found.after,
            account=update_account(march_state.account, found.ledger),
            step_history=StepHistory(
                span=span,
                length=following,
                energy_along_motion=found.energy_along_motion,
                halted=found.halted,
                recent_rejections=recent_rejections(
                    march_state.step_history,
                    found.slab.span,
                    len(found.rejections),
                    (until - found.after.time) / found.slab.span,
                ),
                last_rejection=[march_state.step_history.last_rejection, *found.rejections][-1],
                smooth=smooth,
                fastest=_fastest(model, march_state, found),
            ),
            memory=found.memory.bare(),
            slabs=march_state.slabs + 1,
        )
        step = _step(model, before, found, march_state)
        log.debug("slab %d to t = %.6g s: %d iterations", march_state.slabs, found.after.time, found.out.iterations)
        yield step
        before, memory = step.after, found.memory


def _fastest(model: Model, march_state: MarchState, found: AcceptedSlab) -> float:
    """Greatest velocity so far [m/s]; zero without a tolerance."""
    history = march_state.step_history
    return 0.0 if march_state.settings.tolerance is None else fastest(model, history, march_state.state, found.after)


def _next(model: Model, march_state: MarchState, found: AcceptedSlab) -> tuple[float, int]:
    """Length of the next slab, and the number of successive smooth slabs of this length under a tolerance."""
    settings, history, now = march_state.settings, march_state.step_history, march_state.state
    control, span, length = settings.control, history.span, found.slab.span
    if found.halted:
        return span * float(np.sqrt(0.5)), 0
    if found.slab.weight == DAMPED:
        return span, 0
    end = found.out.solution.end
    strained = (
        model.inert
        and ((np.abs(end.scalar) > control.scalar) & (end.missing_work > SLIGHT)).any()
        and not found.out.events
    )
    if strained and length > STRAINED * span:
        log.info("next slab after t = %.6g s halved: large scalar of the energy balance", found.after.time)
        return 0.5 * length, 0
    if on_ladder(settings, history, length):
        quality = Quality.of(model, history, now, found.slab, found.after)
        return next_rung(settings, history, length, quality, bool(found.rejections or found.out.events))
    if found.rejections or length >= span:
        return min(span, length), 0
    return (min(span, 2.0 * length) if may_grow(model, control, length, now, found.after) else length), 0


def _step(model: Model, before: State, found: AcceptedSlab, march_state: MarchState) -> Step:
    out = found.out
    names = [p.name for p in model.parts]
    return Step(
        before=before,
        after=split_states(model, found.after),
        slab=found.slab,
        ledger=found.ledger,
        certificate=found.certificate,
        events=out.events,
        reactions=model.split(out.support),
        report=Report(
            iterations=out.iterations,
            pairs=out.pairs,
            factorisations=found.memory.factorisations,
            renewals=found.memory.renewals,
            passes=out.passes,
            contraction=out.solution.contraction,
            rejections=found.rejections,
            scalars=dict(zip(names, out.solution.end.scalar.tolist(), strict=True)),
        ),
        march_state=march_state,
    )
