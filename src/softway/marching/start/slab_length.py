"""Slab length: the requested one, or one from the crossing time of waves or the prescribed motion, evenly divided."""

from math import hypot
from typing import Literal

import numpy as np

from softway.bodies.discretised import DiscreteSolid
from softway.bodies.prescribed_motion import Motion, Sliding, Swinging, Table, Translation, Turning, carried_tool
from softway.bodies.solid import Solid, Tool
from softway.errors import InputError
from softway.marching.rules.slab_rule import Method
from softway.meshes.adaptive.adapt import adaption
from softway.model.model import Model
from softway.model.time_weight import TimeWeight
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.stable_step import stable_step
from softway.units import Second

SLABS = 20
"""Least number of slabs without inertia: loads and materials may change with time although nothing is moved."""
SHORTEST = 1e-50
"""Shortest duration and slab [s]: the squares of shorter ones are no numbers."""
QUICK = 1e-3
"""Angle of a turning tool by which its speed is measured [rad]."""
QUARTER = 0.25
"""Greatest prescribed motion in a slab without inertia, in shortest edges: the admissible approach of two surfaces."""


def proposed(
    model: Model,
    step: Second | Literal["auto"],
    weight: TimeWeight,
    duration: float,
    method: Method = FixedPoint(),
) -> float:
    """Slab length [s]: the requested one, or the crossing time of the shortest edge over sqrt(2), evenly divided.

    Central differences use a fraction of their stability limit.  Without inertia there are no waves: tools and driven
    supports move by at most a quarter of the shortest edge in a slab, and there are at least ``SLABS`` slabs.

    Raises
    ------
    InputError
        If the duration or the step is not positive, or too short to be squared.
    """
    if not duration >= SHORTEST:
        raise InputError("time.end", f"the march would last {duration:g} s", "an end after the start")
    if step != "auto":
        if not SHORTEST <= step < np.inf:
            raise InputError("time.step", f"{step:g} s", f"a time of at least {SHORTEST:g} s, or 'auto'")
        return evenly(duration, step)
    if not model.inert:
        return evenly(duration, min(duration / SLABS, QUARTER * _edge(model) / max(prescribed_speed(model), 1e-300)))
    if isinstance(method, Explicit):
        stable = method.safety * stable_step(model, model.displacement, method)
        return evenly(duration, stable if np.isfinite(stable) else _crossing(model))
    bound = 0.9 * stable_step(model, model.displacement, weight)
    return evenly(duration, min(_crossing(model), bound))


def _edge(model: Model) -> float:
    """Shortest edge of all solids [m]."""
    return min(finest_edge(model, p) for p in model.parts)


def finest_edge(model: Model, part: DiscreteSolid) -> float:
    """Shortest edge of a solid, of its finest cells if its mesh adapts [m]."""
    solid = model.scene.bodies[part.name]
    how = adaption(solid.adapt) if isinstance(solid, Solid) else None
    if how is None:
        return part.mesh.edge()
    found = model.adapted.get(part.name)
    return how.finest(part.mesh if found is None else found.base)


def _crossing(model: Model) -> float:
    """Time in which the fastest wave crosses the shortest edge of its solid, over sqrt(2) [s]."""
    return float(min(finest_edge(model, p) / model.wave_speed(p) for p in model.parts) / np.sqrt(2.0))


def prescribed_speed(model: Model) -> float:
    """Greatest speed of tools, where the solids are, and of driven supports [m/s]."""
    tools = [_tool_speed(model, b.motion) for b in model.scene.bodies.values() if isinstance(b, Tool)]
    return max([0.0, *tools, *(support.greatest_speed for support, _ in model.driven)])


def _tool_speed(model: Model, motion: Motion) -> float:
    """Greatest speed of a tool, at the nodes if it turns [m/s]."""
    match motion:
        case Translation():
            return hypot(*np.atleast_1d(motion.velocity))
        case Table():
            moved = np.diff(np.reshape(motion.displacements, (len(motion.times), -1)), axis=0)
            return float((np.linalg.norm(moved, axis=1) / np.diff(motion.times)).max(initial=0.0))
        case Sliding():
            return motion.travel.greatest_rate
        case Turning():
            return _turning_speed(model, motion, abs(motion.rate))
        case Swinging():
            turning = Turning(point=motion.point, axis=motion.axis, rate=1.0)
            return _turning_speed(model, turning, motion.angle.greatest_rate)
        case _:
            return 0.0


def _turning_speed(model: Model, motion: Turning, rate: float) -> float:
    """Greatest speed at the nodes of a tool that turns about the axis of a motion at another ``rate`` [m/s]."""
    arms = carried_tool(motion, 0.0, QUICK / max(abs(motion.rate), 1e-300), model.points)
    return model.space.greatest(np.linalg.norm(arms, axis=1)) * rate / QUICK


def evenly(duration: float, step: float) -> float:
    """Greatest length up to ``step`` that divides the duration evenly; equal slabs share one operator.

    Examples
    --------
    >>> evenly(1.0, 0.3), evenly(1.0, float("inf"))
    (0.25, 1.0)
    """
    return float(duration / np.ceil(duration / min(step, duration) - 1e-9))
