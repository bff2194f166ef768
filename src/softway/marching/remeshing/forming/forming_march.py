"""March of a scene in which degraded meshes of some solids are replaced between slabs."""

import logging
from collections.abc import Iterator, Mapping
from dataclasses import replace

from softway.errors import Cancel, NumericsError
from softway.marching.remeshing.changing_slabs import Change, changing_slabs
from softway.marching.remeshing.forming.carried import carried_on
from softway.marching.remeshing.forming.formable import replacements
from softway.marching.remeshing.forming.formed_scene import FormedScene, Replacement, formed_scene
from softway.marching.remeshing.forming.replacement import replacement
from softway.marching.results.step import Step
from softway.marching.results.trying import TryWatch
from softway.marching.start.preparation import prepare
from softway.marching.state.march_state import MarchState, RemeshedMeshes, Settings, StepHistory
from softway.meshes.remeshed.remesh import worse
from softway.model.model import Model
from softway.model.scene import State

log = logging.getLogger(__name__)


def forming_march(
    model: Model,
    settings: Settings,
    state: State | MarchState | None = None,
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step]:
    """Accepted slabs of a march in which solids with ``remesh`` get new meshes before their cells degenerate.

    The meshes are replaced between slabs, and their reference is then the present shape: laws of rates keep what they
    remember, :mod:`softway.adaptivity.unrelated`.  What new meshes took of the energy is ``ledger.remeshing``.

    Parameters
    ----------
    model
        Model of the scene, on the meshes of its start or on those of a step.
    settings, state, cancel, trying
        As for :func:`~softway.marching.start.preparation.prepare`.

    Raises
    ------
    InputError, NumericsError, Cancelled
        As for a march.
    """
    stored = state.remeshed if isinstance(state, MarchState) else None
    on = formed_scene(model) if stored is None else formed_scene(model).at(stored.meshes)
    prepared = prepare(on.model, settings, state, cancel, trying)
    now = prepared.march_state
    if now.remeshed is None:
        prepared = replace(prepared, march_state=replace(now, remeshed=RemeshedMeshes(meshes=on.meshes)))
    return changing_slabs(on, prepared, _change, cancel, trying, _rescue, meshes_first=True)


def _change(on: FormedScene, now: MarchState) -> Change[FormedScene] | None:
    """Change to new meshes of the solids that ask for them; None if none does.

    Meshes stay where no cells fit into a shape, and where massless nodes find no equilibrium; the state then has the
    quality of their cells.
    """
    reasons = on.asks(now)
    if not reasons:
        return None
    changed = _replaced(on, now, reasons)
    change = changed or Change(on=on, now=now)
    stay = [name for name in reasons if name not in change.exchanges]
    return _failing(change, on, now, stay)


def _rescue(on: FormedScene, now: MarchState, tried: bool, failure: NumericsError) -> Change[FormedScene] | None:
    """Change before another try of a slab that failed at every length: new meshes of the solids whose cells are a
    fifth worse than new ones, or back to the old ones if the slab has failed on new meshes; None if there is none.

    Raises
    ------
    NumericsError
        The failure, with the solid whose surface crosses itself.
    """
    if tried:
        return _failing(Change(on=on, now=now), on, now, list(on.asks(now)))
    change = _rescued(on, now)
    if change is None:
        _blame(on, now, failure)
    return change


def _rescued(on: FormedScene, now: MarchState) -> Change[FormedScene] | None:
    """Change to new meshes of the solids whose cells are a fifth worse than new ones; None where there are none.

    A march is rescued once within a slab of the requested length, so that it ends.
    """
    assert now.remeshed is not None
    last, span = now.remeshed.rescued, now.step_history.span
    if last is not None and now.state.time < last + span:
        return None
    names = [name for name in replacements(on.scene) if worse(on.quality(now, name), on.new[name])]
    change = _replaced(on, now, dict.fromkeys(names, "a slab that failed"))
    if change is None:
        return None
    assert change.now.remeshed is not None
    begun = StepHistory(span=span, length=span, fastest=now.step_history.fastest)
    remeshed = replace(change.now.remeshed, rescued=now.state.time)
    return replace(change, now=replace(change.now, step_history=begun, remeshed=remeshed))


def _blame(on: FormedScene, now: MarchState, failure: NumericsError) -> None:
    """Raise a failure with the name of a solid whose surface crosses itself: no mesh has such a shape."""
    for name in replacements(on.scene):
        if (place := on.crossing(now, name)) is not None:
            told = f"the surface of {name!r} crosses itself at ({', '.join(f'{x:.4g}' for x in place)}) m"
            remedy = f'a contact between = ["{name}", "{name}"], which keeps its sides apart'
            raise NumericsError(f"{failure.what}; {told}", failure.when, remedy) from failure


def _failing(change: Change[FormedScene], on: FormedScene, now: MarchState, stay: list[str]) -> Change[FormedScene]:
    """The change, whose state has the quality of the cells of the solids that ``stay`` on their meshes."""
    assert change.now.remeshed is not None
    failed = {**change.now.remeshed.failed, **{name: on.quality(now, name) for name in stay}}
    return replace(change, now=replace(change.now, remeshed=replace(change.now.remeshed, failed=failed)))


def _replaced(on: FormedScene, now: MarchState, reasons: Mapping[str, str]) -> Change[FormedScene] | None:
    """Change to new meshes of some solids; None where none fits, or massless nodes find no equilibrium on them."""
    hows, meshes = replacements(on.scene), dict[str, Replacement]()
    for name in reasons:
        found = replacement(on, hows[name], now, name)
        if found is None:
            crossed = "" if on.crossing(now, name) is None else ": its surface crosses itself"
            log.info("no new mesh of %r at t = %.6g s fits%s", name, now.state.time, crossed)
        else:
            meshes[name] = found
    return _changed(on, now, meshes, {name: reasons[name] for name in meshes}) if meshes else None


def _changed(
    on: FormedScene, now: MarchState, meshes: Mapping[str, Replacement], reasons: Mapping[str, str]
) -> Change[FormedScene] | None:
    """Change to new meshes; None if massless nodes find no equilibrium on them."""
    new = on.on(meshes, now)
    try:
        reached, exchanges = carried_on(on, new, now, reasons)
    except NumericsError as error:
        log.info("meshes stay as they are at t = %.6g s: %s", now.state.time, error.what)
        return None
    for name, one in exchanges.items():
        log.info("new mesh of %r at t = %.6g s: %s", name, now.state.time, one.reason)
    return Change(on=new, now=reached, exchanges=exchanges)
