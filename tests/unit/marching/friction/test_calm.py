"""Filter of the velocity of sliding bodies: its eigenvalues, its ledger, what it stops and what it leaves alone."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import softway as sw
from softway.errors import InputError
from softway.marching.friction.calm import HeldMotion, calmed
from softway.marching.friction.flutter import sliding_flutter
from softway.marching.results.slab_result import SlabResult
from softway.marching.rules import equilibrated
from softway.marching.rules.slab_rule import Attempt
from softway.marching.start.initial_state import initial_state
from softway.marching.state.model_state import ModelState
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks
from softway.record.storage.serialisation import packed, unpacked
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory

MU, WEIGHT = 0.4, 1e-3
ELASTIC = sw.LinearElastic(E=1.0, nu=0.25)
NEO = sw.NeoHookean(E=1.0, nu=0.25)


def floor(velocity: tuple[float, float] = (0.0, 0.0), d: int = 2) -> sw.Tool:
    place, normal = (0.0,) * d, (0.0,) * (d - 1) + (1.0,)
    motion = sw.bodies.Translation(velocity=velocity) if any(velocity) else sw.bodies.Still()
    return sw.Tool(shape=sw.obstacles.HalfSpace(point=place, normal=normal), motion=motion)


def sliding(
    calm: float = 0.2,
    law: object = ELASTIC,
    mu: float = MU,
    shaken: float = 0.3,
    cells: tuple[int, ...] = (6, 4),
    weight: float = WEIGHT,
    speed: tuple[float, float] = (0.1, 0.0),
    tool: sw.Tool | None = None,
    **given: object,
) -> sw.Scene:
    """A block that slides steadily on a floor, pulled by as much as friction holds it back, and shaken at the start."""
    d = len(cells)
    pulled, faster = ((mu * weight, *(0.0,) * (d - 2), -weight), (speed[0], *(0.0,) * (d - 2), speed[1]))
    mesh = sw.meshes.Rectangle if d == 2 else sw.meshes.Box
    block = sw.Solid(
        mesh=mesh(size=(1.5, 1.0, 1.0)[:d], cells=cells),
        material=law,
        density=1.0,
        velocity=sw.bodies.Uniform(value=faster),
        **given,
    )
    rubs = sw.Contact(
        between=("block.bottom", "floor"),
        name="floor",
        friction=sw.Coulomb(mu=mu),
        timing=sw.contact.Energy(calm=calm),
    )
    return sw.Scene(
        bodies={"block": block, "floor": tool or floor(d=d)},
        contacts=(rubs,),
        loads=(sw.Gravity(acceleration=pulled),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=tuple(a * (1.0 + shaken) for a in pulled)),)),
    )


def one_slab(scene: sw.Scene, h: float) -> tuple[ModelState, Slab, SlabResult]:
    """The first slab, without the filter."""
    model = sw.build(scene)
    now, slab = initial_state(model), Slab(start=0.0, end=h, weight=EndPeaks())
    rule = replace(equilibrated.equilibrated(model, FixedPoint(), EndPeaks()), calm=0.0)
    within = model.during(now.start.states, h).pushed(0.0, h)
    return now, slab, next(rule.solve(within, now, slab, OperatorMemory(), Attempt()))[0]


def held(out: SlabResult, h: float) -> HeldMotion:
    return HeldMotion.of(out, h, np.ones(out.system.model.shape[0], bool))


def dense(out: SlabResult, h: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Components (k,) with inertia, their masses, and H (k, k), by dense algebra; normals of closed rows are held."""
    model = out.system.model
    n, d = model.shape
    stiffness = model.tangent(out.solution.end.displacement).toarray()
    mass = np.kron(model.mass.toarray(), np.eye(d))
    heavy, light = (np.flatnonzero(np.repeat(m, d)) for m in (model.massive, ~model.massive))
    rows = out.rows.gradient.toarray()[out.closed]
    zero = np.zeros((len(rows), len(rows)))
    inner = np.block([[stiffness[np.ix_(light, light)], rows[:, light].T], [rows[:, light], zero]])
    beside = np.concatenate([stiffness[np.ix_(light, heavy)], np.zeros((len(rows), len(heavy)))])
    condensed = stiffness[np.ix_(heavy, heavy)] - beside.T @ np.linalg.solve(inner, beside)
    inertia = mass[np.ix_(heavy, heavy)]
    elastic = 0.25 * h**2 * condensed
    return heavy, inertia, np.linalg.solve(inertia + elastic, elastic)


