"""Displacement and velocity of all nodes at the start, from the given fields and the supports."""

from collections.abc import Mapping, Sequence

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import (
    DiscreteSolid,
    Moved,
    initial,
    supported_components,
)
from softway.bodies.setup.directions import directed, directions
from softway.bodies.solid import Fixed, Solid
from softway.errors import InputError
from softway.model.ties import Glue
from softway.tolerances import MOTION


def given_fields(parts: Sequence[DiscreteSolid], solids: Mapping[str, Solid]) -> tuple[Array, Array]:
    """Given initial displacement (n, d) and velocity (n, d) of all nodes."""
    fields = [initial(p, solids[p.name]) for p in parts]
    return np.concatenate([u for u, _ in fields]), np.concatenate([v for _, v in fields])


def at_start(
    parts: Sequence[DiscreteSolid],
    solids: Mapping[str, Solid],
    given: Array,
    driven: Sequence[Moved],
    glue: Glue,
) -> Array:
    """Initial displacement (n, d) from the given one; driven components keep theirs, fixed ones are zero.

    Raises
    ------
    InputError
        If a Fixed support holds a component whose initial displacement is not zero, or a tie a node at which the
        surfaces differ, beyond rounding.
    """
    out = given.copy()
    moved = np.logical_or.reduce([where for _, where in driven], initial=False) | np.zeros(out.shape, bool)
    for part in parts:
        field = given[part.nodes]
        for k, support in enumerate(solids[part.name].supports):
            if not isinstance(support, Fixed):
                continue
            if directed(support):
                _rest_along(out[part.nodes], part, support, f"supports[{k}]")
                continue
            held = supported_components(support, part.mesh) & ~moved[part.nodes]
            wrong = held & (np.abs(field) > MOTION * np.abs(field).max())
            if wrong.any():
                node, axis = (int(i) for i in np.argwhere(wrong)[0])
                value, count = f"{field[node, axis]:.6g} m along {'xyz'[axis]}", int(wrong.any(axis=1).sum())
                problem = f"{value} at node {node}, which supports[{k}] on {support.on!r} holds at zero; {count} in all"
                remedy = f'a field that is zero on {support.on!r}, or a support of kind = "Driven" with velocity = 0'
                raise InputError(f"bodies.{part.name}.displacement", problem, remedy)
            out[part.nodes][held] = 0.0
    return glue.fitting(out, "displacement", parts)


def _rest_along(out: Array, part: DiscreteSolid, support: Fixed, place: str) -> None:
    """Set the displacement (n, d) along the direction of a support to zero, where it is rounding; refuse others."""
    nodes, along = directions(support, part.mesh)
    moved = (out[nodes] * along).sum(axis=1)
    wrong = np.abs(moved) > MOTION * np.abs(out).max()
    if wrong.any():
        k, count = int(np.argmax(wrong)), int(wrong.sum())
        problem = f"{moved[k]:.6g} m at node {nodes[k]} along the direction of {place}, which holds it; {count} in all"
        remedy = f'a field along the sides of {support.on!r}, or a support of kind = "Driven" with velocity = 0'
        raise InputError(f"bodies.{part.name}.displacement", problem, remedy)
    out[nodes] -= moved[:, None] * along
