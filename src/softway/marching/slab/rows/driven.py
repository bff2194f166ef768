"""Loads, tools and supports that change with time, for compiled slabs."""

from dataclasses import replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.prescribed_motion import Sliding, Still, Table, Translation
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import ContactSet, SlabContacts
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.contact.slab_motion.trajectory import bent
from softway.contact.stencils import NoPairs
from softway.kernels.slab.driven import Drives
from softway.model.model import Model
from softway.obstacles.half_space import HalfSpace


def tools_keep_direction(contacts: ContactSet) -> bool:
    """True if all tools are half-spaces that rest or move along."""
    tools = [m.tool for m in contacts.methods if isinstance(m, NodeToTool)]
    kinds = (Still, Translation, Table, Sliding)
    return all(isinstance(t.shape, HalfSpace) and isinstance(t.motion, kinds) for t in tools)


def tool_rows(contacts: ContactSet) -> ContactRows:
    """Rows with tools in their places at t = 0, all others open."""
    if contacts.known_rows is not None:
        return contacts.known_rows
    found = (m.during(0.0, 0.0) if isinstance(m, NodeToTool) else NoPairs(rows=len(m.node)) for m in contacts.methods)
    alone = SlabContacts(contacts=contacts, surfaces=tuple(found), node=contacts.node)
    return alone.at(np.zeros_like(contacts.points))


def supports_move_mass(model: Model) -> bool:
    """True if the supports that move have nodes with inertia only: others do work in the energy balance."""
    return model.space.every(~_moving(model) | model.massive[:, None])


def _moving(model: Model) -> BoolArray:
    """Components (n, d) that supports move."""
    out = np.zeros(model.shape, bool)
    for _, where in model.driven:
        out |= where
    return out


def drives(model: Model, rows: ContactRows, times: Array) -> Drives | None:
    """Loads, motions of tools and velocities of supports for slabs between ``times`` (s + 1,) [s].

    ``rows`` are those at t = 0.  None if everything rests.
    """
    numbers, shear = _tools(model.contacts), rows.shear.tangents
    if model.loads.steady and not numbers and not model.driven:
        return None
    loads = () if model.loads.steady else model.loads.fields
    ramps, instants = [ramp for ramp, _ in loads], times.tolist()
    tool = _of_rows(model.contacts, numbers)
    slabs = list(zip(instants[:-1], instants[1:], strict=True))
    component = np.flatnonzero(_moving(model))
    return Drives(
        field=np.array([field.ravel() for _, field in loads]).reshape(len(loads), model.points.size),
        load_at=np.array([[ramp.at(t) for ramp in ramps] for t in instants]),
        load_mean=np.array([[ramp.mean(*slab) for ramp in ramps] for slab in slabs]),
        tool=np.concatenate([tool, np.repeat(tool, shear.shape[1])]),
        offset=np.concatenate([rows.offset, np.zeros(shear.shape[0] * shear.shape[1])]),
        normal=np.concatenate([rows.normal, shear.reshape(-1, model.shape[1])]),
        shift=_shifts(model, numbers, instants),
        component=component.astype(np.int64),
        rate=np.array([model.prescribed(t).ravel()[component] if model.driven else [] for t in instants]),
        bent=np.array([_bent(model, slab, component) if model.driven else [] for slab in slabs]),
    )


def _shifts(model: Model, numbers: list[int], times: list[float]) -> Array:
    """Displacements (s + 1, tools, d) of tools since t = 0 [m]."""
    methods = model.contacts.methods
    out = np.zeros((len(times), len(numbers), model.shape[1]))
    for k, number in enumerate(numbers):
        motion = methods[number].tool.motion  # type: ignore[union-attr]
        first = motion.at(0.0).shift
        for s, time in enumerate(times):
            out[s, k] = motion.at(time).shift - first
    return out


def _bent(model: Model, slab: tuple[float, float], component: IntArray) -> Array:
    """Ways (j,) of supports in a slab beyond those of linear velocities [m]."""
    bends = model.bends(*slab)
    if not bends:
        return np.zeros(len(component))
    return np.asarray(bent(bends, slab[1] - slab[0])).ravel()[component]


def rows_at(model: Model, rows: ContactRows, time: float) -> ContactRows:
    """Rows at a time [s] of ``rows`` at t = 0."""
    numbers = _tools(model.contacts)
    if not numbers:
        return rows
    tool, shift = _of_rows(model.contacts, numbers), _shifts(model, numbers, [time])[0]
    moved = np.where(tool >= 0, np.einsum("mi,mi->m", rows.normal, shift[tool]), 0.0)
    return replace(rows, offset=rows.offset - moved)


def tool_motion(model: Model, times: tuple[float, float]) -> Array:
    """Motion (m, d) of the tool of each row between two times [m]."""
    numbers = _tools(model.contacts)
    if not numbers:
        return np.zeros((len(model.contacts.node), model.shape[1]))
    tool, (first, last) = _of_rows(model.contacts, numbers), _shifts(model, numbers, list(times))
    return np.asarray(np.where((tool >= 0)[:, None], (last - first)[tool], 0.0))


def _tools(contacts: ContactSet) -> list[int]:
    """Numbers of the methods with tools that move."""
    found = enumerate(contacts.methods)
    return [k for k, m in found if isinstance(m, NodeToTool) and not isinstance(m.tool.motion, Still)]


def _of_rows(contacts: ContactSet, numbers: list[int]) -> IntArray:
    """Number of the moving tool of each row (m,), -1 for the others."""
    each = [
        np.full(len(m.node), numbers.index(k) if k in numbers else -1, np.int64) for k, m in enumerate(contacts.methods)
    ]
    return np.concatenate([np.zeros(0, np.int64), *each])
