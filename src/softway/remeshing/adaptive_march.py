"""March of a scene in which the meshes of some solids change between slabs."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice

from softway.adaptivity.transfer import Transferred
from softway.errors import Cancel, InputError
from softway.march.march import march
from softway.march.march_state import MarchState, Settings
from softway.march.results.step import Step
from softway.march.rules.slab_rule import Method
from softway.march.start.preparation import prepare
from softway.march.step_control import StepControl
from softway.meshes.adaptive.refinement import AdaptedMesh
from softway.model.model import Model
from softway.model.scene import Scene
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.remeshing.adapt import Adapt
from softway.remeshing.adapted_scene import AdaptedScene, adapted_scene
from softway.remeshing.carrying import carried_over
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.units import Second

AHEAD = 2.0
"""Time within which contacts count as soon closed, in those between two changes of the mesh."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AdaptedStep:
    """Slab on adapted meshes.

    Parameters
    ----------
    step
        The slab, on its meshes.
    model
        Model of the scene on these meshes.
    meshes
        Mesh of each solid of cells that can be bisected.
    transfers
        Transfers at the start of the slab, by solid; empty where the meshes have not changed.
    """

    step: Step
    model: Model
    meshes: Mapping[str, AdaptedMesh]
    transfers: Mapping[str, Transferred] = field(default_factory=dict)


def adaptive_march(
    scene: Scene,
    adapt: Mapping[str, Adapt],
    *,
    until: Second,
    step: Second,
    weight: TimeWeight = EndPeaks(),
    method: Method = FixedPoint(),
    control: StepControl = StepControl(),
    cancel: Cancel | None = None,
) -> Iterator[AdaptedStep]:
    """Accepted slabs of a march in which the meshes of some solids follow their waves.

    The meshes change between slabs.  Momentum, spin and energy pass from mesh to mesh (:mod:`softway.adaptivity`), and
    the energy balance of a step is that of the whole march; what changes of the meshes took, and no scalar has closed,
    is ``ledger.remeshing``.

    Parameters
    ----------
    scene
        The scene, with the base mesh of each solid.
    adapt
        Solids that adapt, by name.
    until, weight, method, control, cancel
        As for :func:`~softway.march.march.march`.
    step
        Slab length [s].

    Raises
    ------
    InputError
        For bodies whose meshes cannot adapt, and as for a march.
    NumericsError, Cancelled
        As for a march.

    Examples
    --------
    >>> import softway as sw
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=1.0,
    ...                velocity=sw.bodies.Uniform(value=1.0))
    >>> wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.1, normal=-1.0))
    >>> scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    >>> steps = list(adaptive_march(scene, {"bar": Adapt(levels=4)}, until=0.5, step=0.01))
    >>> abs(steps[-1].step.ledger.energy_error) < 1e-12
    True
    """
    if not adapt or isinstance(method, Explicit):
        what = "no solid" if not adapt else "Explicit, whose stable step the finest cell determines"
        raise InputError("adapt" if not adapt else "method", what, "a solid that adapts, and FixedPoint or Newton")
    settings = Settings(until=until, step=step, weight=weight, method=method, control=control)
    every, now = min(how.every for how in adapt.values()), None
    on = _first(adapted_scene(scene, adapt), adapt, settings, every)
    transfers: Mapping[str, Transferred] = {}
    energy = 0.0
    while now is None or now.state.time < until - 1e-9 * now.step_history.span:
        steps = march(
            on.model, until=until, step=step, weight=weight, method=method, state=now, control=control, cancel=cancel
        )
        for taken in islice(steps, every):
            now = taken.march_state
            energy = max(energy, taken.ledger.energy_kinetic + taken.ledger.energy_strain)
            yield AdaptedStep(step=taken, model=on.model, meshes=on.meshes, transfers=transfers)
            transfers = {}
        assert now is not None
        new = on.wanted(adapt, now, energy, AHEAD * every * now.step_history.span)
        if new is not on:
            now, transfers = carried_over(on, new, now)
            on = new


def _first(on: AdaptedScene, adapt: Mapping[str, Adapt], settings: Settings, every: int) -> AdaptedScene:
    """Scene on the meshes that its initial state asks for, from the base meshes two levels at a time."""
    for _ in range(1 + max(how.levels for how in adapt.values()) // 2):
        now: MarchState = prepare(on.model, settings).march_state
        energy = now.account.energy_start
        new = on.wanted(adapt, now, energy, AHEAD * every * now.step_history.span)
        if new is on:
            break
        on = new
    return on
