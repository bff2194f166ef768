"""Model at one instant: rigid bodies where they are."""

import numpy as np

from softway.marching.state.model_state import ModelState
from softway.model.model import Model


def standing(model: Model, now: ModelState) -> Model:
    """Model whose rigid bodies are at their places in a state."""
    if model.rigid is None or now.rigid is None:
        return model
    still = np.zeros((len(now.rigid.place), 6))
    return model.with_motions(model.rigid.motions(now.rigid, still, now.time, now.time))
