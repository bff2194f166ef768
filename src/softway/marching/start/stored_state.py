"""Check of a stored march state against the model that it is to continue."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import MaterialStates
from softway.contact.contact_rows import ContactRows
from softway.errors import InputError, within
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.equations.slab_values import SlabStart
from softway.solve.operators.operator_memory import OperatorMemory, OperatorOrigin

REMEDY = "a checkpoint of this run"


def require_of_model(model: Model, pattern: ModelState, found: MarchState) -> None:
    """Refuse a march state that is not one of this model: kernels do not check the numbers in arrays.

    Parameters
    ----------
    model
        Model of the run.
    pattern
        State of the model at its start; the stored state must have arrays of the same sizes.
    found
        State to check.

    Raises
    ------
    InputError
        With the array or number that does not fit.
    """
    found.fitting(model)
    with within("state"):
        _start(pattern.start, found.state.start)
        for name in ("acceleration", "closed", "pressure", "traction", "sliding", "rigid"):
            with within(name):
                _alike(getattr(pattern, name), getattr(found.state, name))
        if found.state.slip is not None:
            with within("slip"):
                _array(found.state.slip, pattern.traction.shape)
        _require(found.state.span >= 0.0, f"a slab of {found.state.span:g} s")
        if found.state.rows is not None:
            _rows(model, found.state.rows)
    with within("memory"):
        _memory(model, pattern.start, found.memory)


def _start(pattern: SlabStart, found: SlabStart) -> None:
    """Refuse values at the start of a slab of other sizes; a viscous force may have begun since the pattern."""
    for f in fields(SlabStart):
        with within(f.name):
            if f.name == "viscous" and found.viscous is not None:
                _alike(pattern.displacement, found.viscous)
            elif f.name == "states":
                _states(pattern.states, found.states)
            elif f.name != "viscous":
                _alike(getattr(pattern, f.name), getattr(found, f.name))


def _states(pattern: MaterialStates, found: MaterialStates) -> None:
    """Refuse history variables of other materials; without any, they may be left out."""
    count = max(len(pattern), len(found))
    _alike(pattern or (None,) * count, found or (None,) * count)


def _alike(pattern: Any, found: Any) -> None:
    """Refuse another class, other names, another size of an array, or numbers that are not finite."""
    if isinstance(pattern, np.ndarray):
        _array(found, pattern.shape)
    elif pattern is None or found is None:
        _require(pattern is found, "missing" if found is None else "too much")
    elif isinstance(pattern, tuple):
        _require(len(found) == len(pattern), f"{len(found)} for {len(pattern)}")
        for one, other in zip(pattern, found, strict=True):
            _alike(one, other)
    elif isinstance(pattern, Mapping):
        _require(found.keys() == pattern.keys(), f"{', '.join(found)} for {', '.join(pattern)}")
        for name, one in pattern.items():
            _alike(one, found[name])
    elif is_dataclass(pattern):
        for f in fields(pattern):
            with within(f.name):
                if f.name != "viscous":
                    _alike(getattr(pattern, f.name), getattr(found, f.name))
                elif found.viscous is not None:
                    _array(found.viscous, found.stress.shape)


def _array(found: Array, shape: tuple[int, ...]) -> None:
    _require(found.shape == shape, f"shape {found.shape} for {shape}")
    _require(bool(np.isfinite(found).all()), "numbers that are not finite")


def _numbers(found: IntArray, count: int) -> None:
    """Refuse numbers of things of which there are ``count``."""
    _require(bool(((found >= 0) & (found < count)).all()), f"numbers that are not below {count}")


def _rows(model: Model, rows: ContactRows) -> None:
    """Refuse contact rows of other nodes, contacts or sizes."""
    (n, d), m = model.shape, len(model.contacts.node)
    with within("rows"):
        _require(rows.node.shape == rows.contact.shape == rows.offset.shape == (m,), f"{len(rows.node)} for {m}")
        _numbers(rows.node, n)
        _numbers(rows.contact, len(model.contacts.labels))
        _require(rows.labels == model.contacts.labels, f"contacts {', '.join(rows.labels)}")
        _array(rows.normal, (m, d))
        _array(rows.tool_motion, (m,))
        _array(rows.shear.moved, (m, d))
        _array(rows.shear.tangents, (m, rows.shear.tangents.shape[1], d))
        for matrix in (rows.gradient, rows.shear.weights):
            _array(matrix.data, matrix.data.shape)
        sizes = rows.gradient.shape, rows.shear.weights.shape
        _require(sizes == ((m, n * d), (m, n)), f"matrices {sizes}")


def _memory(model: Model, start: SlabStart, memory: OperatorMemory) -> None:
    """Refuse a memory of an operator of another model."""
    count = model.shape[0] * model.shape[1]
    for origin in (memory.origin, None if memory.skin is None else memory.skin.origin):
        if origin is not None:
            _origin(start, origin)
    for batch in memory.batches:
        _require(batch.ndim == 1, "a batch that is no list")
        _numbers(batch, count + len(model.contacts.node) * model.shape[1])
    if memory.near is not None:
        _require(memory.near.nodes.ndim == 1, "nodes that are no list")
        _numbers(memory.near.nodes, model.shape[0])


def _origin(start: SlabStart, origin: OperatorOrigin) -> None:
    with within("origin"):
        _array(origin.at, start.displacement.shape)
        _states(start.states, origin.states)
        _require(origin.span >= 0.0, f"a slab of {origin.span:g} s")


def _require(right: bool, problem: str) -> None:
    if not right:
        raise InputError("", problem, REMEDY)
