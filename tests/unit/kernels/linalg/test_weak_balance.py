"""Heats of weakly coupled nodes balanced by a kernel, against the balance by arrays."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.heat.build_heat import build_heat
from softway.heat.coupled.strain.free_strain import FreeStrain
from softway.heat.coupled.strain.moduli import ElasticHeat, Moduli
from softway.heat.coupled.strain.weak_heat import balanced_heats
from softway.heat.heat_balance import Stage, balance, put_at_once, rounding
from softway.heat.heat_slab import is_weak, linear_factor, solve_stage
from softway.heat.operators import heat_values, unknowns_of
from softway.meshes.generators.shapes import rectangle

heat = sw.heat
SPAN = 1e-3
LAW = heat.Conduction(conductivity=0.2, capacity=1.0)
LOADS = {
    "none": (),
    "temperature": (heat.Temperature(on="a.left", value=340.0),),
    "flux and source": (heat.HeatFlux(on="a.top", value=20.0), heat.HeatSource(of="b", value=-30.0)),
    "fluid": (heat.Convection(on="b.right", coefficient=4.0, ambient=500.0),),
}


def problem(loads: tuple[object, ...], theta: float, inert: bool, conductance: float = 3.0):
    """Two plates that exchange heat, in a stage in which they deform."""
    mesh = rectangle((1.0, 0.5), (6, 3))
    above = replace(mesh, points=mesh.points + np.array([0.0, 0.5]))
    plates = {
        "a": heat.Conductor(mesh=mesh, law=LAW, density=2.0, temperature=300.0),
        "b": heat.Conductor(mesh=above, law=LAW, density=2.0, temperature=350.0),
    }
    contact = heat.HeatContact(between=("a.top", "b.bottom"), conductance=conductance)
    model = build_heat(heat.HeatScene(bodies=plates, loads=loads, contacts=(contact,)))
    n, rng = model.n_nodes, np.random.default_rng(5)
    free = FreeStrain(reference=model.initial, liquid=np.zeros(n), coefficient=np.full(n, 1e-3), melting=np.zeros(n))
    rates = np.stack([model.capacity * rng.normal(size=n) / SPAN, np.zeros(n)])
    strain = ElasticHeat(
        moduli=Moduli(free=free), amounts=np.zeros((2, n)), rates=rates, power=model.capacity * rng.random(n) / SPAN,
        inert=inert,
    )  # fmt: skip
    stage = Stage(start=0.0, span=SPAN, theta=theta, strain=strain)
    before, _, _ = put_at_once(model, heat_values(model, unknowns_of(model, model.initial)), 0.0)
    return model, before, stage, strain


@pytest.mark.parametrize("loads", LOADS)
@pytest.mark.parametrize(("theta", "inert"), [(0.5, True), (1.0, False)])
def test_kernel_agrees_with_arrays(loads: str, theta: float, inert: bool) -> None:
    model, before, stage, strain = problem(LOADS[loads], theta, inert)
    assert is_weak(linear_factor(model, theta * SPAN))
    exact = solve_stage(model, before, stage)
    floor = rounding(model, before, stage)
    found = balanced_heats(model, before, stage, strain, before.unknowns, floor)
    assert found is not None
    change = np.abs(exact.after.temperature - before.temperature).max()
    assert change > 0.1
    off = np.abs(found.after.temperature - exact.after.temperature).max()
    assert off <= (1e-14 * found.moved + floor) / model.capacity.min()
    again = balance(model, before, stage, found.after.temperature, slopes=False)
    assert np.abs(again.values[model.free_nodes()]).sum() <= 0.5 * (1e-14 * again.moved + floor)
    for one, other in ((found.values, again.values), (found.flow, again.flow), (found.mean, again.mean)):
        assert np.abs(one - other).max() <= 1e-13 * max(np.abs(other).max(), again.moved)
    assert found.moved == pytest.approx(again.moved, rel=0.2)
    assert found.strain is not None and again.strain is not None
    assert np.abs(found.strain.work - again.strain.work).max() <= 1e-13 * np.abs(again.strain.work).max()


def test_a_start_far_away_is_corrected() -> None:
    model, before, stage, strain = problem((), 0.5, True)
    near, far = (balanced_heats(model, before, stage, strain, before.unknowns + t, 0.0) for t in (0.0, 50.0))
    assert near is not None and far is not None
    assert np.abs(near.after.temperature - far.after.temperature).max() <= 8 * np.spacing(500.0)


def test_temperatures_below_zero_are_no_solution() -> None:
    model, before, stage, strain = problem((), 0.5, True)
    cooled = replace(strain, power=-1000.0 * model.capacity / SPAN)
    assert balanced_heats(model, before, replace(stage, strain=cooled), cooled, before.unknowns, 0.0) is None
