"""Scene, slab (time step) and virtual time functions, and the model of a scene as arrays."""

from softway.model.build import with_dofs as with_dofs
from softway.model.build import with_field as with_field
from softway.model.scene import AsGiven as AsGiven
from softway.model.scene import Scene as Scene
from softway.model.scene import State as State
from softway.model.scene import StaticStart as StaticStart
from softway.model.time_weight import Collocation as Collocation
from softway.model.time_weight import EndPeaks as EndPeaks
from softway.model.time_weight import Momentum as Momentum

__all__ = [
    "AsGiven",
    "Collocation",
    "EndPeaks",
    "Momentum",
    "Scene",
    "State",
    "StaticStart",
    "with_dofs",
    "with_field",
]
