"""State of a march on new meshes of the present shapes."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.adaptivity.unrelated.fields import interpolation
from softway.adaptivity.unrelated.memory import recast_memory
from softway.adaptivity.unrelated.motion import moved_on
from softway.arrays import Array, IntArray
from softway.marching.remeshing.carried.settling import Unsettled
from softway.marching.remeshing.carried.surface_forces import SurfaceForces, surface_forces
from softway.marching.remeshing.carried_heat import heat_of, starting_at, with_digits
from softway.marching.remeshing.forming.closing import closed, dissipated, heavy
from softway.marching.remeshing.forming.expansion import adiabatic, relieved, whole_stress
from softway.marching.remeshing.forming.formed_scene import FormedScene
from softway.marching.remeshing.forming.heat import heat_on, warmed_state
from softway.marching.results.exchange import Exchange
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState, join_states, split_states
from softway.model.model import Model
from softway.model.scene import State
from softway.solve.operators.operator_memory import OperatorMemory

CLOSED = 1e-10
"""Gap, relative to the extent of the scene, up to which a contact row starts closed."""


def carried_on(
    old: FormedScene, new: FormedScene, now: MarchState, reasons: Mapping[str, str]
) -> tuple[MarchState, Mapping[str, Exchange]]:
    """State of a march on the new meshes of some solids, and what they have changed.

    Memory passes by means over the overlap of the cells, velocities by projection; contact rows are found afresh, with
    forces that balance the stress.  The balances are closed in this equilibrium.
    """
    relief = relieved(old.model, now.state, reasons)
    carried = _Carried(old=old, new=new, now=now, changed=reasons)
    warmth = heat_on((old.model, new.model), now.state, reasons)
    joined = carried.joined(warmth)
    shifted = adiabatic(new.model, warmth, relief, joined)
    joined = joined if shifted is None else carried.joined(shifted)
    lost = dissipated(new.model, joined) - dissipated(old.model, now.state)
    joined, taken = closed(old, new, now.state, joined, lost + relief.energy, list(reasons))
    numbers = {p.name: k for k, p in enumerate(new.model.parts)}
    exchanges = {n: _exchange(old, new, now, n, reason, float(taken[numbers[n]])) for n, reason in reasons.items()}
    account = replace(now.account, remeshing=now.account.remeshing + float(taken.sum()))
    account = relief.booked(account, heat_of(new.model, joined), float(lost.sum()))
    assert now.remeshed is not None
    failed = {name: quality for name, quality in now.remeshed.failed.items() if name not in reasons}
    remeshed = replace(now.remeshed, meshes=new.meshes, changed=now.slabs, failed=failed)
    memory = OperatorMemory(room=now.memory.room)
    return replace(now, state=joined, account=account, memory=memory, remeshed=remeshed), exchanges


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Carried:
    """State of a march that passes to the new meshes of the solids that have ``changed``."""

    old: FormedScene
    new: FormedScene
    now: MarchState
    changed: Collection[str]

    def joined(self, warmth: Array | None) -> ModelState:
        """State on the new meshes with the unknowns (k + r,) of its heat, before the balances are closed."""
        old, new, now, changed = self.old, self.new, self.now.state, self.changed
        state = whole_stress(old.model, now, split_states(old.model, now), changed)
        state = warmed_state(new.model, _recast(old, new, state, changed), warmth, changed)
        surface = _surface(old, new, now, changed)
        if new.model.inert and not new.model.space.every(new.model.massive):
            joined = _settled(new.model, state, surface, self.now.step_history.span)
        else:
            joined = _in_contact(old.model, new.model, now, state, surface)
        return with_digits(new.model, joined, warmth)


def _recast(old: FormedScene, new: FormedScene, state: State, changed: Collection[str]) -> State:
    """State with the memory, the velocities and the accelerations of solids on their new meshes."""
    memories, displacement = dict(state.memory), dict(state.displacement)
    velocity, acceleration = dict(state.velocity), dict(state.acceleration)
    for name in changed:
        before, after = old.part(name), new.part(name)
        u = state.displacement[name]
        memories[name] = recast_memory(before, u, after, state.memory[name])
        displacement[name] = np.zeros((after.mesh.n_nodes, after.mesh.dim))
        pair = heavy(old.model, before), heavy(new.model, after)
        velocity[name], acceleration[name] = (moved_on(*pair, u, field[name]) for field in (velocity, acceleration))
    return replace(state, displacement=displacement, memory=memories, velocity=velocity, acceleration=acceleration)


def _surface(old: FormedScene, new: FormedScene, now: ModelState, changed: Collection[str]) -> SurfaceForces | None:
    """Friction on the new surfaces, by place; None without."""
    if new.model.friction.frictionless:
        return None
    blocks = []
    for part in old.model.parts:
        places = part.mesh.points + now.start.displacement[part.nodes]
        points = new.part(part.name).mesh.points
        same = sp.eye_array(len(places), format="csr")
        blocks.append(interpolation(part.mesh.blocks, places, points) if part.name in changed else same)
    return surface_forces(old.model, now, _pairs(old.model)).on(sp.csr_array(sp.block_diag(blocks, format="csr")))


def _in_contact(
    before: Model, model: Model, now: ModelState, state: State, surface: SurfaceForces | None
) -> ModelState:
    """State with contact forces that balance the carried stress, of the same sum between two bodies as before, and
    with the friction of the places.
    """
    labels = model.contacts.labels
    u = model.join(state.displacement)
    rows = model.rows(u, state.time)
    closed = rows.near & (rows.gap(u) <= CLOSED * model.extent(u))
    none = {label: np.zeros(len(rows.node[rows_of]), bool) for label, rows_of in _slices(model)}
    empty = {label: np.zeros((len(none[label]), model.shape[1])) for label in labels} if state.traction else {}
    blank = replace(state, closed=none, pressure={label: 1.0 * flags for label, flags in none.items()})
    blank = replace(blank, traction=empty, sliding=none if state.sliding else {}, slip={})
    joined = join_states(model, blank)
    force = joined.start.force
    share = np.bincount(rows.node[closed], minlength=len(u)).astype(float)[rows.node]
    pushed = force[rows.node] / np.maximum(share, 1.0)[:, None]
    normal = np.where(closed, np.maximum((pushed * rows.normal).sum(axis=1), 0.0), 0.0)
    pairs = _pairs(model)
    for k in range(int(pairs.max(initial=-1)) + 1):
        mine, total = pairs[rows.contact] == k, float(now.pressure[pairs[before.contacts.contact] == k].sum())
        found = float(normal[mine].sum())
        normal[mine] *= total / found if found > 0.0 else 0.0
    traction, sliding, slip = joined.traction, joined.sliding, None
    if surface is not None:
        traction, sliding = surface.forces(rows, model.friction.at(u), normal)
        slip = None if now.slip is None else surface.slips(rows)
    force = _balanced(model, force, rows.spread(normal, model.shape) + rows.shear.spread(traction), state.time)
    joined = replace(joined, start=replace(joined.start, force=force), slip=slip)
    return replace(joined, closed=normal > 0.0, pressure=normal, traction=traction, sliding=sliding, span=now.span)


def _settled(model: Model, state: State, surface: SurfaceForces | None, span: float) -> ModelState:
    """State with massless nodes in equilibrium with the contacts and the friction of the places, the others fixed."""
    u = model.join(state.displacement)
    unsettled = Unsettled(
        model=starting_at(model, state.fields, u),
        displacement=u,
        states=tuple(state.memory.get(p.name) for p in model.parts),
        friction=surface,
        kept=None,
        time=state.time,
        span=span,
    )
    (rest, reached), by = unsettled.settled(), _slices(model)
    slip = None if surface is None else surface.slips(model.rows(rest.displacement, state.time))
    return join_states(
        model,
        replace(
            state,
            displacement=model.split(rest.displacement),
            memory={p.name: m for p, m in zip(model.parts, reached, strict=True) if m is not None},
            pressure={label: rest.pressure[mine] for label, mine in by},
            closed={label: rest.pressure[mine] > 0.0 for label, mine in by},
            traction={label: rest.traction[mine] for label, mine in by} if state.traction else {},
            sliding={label: rest.sliding[mine] for label, mine in by} if state.sliding else {},
            slip={} if slip is None else {label: slip[mine] for label, mine in by},
        ),
    )


def _balanced(model: Model, force: Array, contact: Array, time: float) -> Array:
    """Internal forces (n, d) of a slab's start that balance the forces of contacts and loads on massless nodes.

    What the transfer has left unbalanced there is taken from the supports, so that the forces of a solid have the same
    sum.
    """
    light = model.dofs.free & ~model.massive[:, None]
    balanced = np.where(light, model.loads.at(time) + contact, force)
    for part in model.parts:
        held = ~model.dofs.free[part.nodes]
        missing = (force - balanced)[part.nodes].sum(axis=0)
        balanced[part.nodes] += np.where(held, missing / np.maximum(held.sum(axis=0), 1), 0.0)
    return np.asarray(balanced)


def _pairs(model: Model) -> IntArray:
    """Number (c,) of the pair of bodies of each contact: a new mesh may have moved tags, and with them parts of the
    surface to another contact with the same body.
    """
    numbers: dict[frozenset[str], int] = {}
    names = [frozenset(contact.bodies) for contact in model.scene.contacts]
    return np.array([numbers.setdefault(one, len(numbers)) for one in names], dtype=np.int64)


def _slices(model: Model) -> list[tuple[str, slice]]:
    """Contacts with their rows."""
    return [(label, model.contacts.rows_of(k)) for k, label in enumerate(model.contacts.labels)]


def _exchange(old: FormedScene, new: FormedScene, now: MarchState, name: str, reason: str, energy: float) -> Exchange:
    """What a new mesh has changed."""
    mesh, part = old.part(name).mesh, new.part(name)
    places, section = old.places(now, name), part.internal.section
    before, after = volume_of(mesh.blocks, section, places), volume_of(part.mesh.blocks, section, part.mesh.points)
    return Exchange(
        reason=reason,
        nodes=part.mesh.n_nodes,
        cells=part.mesh.n_cells,
        quality=(cell_quality(mesh.blocks, places).worst[0], new.new[name][0]),
        volume=after / before - 1.0,
        energy=energy,
    )
