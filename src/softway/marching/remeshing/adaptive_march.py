"""March of a scene in which the meshes of some solids change between slabs (docs/theory/bodies/adaptive.md#march)."""

import logging
from collections.abc import Iterator
from dataclasses import replace

from softway.errors import Cancel, NumericsError
from softway.marching.remeshing.adapted_scene import AdaptedScene, adapted_scene
from softway.marching.remeshing.admitted import adaptions
from softway.marching.remeshing.carried.carrying import carried_over
from softway.marching.remeshing.changing_slabs import Change, changing_slabs
from softway.marching.results.step import Step
from softway.marching.results.trying import TryWatch
from softway.marching.start.preparation import Preparation, prepare
from softway.marching.state.march_state import AdaptedMeshes, MarchState, Settings
from softway.model.model import Model
from softway.model.scene import State

log = logging.getLogger(__name__)
AHEAD = 2.0
"""Time within which contacts count as soon closed, in those between two changes of the mesh."""
SELDOM = 5
"""Number of changes in a row that were refused after which tries become no more seldom."""


def adaptive_march(
    model: Model,
    settings: Settings,
    state: State | MarchState | None = None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step]:
    """Accepted slabs of a march in which the meshes of some solids follow their waves.

    The meshes change between slabs.  Momentum, spin and energy pass from mesh to mesh (:mod:`softway.adaptivity`), and
    the energy balance of a step is that of the whole march; what changes of the meshes took, and no scalar has closed,
    is ``ledger.remeshing``.

    Parameters
    ----------
    model
        Model of the scene, on the base mesh of each solid or on the meshes of :func:`adapted_start`.
    settings, state, cancel, trying
        As for :func:`~softway.marching.start.preparation.prepare`.

    Raises
    ------
    InputError
        For bodies whose meshes cannot adapt, and as for a march.
    NumericsError, Cancelled
        As for a march.
    """
    stored = state.adapted if isinstance(state, MarchState) else None
    if stored is not None:
        on = adapted_scene(model).at(stored.leaves)
    else:
        on = adapted_start(model, settings) if state is None else adapted_scene(model)
    return changing_slabs(on, _prepared(on, settings, state, cancel, trying), _change, cancel, trying, _rescue)


def adapted_start(model: Model, settings: Settings) -> AdaptedScene:
    """Scene on the meshes that its initial state asks for, from the base meshes two levels at a time.

    Raises
    ------
    InputError
        For bodies whose meshes cannot adapt, and as for a march.
    """
    on = adapted_scene(model)
    deepest = max(how.deepest(on.meshes[name].base.cell_dim) for name, how in adaptions(on.scene).items())
    for _ in range(0 if model.adapted else 1 + deepest // 2):
        now = prepare(on.model, settings).march_state
        new = on.wanted(now, _energy(now), _ahead(on, now))
        if new is on:
            break
        on = new
    return on


def _prepared(
    on: AdaptedScene,
    settings: Settings,
    state: State | MarchState | None,
    cancel: Cancel | None,
    trying: TryWatch | None,
) -> Preparation:
    """Preparation of a march on adapted meshes."""
    prepared = prepare(on.model, settings, state, cancel, trying)
    now = prepared.march_state
    if now.adapted is not None:
        return prepared
    adapted = AdaptedMeshes(leaves=on.leaves, energy=now.account.energy_start)
    return replace(prepared, march_state=replace(now, adapted=adapted))


def _change(on: AdaptedScene, now: MarchState) -> Change[AdaptedScene] | None:
    """Change to the meshes that a state asks for, after every ``every`` slabs; None if they stay.

    Meshes stay where massless nodes find no equilibrium on new ones; then the next change is tried after twice as many
    slabs.
    """
    refused = 0 if now.adapted is None else now.adapted.refused
    if now.slabs % (_every(on) << min(refused, SELDOM)):
        return None
    new = on.wanted(now, _energy(now), _ahead(on, now))
    if new is on:
        return None
    found = _changed(on, new, now)
    return _refused(on, now) if found is None else replace(found, now=_just_changed(found.now))


def _just_changed(now: MarchState) -> MarchState:
    """The state on new meshes: where its next slab fails it goes back to the old ones."""
    return now if now.adapted is None else replace(now, adapted=replace(now.adapted, changed=now.slabs))


def _refused(on: AdaptedScene, now: MarchState) -> Change[AdaptedScene] | None:
    """The same meshes, with one more change that was refused."""
    if now.adapted is None:
        return None
    return Change(on=on, now=replace(now, adapted=replace(now.adapted, refused=now.adapted.refused + 1)))


def _changed(on: AdaptedScene, new: AdaptedScene, now: MarchState) -> Change[AdaptedScene] | None:
    """Change to other meshes; None if massless nodes find no equilibrium on them."""
    try:
        reached, transfers = carried_over(on, new, now)
    except NumericsError as error:
        log.info("meshes stay as they are at t = %.6g s: %s", now.state.time, error.what)
        return None
    return Change(on=new, now=reached, transfers=transfers)


def _rescue(on: AdaptedScene, now: MarchState, tried: bool, failure: NumericsError) -> Change[AdaptedScene] | None:
    """Change before another try of a slab that failed at every length: back to the old meshes if it has failed on new
    ones, and else to finer ones, or to the base meshes; None if there are none.

    A slab follows each change, and the patience with short slabs stays as it is, so that a march ends.
    """
    if tried:
        return Change(on=on, now=now)
    others = (new for new in (on.halved(), on.coarsest()) if new is not on)
    return next((change for new in others if (change := _changed(on, new, now)) is not None), None)


def _energy(now: MarchState) -> float:
    """Greatest energy of the scene so far [J]."""
    return now.account.energy_start if now.adapted is None else now.adapted.energy


def _ahead(on: AdaptedScene, now: MarchState) -> float:
    """Time within which contacts close soon [s]."""
    return AHEAD * _every(on) * now.step_history.longest


def _every(on: AdaptedScene) -> int:
    """Slabs between two changes of the meshes."""
    return min(how.every for how in adaptions(on.scene).values())
