"""March of a scene in which degraded meshes of some solids are replaced between slabs."""

import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from softway.errors import Cancel, InputError, NumericsError
from softway.march.remeshing.forming.carried import Exchange, carried_on
from softway.march.remeshing.forming.formed_scene import FormedScene, Replacement, formed_scene
from softway.march.remeshing.forming.remesh import Remesh
from softway.march.remeshing.forming.replacement import replacement
from softway.march.results.step import Step
from softway.march.rules.slab_rule import Method
from softway.march.slabs import slabs
from softway.march.start.preparation import prepare
from softway.march.state.march_state import MarchState, Settings
from softway.march.state.step_control import StepControl
from softway.model.model import Model
from softway.model.scene import Scene
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.units import Second

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FormedStep:
    """Slab on the present meshes.

    Parameters
    ----------
    step
        The slab; displacements are those since the mesh was new.
    model
        Model of the scene on these meshes.
    exchanges
        What new meshes at the start of the slab have changed, by solid; empty where there are none.
    """

    step: Step
    model: Model
    exchanges: Mapping[str, Exchange]


def forming_march(
    scene: Scene,
    remesh: Mapping[str, Remesh],
    *,
    until: Second,
    step: Second,
    weight: TimeWeight = EndPeaks(),
    method: Method = FixedPoint(),
    control: StepControl = StepControl(),
    cancel: Cancel | None = None,
) -> Iterator[FormedStep]:
    """Accepted slabs of a march in which solids get new meshes before their cells degenerate.

    The meshes are replaced between slabs, and their reference is then the present shape: laws of rates keep what they
    remember, :mod:`softway.adaptivity.unrelated`.  What new meshes took of the energy is ``ledger.remeshing``.

    Parameters
    ----------
    scene
        The scene.
    remesh
        Solids that get new meshes, by name.
    until, step, weight, method, control, cancel
        As for :func:`~softway.march.march.march`.

    Raises
    ------
    InputError
        For solids whose mesh cannot be replaced, and as for a march.
    NumericsError, Cancelled
        As for a march.

    Examples
    --------
    >>> import softway as sw
    >>> body = sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3)), dilatation="mean", density=1.0,
    ...                 material=sw.laws.NortonHoff(K=1.0, m=0.5),
    ...                 supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")))
    >>> platen = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 1.0), normal=(0.0, -1.0)),
    ...                  motion=sw.bodies.Translation(velocity=(0.0, -1.0)))
    >>> press = sw.Scene(bodies={"body": body, "platen": platen}, inertia=sw.bodies.Off(),
    ...                  contacts=(sw.Contact(between=("body.top", "platen")),))
    >>> steps = list(forming_march(press, {"body": Remesh(ratio=1.5)}, until=0.6, step=0.1))
    >>> sum(len(one.exchanges) for one in steps) > 2
    True
    """
    if not remesh or isinstance(method, Explicit):
        what = "no solid" if not remesh else "Explicit, whose stable step new cells change"
        raise InputError("remesh" if not remesh else "method", what, "a solid that remeshes, and FixedPoint or Newton")
    every, now = min(how.every for how in remesh.values()), None
    settings = Settings(until=until, step=step, weight=weight, method=method, control=control)
    on = formed_scene(scene, remesh)
    exchanges: Mapping[str, Exchange] = {}
    while now is None or now.state.time < until - 1e-9 * now.step_history.span:
        prepared = prepare(on.model, settings, now, cancel)
        steps = slabs(prepared.stepper, prepared.march_state)
        since = 0
        for taken in steps:
            now, since = taken.march_state, since + 1
            yield FormedStep(step=taken, model=on.model, exchanges=exchanges)
            exchanges = {}
            reasons = _reasons(on, remesh, taken) if since >= every else {}
            if reasons:
                break
        assert now is not None
        if reasons and now.state.time < until - 1e-9 * now.step_history.span:
            on, now, exchanges = _replaced(on, remesh, now, reasons)


def _reasons(on: FormedScene, remesh: Mapping[str, Remesh], taken: Step) -> dict[str, str]:
    """Solids that ask for new meshes, and why."""
    span = taken.march_state.step_history.span
    found = {name: on.asks(how, taken.march_state, name) for name, how in remesh.items()}
    for name, how in remesh.items():
        if not found[name] and taken.slab.span < how.shortened * span and taken.report.rejections:
            found[name] = f"slab of {taken.slab.span:.3g} s"
    return {name: reason for name, reason in found.items() if reason}


def _replaced(
    on: FormedScene, remesh: Mapping[str, Remesh], now: MarchState, reasons: Mapping[str, str]
) -> tuple[FormedScene, MarchState, Mapping[str, Exchange]]:
    """Scene and state with new meshes of the solids for which there are any."""
    meshes: dict[str, Replacement] = {}
    for name in reasons:
        found = replacement(on, remesh[name], now, name)
        if found is None:
            log.info("no new mesh of %r at t = %.6g s fits", name, now.state.time)
            continue
        meshes[name] = found
    if not meshes:
        return on, now, {}
    new = on.on(meshes)
    try:
        now, exchanges = carried_on(on, new, now, {name: reasons[name] for name in meshes})
    except NumericsError as error:  # contact nodes that find no equilibrium
        log.info("no new meshes at t = %.6g s: %s", now.state.time, error)
        return on, now, {}
    for name, one in exchanges.items():
        log.info("new mesh of %r at t = %.6g s: %s", name, now.state.time, one.reason)
    return new, now, exchanges
