"""March of a scene: accepted slabs (time steps), on meshes that stay, adapt or are replaced."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

from softway.errors import Cancel
from softway.heat.coupled.build import build
from softway.marching.remeshing.adaptive_march import adaptive_march
from softway.marching.remeshing.admitted import adaptions, admitted
from softway.marching.remeshing.forming.formable import formable, replacements
from softway.marching.remeshing.forming.forming_march import forming_march
from softway.marching.results.step import Step
from softway.marching.results.trying import TryWatch
from softway.marching.rules.slab_rule import Method
from softway.marching.slab.step_group import StepGroup, in_steps
from softway.marching.slabs import groups
from softway.marching.start.preparation import prepare
from softway.marching.start.slab_tolerance import slab_tolerance
from softway.marching.state.march_state import MarchState, Settings
from softway.marching.state.step_control import StepControl
from softway.model.model import Model
from softway.model.scene import Scene, State
from softway.model.time_weight import EndPeaks, TimeWeight
from softway.solve.methods.fixed_point import FixedPoint
from softway.units import Second


def march(
    scene: Scene | Model,
    *,
    until: Second,
    step: Second | Literal["auto"] = "auto",
    weight: TimeWeight = EndPeaks(),
    method: Method = FixedPoint(),
    state: State | MarchState | None = None,
    control: StepControl = StepControl(),
    tolerance: float | Literal["auto", "off"] = "auto",
    cancel: Cancel | None = None,
    trying: TryWatch | None = None,
) -> Iterator[Step]:
    """Accepted slabs from the start, or from ``state``, to the time ``until``.

    Parameters
    ----------
    scene
        Scene, or a built model.  Meshes of solids with :class:`~softway.meshes.adaptive.adapt.Adapt`, or with
        :class:`~softway.meshes.remeshed.remesh.Remesh`, change between slabs (docs/theory/bodies/adaptive.md,
        docs/theory/bodies/remeshing.md); each step has its model.
    until
        End time [s].
    step
        Slab length [s], shortened to divide the duration evenly, and the times between the knots of loads and
        prescribed motions (``control.knots``); ``auto`` is the time in which a wave crosses the
        shortest edge, divided by the square root of 2: there the leading dispersion of a consistent mass and of the end
        peaks cancel (docs/theory/time/time.md).  Without inertia it is the time in which tools and driven supports move
        by a quarter of the shortest edge, at most a twentieth of the duration.
    weight
        Virtual time function.
    method
        Fixed point, Newton, or explicit method.
    state
        Initial state: a state, or the march state of another march after a step, ``step.march_state``; by default the
        start of the scene.
    control
        Limits of a slab; a slab that exceeds them is tried again with half the length.
    tolerance
        Error of the mean velocity of a node in a slab, relative to the greatest velocity so far, up to which slabs grow
        beyond ``step``: to two, four, ... ``control.longest`` lengths, in smooth motion without events
        (docs/theory/time/control.md).  ``auto`` is 1e-3 for the step ``auto``, where something estimates the error,
        and off for a given step; ``off`` for slabs of the length ``step``.
    cancel
        Callback at every iteration, from the first equilibrium on, that may cancel the march.
    trying
        Callback with a :class:`~softway.marching.results.trying.Trying` after every iteration in a slab.

    Raises
    ------
    InputError
        Before the first step: if the step is beyond the stability limit, a body starts inside an obstacle, or nothing
        estimates the error of a slab that a tolerance asks for.
    NumericsError
        If a slab fails at every attempted length; earlier steps stay valid.
    Cancelled
        If ``cancel`` requests it; earlier steps stay valid.

    Examples
    --------
    >>> import softway as sw
    >>> bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=2), material=sw.LinearElastic(E=1.0), density=1.0,
    ...                velocity=sw.bodies.Uniform(value=1.0))
    >>> wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.25, normal=-1.0))
    >>> scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    >>> steps = list(march(scene, until=4.0, step=0.05))
    >>> abs(steps[-1].ledger.energy_error) < 1e-12
    True
    """
    model = _admitted(scene, method)
    bound = slab_tolerance(model, step, tolerance, weight, method)
    settings = Settings(until=until, step=step, weight=weight, method=method, control=control, tolerance=bound)
    return in_steps(_groups(model, settings, state, cancel, trying), cancel)


def march_in_groups(
    scene: Scene | Model, settings: Settings, *, state: State | MarchState | None = None, trying: TryWatch | None = None
) -> Iterator[Step | StepGroup]:
    """March as :func:`march` does, with slabs that were compiled together as one group.

    A group has the numbers of its slabs as arrays, and makes steps of those for which it is asked.
    """
    model = _admitted(scene, settings.method)
    bound = slab_tolerance(model, settings.step, settings.tolerance or "off", settings.weight, settings.method)
    return _groups(model, replace(settings, tolerance=bound), state, None, trying)


def _admitted(scene: Scene | Model, method: Method) -> Model:
    """Model of a scene, with meshes that may change where the method bears it."""
    model = scene if isinstance(scene, Model) else build(scene)
    return formable(admitted(model, method)[0], method)[0]


def _groups(
    model: Model,
    settings: Settings,
    state: State | MarchState | None,
    cancel: Cancel | None,
    trying: TryWatch | None,
) -> Iterator[Step | StepGroup]:
    """Slabs on meshes that stay, adapt or are replaced."""
    if adaptions(model.scene):
        return adaptive_march(model, settings, state, cancel, trying)
    if replacements(model.scene):
        return forming_march(model, settings, state, cancel, trying)
    prepared = prepare(model, settings, state, cancel, trying)
    return groups(prepared.stepper, prepared.march_state)
