"""Slabs (time steps) in which massless nodes have no equilibrium: dashpots act until they find another one."""

from dataclasses import replace

import numpy as np

from softway.bodies.assembled.dashpots import Dashpots
from softway.bodies.assembled.vector_space import LocalSpace
from softway.marching.results.finding import NO_EQUILIBRIUM, finding
from softway.marching.results.slab_result import SlabResult
from softway.marching.results.step import Event
from softway.marching.rules.equilibrated import Equilibrated
from softway.marching.slab.slab_step import Stepper
from softway.marching.state.march_state import MarchState
from softway.model.model import Model
from softway.solve.operators.operator_memory import OperatorMemory

SHORT = 1e-4
"""Fraction of the requested length below which slabs that fail are tried with dashpots: the equilibrium of massless
nodes that is lost at a limit point is there in no slab, however short."""
FELT = 0.01
"""Force of dashpots on a solid, relative to the greatest one, above which a finding names it."""


def dashpots_serve(stepper: Stepper) -> bool:
    """True if the rule of a march has massless nodes in equilibrium, and all nodes are on this rank.

    The heat of dashpots has no place in companion fields: models with them have no dashpots.
    """
    model = stepper.model
    alone = isinstance(model.space, LocalSpace) and not model.companions
    return alone and model.inert and isinstance(stepper.rule, Equilibrated) and not model.space.every(model.massive)


def dashpots(model: Model, march_state: MarchState) -> Dashpots:
    """Dashpots in a slab: within the requested length they resist as the stiffness does."""
    start, span = march_state.state.start, march_state.step_history.span
    blocks = model.during(start.states, span).tangent_blocks(start.displacement)
    return Dashpots.of(model.parts, model.massive, model.points + start.displacement, blocks, span)


def without_operator(memory: OperatorMemory) -> OperatorMemory:
    """Memory that has only the choice of its operator."""
    return replace(memory.failed(), frozen=None, origin=None, analysis=None, turning=None)


def lost_equilibrium(model: Model, march_state: MarchState, out: SlabResult, acting: Dashpots) -> Event:
    """Finding on the first slab with dashpots: which solids feel them, and where most.

    Parameters
    ----------
    model, march_state
        Model, and the state before the slab.
    out, acting
        The solved slab and its dashpots.
    """
    now, end = march_state.state, out.solution.end.displacement
    moved, span = end - now.start.displacement, out.system.path.span
    size = np.where(model.massive, 0.0, np.linalg.norm(acting.force(moved, span), axis=1))
    node = int(size.argmax())
    felt = [p for p in model.parts if size[p.nodes].max(initial=0.0) >= FELT * size[node]]
    part = model.parts[model.part_of[node]]
    names = " and ".join(f"'{p.name}'" for p in felt)
    text = (
        f"massless contact nodes of {names} lose their equilibrium, most at node {node - part.nodes.start} of "
        f"'{part.name}': until they find another one, dashpots between them and the nodes of their cells act, and "
        "their work is dissipated. Remedy: a finer mesh, where cells are crushed"
    )
    concerned = (part.name, *(p.name for p in felt if p is not part))
    place = model.points[node] + end[node]
    return finding(now.time, NO_EQUILIBRIUM, concerned, text, node=node - part.nodes.start, place=place)