@pytest.mark.parametrize(
    ("scene", "h"),
    [(sliding(), 0.3), (sliding(), 30.0), (sliding(law=NEO, weight=0.02), 3.0), (sliding(cells=(3, 3, 3)), 3.0)],
)
def test_the_filter_is_that_of_the_condensed_stiffness(scene: sw.Scene, h: float) -> None:
    """Its eigenvalues are real, from 0 to less than 1, and it is self-adjoint in the product of the masses."""
    now, slab, out = one_slab(scene, h)
    assert (out.closed & out.friction.sliding).all()
    heavy, inertia, H = dense(out, h)
    squares = np.linalg.eigvals(H)
    assert np.abs(squares.imag).max() < 1e-10 and squares.real.min() > -1e-12 and squares.real.max() < 1.0
    assert np.abs(inertia @ H - (inertia @ H).T).max() < 1e-12 * np.abs(inertia).max()
    motion, shape = held(out, h), out.velocity.shape
    field = np.zeros(shape)
    field.ravel()[heavy] = np.random.default_rng(1).normal(size=len(heavy))
    found = motion.strained(field + motion.carried)
    field = field + motion.carried
    assert found.ravel()[heavy] == pytest.approx(H @ field.ravel()[heavy], abs=1e-10)
    filtered = calmed(now, slab, out, 0.3)
    v = out.velocity.ravel()[heavy]
    assert filtered.velocity.ravel()[heavy] == pytest.approx(v - 0.3 * H @ H @ v, abs=1e-12 * np.abs(v).max())
    assert (filtered.velocity[~out.system.model.massive] == out.velocity[~out.system.model.massive]).all()


@cache
def pressed() -> tuple[ModelState, Slab, SlabResult]:
    """A slab for random velocities at its end."""
    return one_slab(sliding(), 3.0)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**20), calm=st.floats(1e-3, 1.0), fast=st.floats(0.0, 1e3))
def test_no_velocity_gains_energy_nor_momentum_along_the_surface(seed: int, calm: float, fast: float) -> None:
    """The energy told is the one lost, also of fast bodies; the impulse across the surface is that of the contact."""
    now, slab, pushed = pressed()
    model = pushed.system.model
    v = np.random.default_rng(seed).normal(size=model.shape)
    out = calmed(now, slab, replace(pushed, velocity=v), calm)
    lost = model.kinetic(v).sum() - model.kinetic(out.velocity).sum()
    told = out.dissipation - pushed.dissipation
    assert told > 0.0 and told == pytest.approx(lost, rel=1e-9)
    gained = (model.mass @ (out.velocity - v)).sum(axis=0)
    assert abs(gained[0]) < 1e-13
    assert gained[1] == pytest.approx(3.0 * (out.force - pushed.force).sum(), abs=1e-12)
    assert gained == pytest.approx(3.0 * (out.push - pushed.push).sum(axis=0), abs=1e-12)
    moved = calmed(now, slab, replace(pushed, velocity=v + np.array([fast, 0.0])), calm)
    assert moved.dissipation - pushed.dissipation == pytest.approx(told, rel=1e-8)


def test_a_resolved_vibration_loses_the_fourth_power() -> None:
    """2 calm (h omega/2)^4 of its kinetic energy in a slab."""
    left = []
    for h in (0.2, 0.1):
        now, slab, out = one_slab(sliding(), h)
        model = out.system.model
        heavy, _, H = dense(out, h)
        values, modes = np.linalg.eig(H)
        slow = np.argmin(np.where(values.real > 1e-9, values.real, np.inf))
        v = np.zeros(model.shape)
        v.ravel()[heavy] = modes[:, slow].real
        lost = calmed(now, slab, replace(out, velocity=v), 0.1).dissipation - out.dissipation
        square = values.real[slow] / (1.0 - values.real[slow])
        left.append(lost / model.kinetic(v).sum() / (0.2 * square**2) - 1.0)
    assert abs(left[0]) < 0.05 and left[1] / left[0] == pytest.approx(0.25, rel=0.05)


