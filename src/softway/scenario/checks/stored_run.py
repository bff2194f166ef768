"""Checkpoints of a stopped run, checked against its scenario."""

from functools import partial
from pathlib import Path

from softway.errors import InputError
from softway.marching.remeshing.adapted_scene import adapted_scene
from softway.marching.remeshing.forming.formed_scene import formed_scene
from softway.marching.start.initial_state import without_contact
from softway.marching.start.stored_state import require_of_model
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState, join_states, split_states
from softway.model.model import Model
from softway.record.storage.checkpoint import Checkpoint, last
from softway.scenario.checks.check import Checked


def last_checkpoint(folder: Path, checked: Checked) -> Checkpoint | None:
    """Last readable checkpoint of a run that is one of its scenario; None without."""
    pattern = join_states(checked.model, split_states(checked.model, checked.march_state.state))
    return last(folder, partial(_require_state, checked.model, pattern))


def _require_state(model: Model, pattern: ModelState, state: object) -> None:
    """Refuse a state that is not one of this model."""
    if not isinstance(state, MarchState):
        raise InputError("state", f"is a {type(state).__name__}", "a checkpoint of this run")
    if state.adapted is not None:
        model = adapted_scene(model).at(state.adapted.leaves).model
    if state.remeshed is not None:
        model = formed_scene(model).at(state.remeshed.meshes).model
    if state.adapted is not None or state.remeshed is not None:
        pattern = without_contact(model)
    require_of_model(model, pattern, state)
