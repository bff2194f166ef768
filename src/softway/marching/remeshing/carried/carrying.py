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
from softway.adaptivity.projections.conditions import ClosedRows
from softway.adaptivity.transfer import Settled, Transferred, transfer
from softway.arrays import Array, BoolArray
from softway.bodies.assembled.material_states import MaterialStates, any_path_dependent
from softway.heat.coupled.solid_temperature import TEMPERATURE
from softway.marching.remeshing.adapted_scene import AdaptedScene
from softway.marching.remeshing.carried.kept_contacts import KeptContacts, kept_contacts
from softway.marching.remeshing.carried.linked_changes import (
    LinkedChange,
    all_values,
    inert_contacts,
    linked_changes,
    values_between,
)
from softway.marching.remeshing.carried.settling import Unsettled
from softway.marching.remeshing.carried.surface_forces import SurfaceForces, surface_forces
from softway.marching.remeshing.carried_bonds import carried_bonds, damages, with_damage
from softway.marching.remeshing.carried_heat import (
    account_of_heat,
    carried_unknowns,
    heat_of,
    starting_at,
    strained,
    temperatures_from,
    with_content,
    with_digits,
)
from softway.marching.remeshing.standing import standing
from softway.marching.state.march_state import AdaptedMeshes, MarchState
from softway.marching.state.model_state import Kind, ModelState, join_states, split_states
from softway.model.scene import State
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.static.static_equilibrium import StaticState


def carried_over(old: AdaptedScene, new: AdaptedScene, now: MarchState) -> tuple[MarchState, Mapping[str, Transferred]]:
    """State of a march on the new meshes, and the transfers of the solids whose meshes change.

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
    names = np.array([part.name for part in new.model.parts])
    found, taken, velocity, start = {}, 0.0, joined.start.velocity.copy(), now.state.start
    for one in change.groups:
        there = change.settled(one, joined, float(before[np.isin(names, one.names)].sum()))
        motion, closed = one.motion(start.displacement, start.velocity), change.closed(one, joined)
        passed = transfer(one.before, one.after, motion, one.cast, there, closed)
        velocity[one.nodes[1]] = passed.motion.velocity
        found.update(dict.fromkeys(one.changed, passed))
        taken += passed.booked
    fixed = ~np.isin(names, list(new.meshes))
    taken += float((before - joined.start.energy)[fixed].sum())
    state = replace(joined, start=replace(joined.start, velocity=velocity))
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
    bisected both of its meshes; the changes by groups of linked solids; values (m, n) at the new nodes of fields on the
    old ones; the companion fields after it, the unknowns of the heat, and contacts of nodes with inertia.
    """

    old: AdaptedScene
    new: AdaptedScene
    now: ModelState
    state: State
    span: float
    pairs: Mapping[str, tuple[AdaptedSolid, AdaptedSolid]]
    groups: tuple[LinkedChange, ...]
    at_nodes: sp.csr_array
    fields: Mapping[str, Mapping[str, Array]]
    kept: KeptContacts | None
    heat: Array | None = None

    def unsettled(self) -> Unsettled:
        """Solids on the new meshes with projected displacements and inherited histories."""
        model = self.new.model
        u = self._alike(self.now.start.displacement)
        for one in self.groups:
            one.displacement(self.now.start.displacement, u)
        return Unsettled(
            model=standing(with_damage(starting_at(model, self.fields, u), self.fields), self.now),
            displacement=u,
            states=self._states(u),
            friction=self._friction(),
            kept=self.kept,
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
        return surface_forces(self.old.model, self.now).on(self.at_nodes)

    def _alike(self, field: Array) -> Array:
        """Field (m, d) of the solids that keep their nodes, from one (n, d) of all solids; zero for the others."""
        out = np.zeros(self.new.model.shape)
        for old, new in zip(self.old.model.parts, self.new.model.parts, strict=True):
            if new.name not in self.pairs:
                out[new.nodes] = field[old.nodes]
        return out

    def joined(self) -> ModelState:
        """State in equilibrium, with projected velocities."""
        unsettled = self.unsettled()
        rest, states = unsettled.settled()
        found = join_states(self.new.model, self.resting(rest, states, unsettled.friction), self.span)
        found = found if self.kept is None else self.kept.pressed(unsettled.model, found, unsettled.friction)
        return with_digits(self.new.model, replace(found, rigid=self.now.rigid), self.heat)

    def closed(self, one: LinkedChange, found: ModelState) -> ClosedRows | None:
        """Rows on the new meshes of some solids that stay closed; None without nodes that have inertia in contact."""
        if self.kept is None:
            return None
        model, start = standing(self.new.model, found), found.start
        return self.kept.conditions(model, model.rows(start.displacement, found.time), start.velocity, one.nodes[1])

    def with_content(self, found: ModelState) -> "_Change":
        """Change to temperatures with which a state that was found so far would have the heat content before."""
        before, after = heat_of(self.old.model, self.now), heat_of(self.new.model, found)
        if before is None or after is None or self.heat is None:
            return self
        return self.heated_by(with_content(self.new.model, self.heat, before, after))

    def heated_by(self, unknowns: Array | None) -> "_Change":
        """Change with the unknowns of the heat."""
        found = temperatures_from(self.new.model, unknowns)
        return replace(
            self, heat=unknowns, fields=self.fields if found is None else {**self.fields, TEMPERATURE.name: found}
        )

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
            velocity=self._cast(self.now.start.velocity),
            acceleration=self._cast(self.now.acceleration),
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

    def _cast(self, field: Array) -> dict[str, Array]:
        """A velocity or acceleration (n, d) of the solids, projected."""
        out = self._alike(field)
        for one in self.groups:
            one.velocity(field, out)
        return self.new.model.split(out)

    def _slips(self, rest: StaticState, friction: SurfaceForces | None) -> Array | None:
        """Slip (m, d) of the new rows; None where none is known."""
        if friction is None or self.now.slip is None:
            return None
        return friction.slips(standing(self.new.model, self.now).rows(rest.displacement, self.state.time))

    def settled(self, one: LinkedChange, found: ModelState, before: float) -> Settled:
        """Some solids in a state, with the stored energy ``before`` that is to pass over [J]."""
        own = np.isin([part.name for part in self.new.model.parts], one.names)
        return Settled(
            displacement=found.start.displacement[one.nodes[1]],
            state=None,
            before=before,
            energy=float(found.start.energy[own].sum()),
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
    state, models = split_states(old.model, now.state), (old.model, new.model)
    values = values_between(pairs)
    at_nodes = all_values(new.model, values)
    groups, bonds = linked_changes(old, new, now.state.closed), carried_bonds(*models, now.state, at_nodes)
    change = _Change(
        old=old, new=new, now=now.state, state=state, span=now.step_history.span, pairs=pairs,
        groups=tuple(one.glued([b.glue(one.nodes[1]) for b in bonds if b.links(one.nodes[1])]) for one in groups),
        at_nodes=at_nodes, fields=damages(new.model, bonds),
        kept=kept_contacts(standing(old.model, now.state), now.state, at_nodes) if inert_contacts(old.model) else None,
    )  # fmt: skip
    return change.heated_by(carried_unknowns(models, pairs, values, now.state))
