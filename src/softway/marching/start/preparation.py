"""Preparation of a march: contact rule, initial state and slab length, without a slab."""

from dataclasses import dataclass, replace

from softway.errors import Cancel, within
from softway.marching.audit.ledger import initial_ledger, open_account
from softway.marching.results.trying import TryWatch
from softway.marching.slab.slab_step import Stepper, stepper
from softway.marching.start.initial_state import initial_state
from softway.marching.start.knots import slab_ends
from softway.marching.start.ladder import rungs, slowest
from softway.marching.start.on_device import placed
from softway.marching.start.slab_length import proposed
from softway.marching.state.march_state import MarchState, Settings, StepHistory
from softway.marching.state.model_state import join_states
from softway.model.model import Model
from softway.model.scene import State
from softway.solve.methods.central_difference import Explicit
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.stable_step import require_stable, require_stable_weight


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Preparation:
    """All that a march needs for its next slab: the model with its contact rule, and the march state."""

    stepper: Stepper
    march_state: MarchState


def prepare(
    model: Model,
    settings: Settings,
    state: State | MarchState | None = None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Preparation:
    """Prepare a march of a model: everything that is refused before the first slab is refused here.

    Parameters are those of :func:`~softway.marching.march.march`.

    Raises
    ------
    InputError
        If the contact rule does not fit, an operator or a device is missing, the step is beyond the stability limit, a
        body starts inside an obstacle, or the state belongs to another scene.
    NumericsError
        If there is no static equilibrium at the start.
    Cancelled
        If ``cancel`` requests it at an iteration of an equilibrium.
    """
    method, weight = settings.method, settings.weight
    if not isinstance(method, Explicit) and method.operator != "auto":
        with within("solver.operator"):
            method.operator.require(model)
    model = placed(model, method)
    prepared, stepping = (
        stepper(model, method, weight, cancel, trying),
        method if isinstance(method, Explicit) else weight,
    )
    require_stable_weight(stepping)
    march_state = _begun(model, settings, state, cancel, trying)
    if not march_state.slabs and not (isinstance(stepping, Explicit) and settings.step == "auto"):  # auto is stable
        require_stable(model, march_state.state.start.displacement, stepping, march_state.step_history.span)
    ends = slab_ends(model, settings, march_state.step_history.span)
    return Preparation(stepper=replace(prepared, ends=ends), march_state=march_state)


def _begun(
    model: Model,
    settings: Settings,
    state: State | MarchState | None,
    cancel: Cancel | None,
    trying: TryWatch | None,
) -> MarchState:
    """March state at the start of a march."""
    if isinstance(state, MarchState) and state.settings == settings:
        return state.fitting(model)
    past = 0.0 if state is None else state.state.time if isinstance(state, MarchState) else state.time
    span = proposed(model, settings.step, settings.weight, settings.until - past, settings.method)
    slow = 0.0 if settings.tolerance is None else slowest(model)
    history, memory = StepHistory(span=span, length=span, fastest=slow), OperatorMemory(room=rungs(settings))
    if isinstance(state, MarchState):
        return state.fitting(model).asked(settings, history, memory)
    now = initial_state(model, span, cancel, trying) if state is None else join_states(model, state, span)
    return MarchState(
        settings=settings,
        state=now,
        account=open_account(initial_ledger(model, now)),
        step_history=history,
        memory=memory,
    )