@pytest.mark.parametrize("h", [8.0, 3.0, 1.0, 0.3])
@pytest.mark.parametrize("calm", [0.05, 0.2, 1.0])
def test_the_estimated_growth_is_that_of_the_slab(h: float, calm: float) -> None:
    """Against the eigenvalues of a slab of the trapezoidal rule with friction, then filtered; others do not grow."""
    scene = sliding(calm=0.0)
    _, _, out = one_slab(scene, h)
    model = out.system.model
    heavy, inertia, H = dense(out, h)
    stiffness = model.tangent(model.displacement).toarray()
    light, touch = np.flatnonzero(np.repeat(~model.massive, 2)), out.rows.node[out.closed]
    light = np.setdiff1d(light, 2 * touch + 1)
    force = stiffness.copy()
    force[2 * touch] += MU * stiffness[2 * touch + 1]
    sliding_block = stiffness[np.ix_(heavy, heavy)] - stiffness[np.ix_(heavy, light)] @ np.linalg.solve(
        force[np.ix_(light, light)], force[np.ix_(light, heavy)]
    )
    slope, eye = 0.25 * h**2 * np.linalg.solve(inertia, sliding_block), np.eye(len(heavy))
    step = np.linalg.solve(eye + slope, eye - slope)
    speed = np.linalg.solve(eye + slope, eye)
    quiet = eye - calm * H @ H
    whole = np.block([[step, h * speed], [-4.0 / h * quiet @ slope @ speed, quiet @ step]])
    found = np.abs(np.linalg.eigvals(whole)).max()
    told = max(mode.in_slabs(h, calm) for mode in sliding_flutter(model, initial_state(model)))
    assert found - 1.0 == pytest.approx(max(told - 1.0, 0.0), abs=2.5e-3)


def booked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[SlabResult, SlabResult]]:
    """Slabs of the following marches before and after the filter."""
    found: list[tuple[SlabResult, SlabResult]] = []

    def spied(now: ModelState, slab: Slab, out: SlabResult, calm: float) -> SlabResult:
        found.append((out, calmed(now, slab, out, calm)))
        return found[-1][1]

    monkeypatch.setattr(equilibrated, "calmed", spied)
    return found


def two(method: object) -> sw.Scene:
    """A small block that slides on a held one, from the instant at which the weight begins to act."""
    scene = sliding(cells=(3, 2))
    base = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(4.0, 1.0), cells=(7, 2), origin=(-0.6, -1.0)),
        material=ELASTIC,
        density=1.0,
        supports=(sw.bodies.Fixed(on="bottom"),),
    )
    rubs = replace(scene.contacts[0], between=("block.bottom", "base.top"), method=method)
    bodies = {"block": scene.bodies["block"], "base": base}
    return replace(scene, bodies=bodies, contacts=(rubs,), start=sw.model.AsGiven())


