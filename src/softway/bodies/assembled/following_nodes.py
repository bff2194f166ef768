"""Nodes that follow others: their part of prescribed motions, and the forces that they hand on."""

from collections.abc import Sequence

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import DofMap


def driven_field(parts: Sequence[DiscreteSolid], dofs: DofMap, given: Array) -> Array:
    """Prescribed field (n, d), ``given`` on driven components, with that of the nodes that hang between them."""
    return given if all(part.mesh.hanging is None for part in parts) else dofs.supported(given)


def reactions(dofs: DofMap, force: Array) -> Array:
    """Part (n, d) of forces (n, d), gathered on the nodes that others follow, which supports carry [N].

    Examples
    --------
    >>> from softway.bodies.dof_map import NodalDofs
    >>> reactions(NodalDofs(np.array([[True], [False]])), np.array([[1.0], [2.0]])).ravel().tolist()
    [0.0, 2.0]
    """
    gathered = dofs.gathered(force)
    handed_on = ~gathered.any(axis=1, keepdims=True)  # the supported part of a field has a share at hanging nodes
    return np.where(handed_on, 0.0, dofs.supported(gathered))
