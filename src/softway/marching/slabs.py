"""Accepted slabs of a march on the meshes of one model: propose a slab (time step), solve and audit it."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from softway.marching.attempts.accept import accept_slab
from softway.marching.attempts.audited_slab import DAMPED, AcceptedSlab
from softway.marching.attempts.dashpot_slab import lost_equilibrium
from softway.marching.attempts.rejections import recent_rejections, require_progress
from softway.marching.audit.folded_cells import WatchedCells, watched_cells
from softway.marching.audit.ledger import update_account
from softway.marching.results.step import Event, Ledger, Report, Step
from softway.marching.results.step_states import KnownStates
from softway.marching.results.trying import watched
from softway.marching.slab.compiled_model import CompiledModel, compiled_model
from softway.marching.slab.compiled_slabs import next_batch
from softway.marching.slab.resident_model import resident_model
from softway.marching.slab.resident_slabs import next_resident
from softway.marching.slab.slab_batch import SlabBatch
from softway.marching.slab.slab_step import Stepper
from softway.marching.slab.step_group import StepGroup, in_steps
from softway.marching.slab.stored.stored_model import stored_model
from softway.marching.slab.stored.stored_slabs import next_stored
from softway.marching.start.knots import end_after, slab_length
from softway.marching.start.ladder import Quality, fastest, next_rung, on_ladder
from softway.marching.state.march_state import AdaptedMeshes, MarchState, StepHistory
from softway.marching.state.model_state import split_states
from softway.marching.state.step_control import Crushing, above, crushing, may_grow
from softway.model.model import Model
from softway.model.scene import State
from softway.solve.equations.energy_balance import SLIGHT
from softway.solve.linear.blas_threads import one_blas_thread
from softway.solve.operators.operator_memory import OperatorMemory

log = logging.getLogger(__name__)
STRAINED = 0.2
"""Fraction of the requested length below which a large scalar does not shorten slabs further."""


def slabs(stepper: Stepper, march_state: MarchState) -> Iterator[Step]:
    """Accepted slabs from a march state to the end of the march."""
    return in_steps(groups(stepper, march_state), stepper.cancel)


def groups(stepper: Stepper, march_state: MarchState) -> Iterator[Step | StepGroup]:
    """Accepted slabs from a march state to the end of the march; those that are compiled together as a group."""
    model, settings, span = stepper.model, march_state.settings, march_state.step_history.span
    until, memory, before = settings.until, march_state.memory, split_states(model, march_state.state)
    cells, compiled = crushing(model, stepper.method), compiled_model(stepper, settings, span)
    stored = stored_model(stepper, settings, span)
    resident, shapes, alone = resident_model(stepper, settings), watched_cells(model), one_blas_thread()
    while march_state.state.time < until - 1e-9 * span:
        some = None if compiled is None else _batch(stepper, compiled, march_state, before, memory)
        some = some if stored is None else next_stored(stored, march_state, before, memory)
        some = some if resident is None else next_resident(resident, march_state, before, memory)
        if some is not None:
            count = len(some.iterations)
            watched(stepper.trying, march_state.slabs + 1, march_state.state.time, span)
            yield from _looked_at_the_last(shapes, StepGroup.whole(some))
            march_state, memory, before = some.march_state(count), some.memory_after(count), some.state(count)
            continue
        length = slab_length(stepper.ends, march_state)
        require_progress(stepper, march_state, length)
        with alone():
            found = accept_slab(stepper, march_state, length, memory)
        if memory.choice is None and found.memory.choice is not None:
            log.info("operator %s: %s", found.memory.choice.operator, found.memory.choice.reason)
        found, bad = _looked_at(shapes, march_state, found)
        if found.dashpots is not None and not march_state.step_history.dashpots:
            bad = (lost_equilibrium(model, march_state, found.out, found.dashpots), *bad)
        march_state = _after(model, march_state, found, cells)
        log.debug("slab %d to t = %.6g s: %d iterations", march_state.slabs, found.after.time, found.out.iterations)
        yield (step := _step(model, before, found, march_state, bad))
        before, memory = step.after, found.memory


def _batch(
    stepper: Stepper, compiled: CompiledModel, march_state: MarchState, before: State, memory: OperatorMemory
) -> SlabBatch | None:
    """Compiled slabs from a march state on; None if the next one is not."""
    return next_batch(compiled, march_state, before, memory, partial(end_after, stepper.ends, march_state))


def _looked_at(
    shapes: WatchedCells, march_state: MarchState, found: AcceptedSlab
) -> tuple[AcceptedSlab, tuple[Event, ...]]:
    """The slab with the shape of its worst cell in the certificate, and findings on cells that have gone bad in it."""
    certificate = shapes.seen(found.certificate, found.after)
    bad = tuple(shapes.findings(certificate, march_state.state, found.after))
    return replace(found, certificate=certificate), bad


def _looked_at_the_last(shapes: WatchedCells, group: StepGroup) -> Iterator[Step | StepGroup]:
    """The group; where cells may fold and their shapes are not known, its last slab as a step with the shape of the
    worst cell.
    """
    if not shapes.blocks or group.batch.shapes is not None:
        yield group
        return
    if len(group) > 1:
        yield group.part(0, len(group) - 1)
    step, after = group.step(len(group) - 1), group.march_state.state
    certificate = shapes.seen(step.certificate, after)
    bad = tuple(shapes.findings(certificate, group.batch.begun.state, after))
    yield replace(step, certificate=certificate, events=(*step.events, *bad))


def _after(model: Model, march_state: MarchState, found: AcceptedSlab, cells: Crushing) -> MarchState:
    """State of the march after a slab."""
    span, until = march_state.step_history.span, march_state.settings.until
    following, smooth = _next(model, march_state, found)
    if cells.edges:
        following = min(following, span * cells.shortest_ratio(found.after.start.displacement))
    return MarchState(
        settings=march_state.settings,
        state=found.after,
        account=update_account(march_state.account, found.ledger),
        step_history=StepHistory(
            span=span,
            length=following,
            energy_along_motion=found.energy_along_motion,
            halted=found.halted,
            dashpots=found.dashpots is not None,
            recent_rejections=recent_rejections(
                march_state.step_history,
                found.slab.span,
                len(found.rejections),
                (until - found.after.time) / found.slab.span,
            ),
            last_rejection=[march_state.step_history.last_rejection, *found.rejections][-1],
            rejected=len(found.rejections),
            smooth=smooth,
            fastest=_fastest(model, march_state, found),
        ),
        memory=found.memory.bare(),
        slabs=march_state.slabs + 1,
        adapted=_adapted(march_state.adapted, found.ledger),
        remeshed=march_state.remeshed,
    )


def _adapted(meshes: AdaptedMeshes | None, ledger: Ledger) -> AdaptedMeshes | None:
    """Adapted meshes after a slab: the same, with the greatest energy so far."""
    if meshes is None:
        return None
    return replace(meshes, energy=max(meshes.energy, ledger.energy_kinetic + ledger.energy_strain))


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
        return min(span, 2.0 * length), 0
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
    if found.rejections:
        return min(span, length), 0
    if not above(span, length):
        return span, 0
    return (min(span, 2.0 * length) if may_grow(model, control, length, now, found.after) else length), 0


def _step(model: Model, before: State, found: AcceptedSlab, march_state: MarchState, bad: tuple[Event, ...]) -> Step:
    out = found.out
    names = [p.name for p in model.parts]
    return Step(
        model=model,
        slab=found.slab,
        ledger=found.ledger,
        certificate=found.certificate,
        events=(*out.events, *bad) if bad else out.events,
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
        states=KnownStates(
            before=before,
            after=split_states(model, found.after),
            reactions=model.split(out.support),
            march_state=march_state,
        ),
    )
