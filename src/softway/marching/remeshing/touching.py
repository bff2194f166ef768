"""Nodes at which contacts are closed or close soon, and where loads change: they need fine cells."""

import numpy as np

from softway.adaptivity.marking.neighbourhood import Mark
from softway.arrays import Array, IntArray
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.loads import Traction
from softway.marching.remeshing.standing import standing
from softway.marching.state.march_state import MarchState
from softway.marching.state.step_control import SMALL_STRAIN
from softway.meshes.adaptive.leaves import DEPTH
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.model.model import Model

SLACK = 1e-6
"""Halvings by which a wanted number may fall short of a whole one."""


def touched(model: Model, now: MarchState, ahead: float) -> IntArray:
    """Nodes (k,) of contact rows that are closed, or would close within ``ahead`` [s] at the present velocities, with
    those of the facets in them.
    """
    start, state, model = now.state.start, now.state, standing(model, now.state)
    coming = start.displacement + ahead * start.velocity
    here, later = model.rows(start.displacement, state.time), model.rows(coming, state.time + ahead)
    closing = later.near & (later.gap(coming) <= 0.0)
    chosen = ((here, state.closed), (later, closing), (here, closing))
    nodes = [rows.gradient[which].indices // model.shape[1] for rows, which in chosen]
    return np.unique(np.concatenate(nodes))


def least_gaps(model: Model, now: MarchState, ahead: float) -> Array:
    """Least gap (n,) at each node in contact rows, now and after ``ahead`` [s] at the present velocities [m]; infinite
    elsewhere.
    """
    start, state, model = now.state.start, now.state, standing(model, now.state)
    out = np.full(model.shape[0], np.inf)
    coming = start.displacement + ahead * start.velocity
    for u, time in ((start.displacement, state.time), (coming, state.time + ahead)):
        rows = model.rows(u, time)
        near = rows.near
        entries = rows.gradient[near].tocoo()
        np.minimum.at(out, entries.col // model.shape[1], rows.gap(u)[near][entries.row])
    return out


def closing(model: Model, now: MarchState) -> Array:
    """Way (n,) that each node goes towards others in its contact rows in a slab of the requested length at the present
    velocities, relative to the greatest approach that is allowed, in edges, to its cells [m]; zero elsewhere.
    """
    start, span, time = now.state.start, now.step_history.span, now.state.time
    still, limit = standing(model, now.state), now.settings.control.approach
    coming = start.displacement + span * start.velocity
    here, later = still.rows(start.displacement, time), still.rows(coming, time + span)
    near, both = here.near, (here.near & later.near)[here.near]
    before, after = here.gap(start.displacement)[near], here.gap(coming)[near]
    after[both] = np.minimum(after[both], later.gap(coming)[near][both])
    motion = np.linalg.norm(span * start.velocity, axis=1)
    most = here.travel(motion, float(motion.max(initial=0.0)))[near]  # a facet goes on beyond its edges
    crushable = np.array([not part.internal.linear for part in model.parts])[model.part_of]
    out = np.zeros(model.shape[0])
    np.maximum.at(out, here.node[near], np.minimum(before - after, most))
    return out / np.where(crushable, limit, max(limit, SMALL_STRAIN))


def bulging(mesh: AdaptedMesh, gaps: Array) -> list[Mark]:
    """Levels around the nodes with ``gaps`` (n,) [m] that the curved surface may close before its nodes do.

    The surface stands off the facets of a base cell by at most its bulge b, and by a quarter of it where edges are
    halved.  Halved k times it stands off by ``4^-k b``, which is to be less than half the gap.
    """
    rounding, d = mesh.base.rounding, mesh.mesh.cell_dim
    assert rounding is not None
    bulge = np.zeros(mesh.mesh.n_nodes)
    nodes = next(iter(mesh.mesh.blocks.values()))
    np.maximum.at(bulge, nodes, rounding.bulge[mesh.leaves.root][:, None])
    near = np.flatnonzero((gaps < 2.0 * bulge) & (bulge > 0.0))
    ratio = 2.0 * bulge[near] / np.maximum(gaps[near], np.finfo(float).tiny)
    halvings = np.minimum(np.ceil(0.5 * np.log2(ratio) - SLACK), DEPTH // d).astype(np.int64)
    return [(int(d * k), mesh.flat[near[halvings == k]]) for k in np.unique(halvings[halvings > 0])]


def pushed(model: Model, time: float, ahead: float) -> IntArray:
    """Nodes (k,) of tractions that change within ``ahead`` [s]; of all of them at the start, where they are sudden."""
    parts, found = {part.name: part for part in model.parts}, [np.zeros(0, dtype=np.int64)]
    for load in model.scene.loads:
        if isinstance(load, Traction) and (time <= 0.0 or changes(load.ramp, time, time + ahead)):
            part = parts[load.body]
            found.append(part.nodes.start + part.mesh.nodes(load.tag))
    return np.concatenate(found)


def changes(ramp: Ramp, start: float, end: float) -> bool:
    """True if a factor of a load changes between two times."""
    inner = (time for time in ramp.times if start < time < end)
    return len({ramp.at(time) for time in (start, *inner, end)}) > 1