PUSHED = (
    sw.bodies.Driven(on="top", components="x", velocity=0.1),
    sw.bodies.Driven(on="top", components="y", velocity=-3e-4),
)
SCENES: dict[str, Callable[[], sw.Scene]] = {
    "plane": sliding,
    "neo-Hookean": lambda: sliding(law=NEO, weight=0.02),
    "space": lambda: sliding(cells=(3, 3, 3)),
    "moving floor": lambda: sliding(tool=floor((-1.0, 0.3)), speed=(0.0, 0.3)),
    "driven": lambda: sliding(supports=PUSHED, weight=0.01),
    "viscous, driven": lambda: sliding(
        law=sw.laws.Kelvin(E=1.0, nu=0.25, shear_viscosity=0.004, bulk_viscosity=0.006), supports=PUSHED, weight=0.01
    ),
    "two, nodes": lambda: two(sw.contact.NodeToSurface()),
    "two, mortar": lambda: two(sw.contact.DualMortar()),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_energy_taken_is_in_the_ledger(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found, h = booked(monkeypatch), 0.5 if "two" in name else 3.0
    steps = list(sw.march(SCENES[name](), until=20.0 * h, step=h))
    taken = np.array([after.dissipation - before.dissipation for before, after in found if after is not before])
    assert (taken >= 0.0).all() and taken.sum() > 1e-9 and len(taken) >= 15
    level = max(s.ledger.energy_kinetic + s.ledger.energy_strain + abs(s.ledger.work_external) for s in steps)
    assert max(abs(s.certificate.energy_error) for s in steps) < 1e-12 * level
    assert max(s.certificate.momentum_error for s in steps) < 1e-11 * np.abs(steps[0].ledger.momentum).max()
    assert not any(s.report.rejections for s in steps)


def test_a_floor_that_rises_steadily_changes_nothing() -> None:
    """The rule is the same for every observer."""
    still, rising = (
        list(sw.march(sliding(tool=floor((0.0, v)), speed=(0.1, v)), until=60.0, step=3.0)) for v in (0.0, 0.3)
    )
    for one, other in zip(still, rising, strict=True):
        assert other.after.pressure["floor"] == pytest.approx(one.after.pressure["floor"], abs=1e-8 * WEIGHT)


def test_newton_and_the_fixed_point_agree() -> None:
    one, other = (
        list(sw.march(sliding(law=NEO, weight=0.02), until=30.0, step=3.0, method=method))[-1]
        for method in (FixedPoint(), Newton())
    )
    v = one.after.velocity["block"]
    assert other.after.velocity["block"] == pytest.approx(v, abs=1e-8 * np.abs(v).max())


def test_a_march_goes_on_with_the_same_bits() -> None:
    for scene in (sliding(), sliding(law=NEO, weight=0.02)):
        whole = list(sw.march(scene, until=24.0, step=3.0))
        rest = list(sw.march(scene, until=24.0, step=3.0, state=unpacked(*packed(whole[3].march_state))))
        assert len(rest) == 4
        assert rest[-1].after.velocity["block"].tobytes() == whole[-1].after.velocity["block"].tobytes()
        assert rest[-1].ledger.dissipation == whole[-1].ledger.dissipation


def test_without_it_no_slab_is_filtered(monkeypatch: pytest.MonkeyPatch) -> None:
    found = booked(monkeypatch)
    list(sw.march(sliding(calm=0.0), until=6.0, step=3.0))
    assert found == []
    smooth = replace(sliding(), start=sw.model.AsGiven(), loads=())
    rubs = replace(smooth.contacts[0], friction=sw.laws.Frictionless())
    list(sw.march(replace(smooth, contacts=(rubs,)), until=6.0, step=3.0))
    assert len(found) == 2 and all(after is before for before, after in found)
    found.clear()
    resting = replace(sliding(mu=10.0, speed=(0.0, 0.0)), start=sw.model.AsGiven())
    list(sw.march(replace(resting, loads=(sw.Gravity(acceleration=(0.0, -WEIGHT)),)), until=6.0, step=3.0))
    assert len(found) == 2 and all(after is before for before, after in found)


def test_what_it_changes_is_of_third_order() -> None:
    """One more than the error of the rule: a block that shakes under sliding, with little friction."""
    changed = []
    for h in (0.1, 0.05):
        ends = [
            list(sw.march(sliding(calm=calm, mu=0.02, cells=(3, 2)), until=0.8, step=h))[-1].after.velocity["block"]
            for calm in (0.0, 1.0)
        ]
        changed.append(np.abs(ends[1] - ends[0]).max())
    assert changed[0] / changed[1] > 6.5


@pytest.mark.slow
def test_noise_is_gone_after_long_sliding() -> None:
    """Without the filter it grows by 1.015 in each of these slabs, see ``test_flutter.py``."""
    steps = sw.march(sliding(calm=0.1, shaken=1e-6, speed=(0.01, 0.0)), until=2100.0, step=3.0)
    forces = np.array([s.after.pressure["floor"] for s in steps])
    noise = np.abs(forces - forces[-50:].mean(axis=0)).max(axis=1) / (1.5 * WEIGHT)
    assert len(noise) == 700 and noise[0] > 1e-8 and noise[-50:].max() < 1e-9


@pytest.mark.parametrize("calm", [-0.1, 1.5, float("nan")])
def test_bad_values_are_refused(calm: float) -> None:
    with pytest.raises(InputError, match="from 0 to 1"):
        sw.contact.Energy(calm=calm)
