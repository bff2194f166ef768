"""State of a march on other meshes of its solids: what passes over, and what is booked
(docs/theory/bodies/adaptive.md#march).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.memory import remembered
from softway.adaptivity.projections.projection import AnyProjection, Unchanged, projection
from softway.adaptivity.transfer import Settled, Transferred, transfer
from softway.arrays import Array, BoolArray
from softway.bodies.assembled.material_states import MaterialStates, any_path_dependent
from softway.march.remeshing.adapted_scene import AdaptedScene, motion_of
from softway.march.remeshing.carried_heat import (
    account_of_heat,
    carried_temperatures,
    heat_of,
    starting_at,
    strained,
    with_content,
)
from softway.march.remeshing.settling import Unsettled
from softway.march.remeshing.standing import standing
from softway.march.remeshing.surface_forces import SurfaceForces, surface_forces
from softway.march.state.march_state import AdaptedMeshes, MarchState
from softway.march.state.model_state import Kind, ModelState, join_states, split_states
from softway.model.scene import State
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.static_equilibrium import StaticState


def carried_over(old: AdaptedScene, new: AdaptedScene, now: MarchState) -> tuple[MarchState, Mapping[str, Transferred]]:
    """State of a march on the new meshes, and the transfers of the solids with meshes of their own.

    Displacements are projected, histories inherited, and frictions pass by their places.  Massless nodes of all solids
    find their equilibrium with the contacts, and then the balances are closed.  What this equilibrium has dissipated,
    and what the transfers have taken of the energy, is in the account.

    Raises
    ------
    NumericsError
        If massless nodes find no equilibrium.
    """
    change = _change(old, new, now)
    joined = change.joined()
    if strained(new.model):
        change = change.with_content(joined)
        joined = change.joined()
    lost, heats = change.dissipated(joined), (heat_of(old.model, now.state), heat_of(new.model, joined))
    warmed = np.zeros(len(lost)) if heats[0] is None or heats[1] is None else heats[1].contents - heats[0].contents
    before = now.state.start.energy - lost - warmed
    names = [part.name for part in new.model.parts]
    found = {}
    for name, pair in change.pairs.items():
        there = change.settled(name, joined, float(before[names.index(name)]))
        found[name] = transfer(*pair, motion_of(old.model, now, name), change.casts[name], there)
    fixed = np.array([name not in new.meshes for name in names])
    taken = sum(one.booked for one in found.values()) + float((before - joined.start.energy)[fixed].sum())
    velocity = {**change.state.velocity, **{name: one.motion.velocity for name, one in found.items()}}
    state = replace(joined, start=replace(joined.start, velocity=new.model.join(velocity)))
    account = replace(
        now.account,
        remeshing=now.account.remeshing + taken,
        dissipation=now.account.dissipation + float(lost.sum() + warmed.sum()),
        heat=account_of_heat(now.account.heat, *heats, float(lost[change.heated()].sum())),
    )
    adapted = AdaptedMeshes(leaves=new.leaves, energy=0.0 if now.adapted is None else now.adapted.energy)
    memory = OperatorMemory(room=now.memory.room)
    return replace(now, state=state, account=account, memory=memory, adapted=adapted), found


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Change:
    """Change of meshes: the scene before and after it, the state before, and for each solid of cells that can be
    bisected both of its meshes and the projections between them; values of the companion fields after it.
    """

    old: AdaptedScene
    new: AdaptedScene
    now: ModelState
    state: State
    span: float
    pairs: Mapping[str, tuple[AdaptedSolid, AdaptedSolid]]
    casts: Mapping[str, AnyProjection]
    fields: Mapping[str, Mapping[str, Array]]

    def unsettled(self) -> Unsettled:
        """Solids on the new meshes with projected displacements and inherited histories."""
        model = self.new.model
        projected = {name: cast.displacement(self.state.displacement[name]) for name, cast in self.casts.items()}
        u = model.join({**self.state.displacement, **projected})
        return Unsettled(
            model=standing(starting_at(model, self.fields, u), self.now),
            displacement=u,
            states=self._states(u),
            friction=self._friction(),
            time=self.state.time,
            span=self.span,
        )

    def _states(self, u: Array) -> MaterialStates:
        """Material states on the new meshes at the displacement u (n, d)."""
        if not any_path_dependent(self.new.model.parts):
            return ()
        found = dict(self.state.memory)
        for name, pair in self.pairs.items():
            if name in found:
                found[name] = remembered(*pair, found[name], u[pair[1].part.nodes])
        return tuple(found.get(part.name) for part in self.new.model.parts)

    def _friction(self) -> SurfaceForces | None:
        """Friction on the new surfaces; None without."""
        if self.new.model.friction.frictionless:
            return None
        return surface_forces(self.old.model, self.now).on(self.at_nodes())

    def at_nodes(self) -> sp.csr_array:
        """Values (m, n) at the new nodes of fields on the old ones."""
        blocks = []
        for part in self.new.model.parts:
            cast = self.casts.get(part.name)
            if cast is None or isinstance(cast, Unchanged):
                blocks.append(sp.eye_array(part.mesh.n_nodes, format="csr"))
            else:
                blocks.append(cast.at_nodes)
        return sp.csr_array(sp.block_diag(blocks, format="csr"))

    def joined(self) -> ModelState:
        """State in equilibrium, with projected velocities."""
        unsettled = self.unsettled()
        rest, states = unsettled.settled()
        found = join_states(self.new.model, self.resting(rest, states, unsettled.friction), self.span)
        return replace(found, rigid=self.now.rigid)

    def with_content(self, found: ModelState) -> "_Change":
        """Change to temperatures with which a state that was found so far would have the heat content before."""
        before, after = heat_of(self.old.model, self.now), heat_of(self.new.model, found)
        if before is None or after is None:
            return self
        shifted = {n: with_content(self.new.model, values, before, after) for n, values in self.fields.items()}
        return replace(self, fields=shifted)

    def resting(self, rest: StaticState, states: MaterialStates, friction: SurfaceForces | None) -> State:
        """State in equilibrium, with projected velocities."""
        model, contacts = self.new.model, self.new.model.contacts
        by = {label: contacts.rows_of(k) for k, label in enumerate(contacts.labels)}
        rough, slips = not model.friction.frictionless, self._slips(rest, friction)

        def of(values: NDArray[Kind]) -> dict[str, NDArray[Kind]]:
            return {label: values[rows] for label, rows in by.items()}

        parts = zip(model.parts, states, strict=False)
        return replace(
            self.state,
            displacement=model.split(rest.displacement),
            fields=self.fields,
            velocity=self._cast(self.state.velocity),
            acceleration=self._cast(self.state.acceleration),
            memory={part.name: state for part, state in parts if state is not None},
            pressure=of(rest.pressure),
            closed=of(rest.pressure > 0.0),
            traction=of(rest.traction) if rough else {},
            sliding=of(rest.sliding) if rough else {},
            slip={} if slips is None else of(slips),
        )

    def heated(self) -> BoolArray:
        """True (parts,) for solids with heat."""
        bodies = self.new.scene.bodies
        return np.array([getattr(bodies[p.name], "thermal", None) is not None for p in self.new.model.parts])

    def _cast(self, fields: Mapping[str, Array]) -> dict[str, Array]:
        """Fields of the solids, projected."""
        return {**fields, **{name: cast.velocity(fields[name]) for name, cast in self.casts.items()}}

    def _slips(self, rest: StaticState, friction: SurfaceForces | None) -> Array | None:
        """Slip (m, d) of the new rows; None where none is known."""
        if friction is None or self.now.slip is None:
            return None
        return friction.slips(standing(self.new.model, self.now).rows(rest.displacement, self.state.time))

    def settled(self, name: str, found: ModelState, before: float) -> Settled:
        """A solid in a state, with the stored energy ``before`` that is to pass over [J]."""
        k = [part.name for part in self.new.model.parts].index(name)
        states = found.start.states
        return Settled(
            displacement=found.start.displacement[self.new.model.parts[k].nodes],
            state=states[k] if states else None,
            before=before,
            energy=float(found.start.energy[k]),
        )

    def dissipated(self, after: ModelState) -> Array:
        """Energy (parts,) that the materials have dissipated in the change [J]."""
        out = np.zeros(len(self.new.model.parts))
        pairs = zip(self.old.model.parts, self.new.model.parts, strict=True)
        if any_path_dependent(self.new.model.parts):
            for k, (one, other) in enumerate(pairs):
                was, is_now = self.now.start.states[k], after.start.states[k]
                out[k] = other.internal.dissipated_energy(is_now) - one.internal.dissipated_energy(was)
        return out


def _change(old: AdaptedScene, new: AdaptedScene, now: MarchState) -> _Change:
    """Change between the meshes of two scenes."""
    pairs = {name: (old.solid(name), new.solid(name)) for name in new.meshes}
    casts, state = {name: projection(*pair) for name, pair in pairs.items()}, split_states(old.model, now.state)
    models = old.model, new.model
    fields = {name: carried_temperatures(models, pairs, casts, values) for name, values in state.fields.items()}
    return _Change(
        old=old, new=new, now=now.state, state=state, span=now.step_history.span, pairs=pairs, casts=casts,
        fields=fields,
    )  # fmt: skip
