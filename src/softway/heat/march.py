"""March of heat conduction: slabs between the knots of loads, damped after sudden changes."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.errors import Cancel, InputError, NoConvergence, NumericsError, heed
from softway.heat.build_heat import build_heat
from softway.heat.fronts.front_slab import REMEDY, solve_front_slab
from softway.heat.fronts.places import Fronts, first_fronts, turned, with_latent
from softway.heat.heat_balance import Stage, put_at_once
from softway.heat.heat_model import HeatModel, HeatScene
from softway.heat.heat_slab import solve_slab
from softway.heat.ledger import HeatLedger, booked, opened
from softway.heat.loads.heat_plan import PlannedSlab, planned_slabs
from softway.heat.operators import HeatValues, entropy, heat_values, liquid_volumes, unknowns_of
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import LinearSolver
from softway.units import Second


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatState:
    """State of a march after a slab, from which another march may go on.

    Parameters
    ----------
    time
        [s].
    unknowns
        (n,) temperatures [K], above melting where cells melt, or specific contents [J/kg] where latent heat is at
        the nodes.
    ledger
        Ledger since the start.
    slabs
        Number of slabs since the start.
    fronts
        Fronts between the nodes of bars; None without.
    """

    time: float
    unknowns: Array
    ledger: HeatLedger
    slabs: int = 0
    fronts: Fronts | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatStep:
    """Slab of a march of heat conduction.

    Parameters
    ----------
    time, span
        Time of its end, and its length [s].
    temperature
        Body -> (n,) temperatures of its nodes [K].
    liquid
        Body that melts -> (e,) liquid share of its cells.
    liquid_volume
        Body that melts -> volume of its liquid [m^3]; fronts are known from it, not from an isotherm.
    ledger
        Heats.
    iterations
        Number of iterations of the slab.
    damped
        True for a slab of two halves whose heat flows at the temperature of their ends.
    entropy_produced
        Entropy that the slab produced [J/K]: that of the bodies gained, less what the heats of loads brought at the
        temperatures at which the heat flows in the slab.  It contains the error of the slab, which may be most of it
        where bodies have one temperature (docs/theory/heat/conduction.md), and is not negative but for such errors.
    state
        State for another march that goes on.
    """

    time: float
    span: float
    temperature: Mapping[str, Array]
    liquid: Mapping[str, Array]
    liquid_volume: Mapping[str, float]
    ledger: HeatLedger
    iterations: int
    damped: bool
    entropy_produced: float
    state: HeatState

    def march_state(self) -> HeatState:
        """State for another march, as the steps of other marches have it."""
        return self.state


def march_heat(
    scene: HeatScene | HeatModel,
    *,
    until: Second,
    step: Second,
    state: HeatState | None = None,
    damped: bool = True,
    linear: LinearSolver = SuperLU(),
    cancel: Cancel | None = None,
) -> Iterator[HeatStep]:
    """Slabs of heat conduction from the start, or from ``state``, to the time ``until``.

    Slabs end at the knots of the loads.  The heat flows at the mean temperature of a slab, which is of second order.
    The first slab, and the first one after a knot, is taken in two halves whose heat flows at the temperature of their
    ends, so that a sudden change does not ring.

    Parameters
    ----------
    scene
        Conductors with their loads, or a model built of them.
    until
        End time [s].
    step
        Length of the slabs [s], shortened to divide the times between knots evenly.
    state
        State after a step of another march of the same scene.  If it is the end of one of the slabs of a march from
        zero to ``until``, the march goes on as that one, with the same bits; else it begins anew there.
    damped
        False for no damped slab.
    linear
        Direct solver of models whose conductivity and capacity do not depend on the temperature.
    cancel
        Callback before every slab that may cancel the march.

    Raises
    ------
    InputError
        Before the first step: of :func:`~softway.heat.build_heat.build_heat`; a step or an end that is not after the
        start; a state of another scene.
    NumericsError
        If a slab does not converge at a 256th of its length either; earlier steps stay valid.
    Cancelled
        If ``cancel`` requests it.

    Examples
    --------
    >>> import softway as sw
    >>> law = sw.heat.Conduction(conductivity=50.0, capacity=500.0)
    >>> mesh = sw.meshes.Interval(length=0.1, cells=10)
    >>> bar = sw.heat.Conductor(mesh=mesh, law=law, density=7800.0, temperature=300.0)
    >>> heated = sw.heat.HeatFlux(on="bar.left", value=1e5)
    >>> *_, last = march_heat(sw.heat.HeatScene(bodies={"bar": bar}, loads=(heated,)), until=10.0, step=1.0)
    >>> round(last.ledger.heat_in, 3), last.ledger.relative_error < 1e-12
    (1000000.0, True)
    """
    model = build_heat(scene) if isinstance(scene, HeatScene) else scene
    unknowns = unknowns_of(model, model.initial) if state is None else state.unknowns
    begin = 0.0 if state is None else state.time
    if unknowns.shape != (model.n_nodes,):
        raise InputError("state", f"{len(unknowns)} nodes, the scene has {model.n_nodes}", "a state of the same scene")
    if not begin < until < np.inf:
        raise InputError("until", f"{until:g} s after a start at {begin:g} s", "a later time")
    if not 0.0 < step < np.inf:
        raise InputError("step", f"{step:g} s is not positive", "a positive time")
    start = _opening(model) if state is None else state
    return _slabs(model, start, planned_slabs(model, begin, until, step), damped, linear, cancel)


def heat_at_start(model: HeatModel) -> HeatStep:
    """State at the start of a march as a step of no slab, before prescribed temperatures act.

    Examples
    --------
    >>> import softway as sw
    >>> law = sw.heat.Conduction(conductivity=50.0, capacity=500.0)
    >>> mesh = sw.meshes.Interval(length=0.1, cells=1)
    >>> bar = sw.heat.Conductor(mesh=mesh, law=law, density=7800.0, temperature=300.0)
    >>> heat_at_start(build_heat(HeatScene(bodies={"bar": bar}))).temperature["bar"].tolist()
    [300.0, 300.0]
    """
    state = _opening(model)
    before = with_latent(model, state.fronts, heat_values(model, state.unknowns))
    return _step(model, state, before, _Told(0.0, 0, False, 0.0))


def _opening(model: HeatModel) -> HeatState:
    """State at the start."""
    unknowns = unknowns_of(model, model.initial)
    fronts = None if model.fronts is None else first_fronts(model.fronts, model.initial)
    whole = with_latent(model, fronts, heat_values(model, unknowns))
    ledger = opened(whole.content, _count(model), len(model.exchanges))
    return HeatState(time=0.0, unknowns=unknowns, ledger=ledger, fronts=fronts)


def _count(model: HeatModel) -> int:
    """Number of loads."""
    return len(model.surfaces) + len(model.sources) + len(model.held)


def _slabs(
    model: HeatModel,
    state: HeatState,
    planned: list[PlannedSlab],
    damped: bool,
    linear: LinearSolver,
    cancel: Cancel | None,
) -> Iterator[HeatStep]:
    """March over planned slabs."""
    ledger, factor, slabs, fronts = state.ledger, None, state.slabs, state.fronts
    bare = heat_values(model, state.unknowns)
    for slab in planned:
        heed(cancel, slab.start)
        standing = entropy(model, with_latent(model, fronts, bare))
        bare, jumped, carried = put_at_once(model, bare, slab.start)
        fronts = _turned(model, fronts, bare, slab.start)
        ledger = booked(ledger, with_latent(model, fronts, bare).content, _padded(model, jumped))
        calm = damped and slab.first
        stage = Stage(start=slab.start, span=slab.span, theta=1.0 if calm else 0.5)
        if model.fronts is None or fronts is None:
            found = solve_slab(model, bare, stage, calm, factor, linear)
        else:
            found, fronts = solve_front_slab(model, model.fronts, (bare, fronts), stage, calm)
        bare, factor = found.after, found.factor
        bare = bare if fronts is None else heat_values(model, bare.unknowns)
        after = with_latent(model, fronts, bare)
        ledger, slabs = booked(ledger, after.content, found.heats, found.passed), slabs + 1
        state = HeatState(time=slab.end, unknowns=bare.unknowns, ledger=ledger, slabs=slabs, fronts=fronts)
        produced = entropy(model, after) - standing - carried - found.entropy
        yield _step(model, state, after, _Told(slab.span, found.iterations, calm, produced))


def _turned(model: HeatModel, fronts: Fronts | None, bare: HeatValues, time: float) -> Fronts | None:
    """Fronts after prescribed temperatures have jumped to those of the other phase at a time [s]; None without."""
    if model.fronts is None or fronts is None:
        return None
    prescribed = np.flatnonzero(~model.free_nodes()).tolist()
    try:
        return turned(model, model.fronts, fronts, bare.temperature, prescribed)
    except NoConvergence as error:
        raise NumericsError(str(error), time, REMEDY) from None


def _padded(model: HeatModel, jumped: Array) -> Array:
    """Heats (k,) of all loads from those of the prescribed temperatures, the last ones."""
    return np.concatenate([np.zeros(_count(model) - len(jumped)), jumped])


@dataclass(frozen=True, slots=True)
class _Told:
    """What a slab tells: length [s], iterations, halves at the temperature of their ends, entropy produced [J/K]."""

    span: float
    iterations: int
    damped: bool
    produced: float


def _step(model: HeatModel, state: HeatState, after: HeatValues, told: _Told) -> HeatStep:
    """Step of a slab."""
    everywhere = model.everywhere(after.temperature)
    return HeatStep(
        time=state.time,
        span=told.span,
        temperature={part.name: everywhere[part.places] for part in model.parts},
        liquid={part.name: after.melted[part.cells] for part in model.parts if part.law.latent is not None},
        liquid_volume=liquid_volumes(model, after),
        ledger=state.ledger,
        iterations=told.iterations,
        damped=told.damped,
        entropy_produced=told.produced,
        state=state,
    )
