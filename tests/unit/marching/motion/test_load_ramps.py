"""Loads that change with time: impulses to the last digit, balances closed, load control without inertia."""

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError

PULSE = sw.bodies.Ramp(times=(0.0, 0.3, 0.5, 0.9), factors=(0.0, 1.0, 1.0, 0.0))


def block(**more: object) -> sw.Solid:
    """A square of unit stiffness and density."""
    return sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(5, 5)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        **more,
    )


def test_a_pulse_gives_its_impulse_and_the_energy_balance_closes() -> None:
    loads = (sw.Traction(on="b.top", value=(0.02, 0.01), ramp=PULSE), sw.Gravity(acceleration=(0.0, 0.01)))
    scene = sw.Scene(bodies={"b": block()}, loads=loads)
    *_, last = sw.march(scene, until=1.1, step=0.07)
    impulse = 0.5 * (0.3 + 0.4) + 0.2
    np.testing.assert_allclose(last.ledger.momentum[:2], [0.02 * impulse, 0.01 * impulse + 0.011], rtol=1e-12)
    assert abs(last.ledger.energy_error) < 1e-13 * last.ledger.work_external
    assert abs(last.certificate.momentum_error) < 1e-15


def test_it_presses_on_nodes_without_inertia() -> None:
    """A block on a floor, pressed down on its other side too, where nodes are candidates of a second contact."""
    wall = {
        "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0))),
        "roof": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 1.5), normal=(0.0, -1.0))),
    }
    contacts = (sw.Contact(between=("b.bottom", "floor")), sw.Contact(between=("b.top", "roof")))
    loads = (sw.Traction(on="b.top", value=(0.0, -0.05), ramp=PULSE),)
    scene = sw.Scene(bodies={"b": block(), **wall}, contacts=contacts, loads=loads)
    steps = list(sw.march(scene, until=2.0, step=0.05))
    assert abs(steps[-1].ledger.energy_error) < 1e-12 * 0.05
    assert max(abs(s.certificate.momentum_error) for s in steps) < 1e-13
    push = sum(s.ledger.contacts["b.bottom-floor"].force_n * (s.slab.end - s.slab.start) for s in steps)
    pull = 0.05 * 0.55
    assert push == pytest.approx(pull + steps[-1].ledger.momentum[1], rel=1e-4)  # ends count by the scalar


def test_central_differences_take_it_on_nodes_without_inertia() -> None:
    """The momentum to rounding: in half of each slab acts the force at its start, in the other half that at its end."""
    roof = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 9.0), normal=(0.0, -1.0)))
    scene = sw.Scene(
        bodies={"b": block(mass=sw.bodies.Lumped()), "roof": roof},
        contacts=(sw.Contact(between=("b.top", "roof")),),
        loads=(sw.Traction(on="b.top", value=(0.02, 0.01), ramp=PULSE),),
    )
    steps = list(sw.march(scene, until=1.1, step=0.05, method=sw.Explicit()))
    times = np.array([0.0, *(s.slab.end for s in steps)])
    impulse = np.trapezoid(np.interp(times, PULSE.times, PULSE.factors), times)
    np.testing.assert_allclose(steps[-1].ledger.momentum[:2], [0.02 * impulse, 0.01 * impulse], rtol=1e-12)
    assert not any(s.report.rejections for s in steps)


@pytest.mark.parametrize("method", [sw.FixedPoint(), sw.Explicit()], ids=["implicit", "explicit"])
def test_supports_of_nodes_without_inertia_carry_it(method: object) -> None:
    """The load acts on a fixed side whose nodes are candidates of a contact: it goes into the support, all of it."""
    roof = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 9.0), normal=(0.0, -1.0)))
    scene = sw.Scene(
        bodies={"b": block(mass=sw.bodies.Lumped(), supports=(sw.Fixed(on="top"),)), "roof": roof},
        contacts=(sw.Contact(between=("b.top", "roof")),),
        loads=(sw.Traction(on="b.top", value=(0.02, 0.01), ramp=PULSE),),
    )
    for s in sw.march(scene, until=1.1, step=0.05, method=method):
        pull = np.interp((s.slab.start, s.slab.end), PULSE.times, PULSE.factors).mean()
        np.testing.assert_allclose(s.reactions["b"].sum(axis=0), [-0.02 * pull, -0.01 * pull], atol=1e-16)
        assert not s.report.rejections and s.certificate.momentum_error < 1e-16


def test_load_control_without_inertia() -> None:
    """A plastic bar is pulled beyond its yield stress by a dead load, and let go: its strain is the plastic one.

    True stress and logarithmic strain: ``s = 1 + 10 p = 1.2 exp(p + 2 nu s/E)``, the section shrinks.
    """
    E, nu = 100.0, 0.3
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=2.0, cells=4),
        material=sw.J2(E=E, nu=nu, yield_stress=1.0, hardening=sw.laws.LinearHardening(modulus=10.0)),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    ramp = sw.bodies.Ramp(times=(0.0, 1.0, 2.0), factors=(0.0, 1.0, 0.0))
    loads = (sw.Traction(on="bar.right", value=1.2, ramp=ramp),)
    steps = list(sw.march(sw.Scene(bodies={"bar": bar}, loads=loads, inertia=sw.bodies.Off()), until=2.0, step=0.05))
    p = 0.0
    for _ in range(60):
        p = (1.2 * np.exp(p + 2.0 * nu * (1.0 + 10.0 * p) / E) - 1.0) / 10.0
    assert steps[-1].after.displacement["bar"][-1, 0] / 2.0 == pytest.approx(np.expm1(p), rel=1e-5)
    assert steps[-1].ledger.dissipation > 0.0
    assert abs(steps[-1].ledger.energy_error) < 1e-8 * steps[-1].ledger.dissipation


def test_bad_ramps_are_refused() -> None:
    with pytest.raises(InputError, match="do not increase"):
        sw.bodies.Ramp(times=(0.0, 0.0), factors=(0.0, 1.0))
    with pytest.raises(InputError, match="one for each"):
        sw.bodies.Ramp(times=(0.0, 1.0), factors=(0.0,))
