"""Fronts between the nodes of bars: Neumann's solution, fronts that meet, stand, turn round, and their ledger."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import erf

import softway as sw
from neumann import DENSITY, HEAT, MELTING, front, ice, neumann
from softway.arrays import Array
from softway.bodies.elements.front_cells import FrontCells
from softway.heat.fronts.places import first_fronts, overflowed, passed
from softway.meshes.generators.shapes import interval, rectangle

heat = sw.heat
EQUAL = heat.Conduction(conductivity=2.0, capacity=2000.0, latent=heat.Latent(heat=3e5, melting=MELTING))

TIN = 505.15


def melted(
    law: heat.Conduction, initial: float, loads: tuple[object, ...], until: float, step: float, cells: int = 20
) -> list[heat.HeatStep]:
    """March of a bar of 10 cm that begins some degrees above melting."""
    body = heat.Conductor(
        mesh=interval(0.1, cells=cells), law=law, density=DENSITY, temperature=MELTING + initial, latent="front"
    )
    return list(heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=loads), until=until, step=step))


def walls(left: float, right: float | None = None) -> tuple[heat.Temperature, ...]:
    """Prescribed temperatures of the ends, from melting."""
    ends = {"left": left, **({} if right is None else {"right": right})}
    return tuple(heat.Temperature(on=f"b.{end}", value=MELTING + value) for end, value in ends.items())


def closes(steps: list[heat.HeatStep]) -> bool:
    """True if the ledger closes to rounding in every slab."""
    return max(step.ledger.relative_error for step in steps) < 1e-12


@pytest.mark.slow
def test_water_freezes_as_neumann_found_within_hundredths_of_a_kelvin() -> None:
    steps = melted(ice(), 5.0, walls(-10.0), 3600.0, 10.0, cells=100)
    x, late = np.linspace(0.0, 0.1, 101), [step for step in steps if step.time > 600.0]
    missed = [(0.1 - step.liquid_volume["b"]) / front(step.time) - 1.0 for step in late]
    assert abs(missed[-1]) < 1e-3 and np.abs(missed).max() < 5e-3
    assert abs(steps[-1].temperature["b"][10] - MELTING + 5.069627568716798) < 5e-3
    assert max(np.abs(step.temperature["b"] - neumann(x, step.time)).max() for step in late) < 0.05
    assert closes(steps) and min(step.entropy_produced for step in steps) > 0.0


@pytest.mark.slow
def test_the_front_converges_with_the_slab_where_cells_are_small() -> None:
    errors = []
    for step in (80.0, 20.0):
        last = melted(ice(), 5.0, walls(-10.0), 1800.0, step, cells=50)[-1]
        errors.append(abs((0.1 - last.liquid_volume["b"]) / front(1800.0) - 1.0))
    assert errors[1] < 0.5 * errors[0] and errors[1] < 3e-3


def test_two_ends_of_one_cell_that_change_phase_are_refused_with_their_place() -> None:
    """Where there are more cells, the march goes on: a front for each end."""
    ends = walls(-10.0, -10.0)
    with pytest.raises(sw.errors.NumericsError, match="two fronts in a cell .* at node 0 of 'b'") as found:
        melted(ice(), 5.0, ends, 20.0, 10.0, cells=1)
    assert found.value.when == 0.0 and 'latent = "cell"' in found.value.remedy and "smaller" in found.value.remedy
    steps = melted(ice(), 5.0, ends, 20.0, 10.0, cells=4)
    assert closes(steps) and steps[-1].liquid_volume["b"] < 0.1


@pytest.mark.slow
def test_fronts_from_both_ends_meet_in_the_middle() -> None:
    steps = melted(ice(), 5.0, walls(-10.0, -10.0), 30000.0, 400.0)
    assert max(np.abs(step.temperature["b"] - step.temperature["b"][::-1]).max() for step in steps) < 1e-4
    assert closes(steps) and steps[-1].liquid_volume["b"] == pytest.approx(0.0, abs=1e-15)
    volumes = [step.liquid_volume["b"] for step in steps]
    assert all(after <= before + 1e-12 for before, after in zip(volumes, volumes[1:], strict=False))
    assert steps[-1].ledger.heat_out == pytest.approx(100.0 * (HEAT + 4226.0 * 5.0 + 1762.0 * 10.0), rel=1e-6)


def test_a_bar_that_is_heated_evenly_melts_and_freezes_all_at_once() -> None:
    """Every node waits with its own latent heat: the temperature is exact."""
    power = heat.HeatSource(
        of="b", value=1e6, ramp=sw.bodies.Ramp(times=(0.0, 200.0, 200.001), factors=(1.0, 1.0, -1.0))
    )
    steps = melted(ice(), -2.0, (power,), 500.0, 10.0)
    for step in steps:
        given = 1e3 * (step.time if step.time <= 200.0 else 400.001 - step.time)
        molten = min(max((given - 2.0 * 1762.0) / HEAT, 0.0), 1.0)
        assert step.liquid_volume["b"] == pytest.approx(0.1 * molten, abs=1e-9)
        solid = MELTING + min(given / 1762.0 - 2.0, 0.0)
        np.testing.assert_allclose(step.temperature["b"], solid, rtol=0.0, atol=1e-6)
    assert closes(steps)


@pytest.mark.slow
def test_a_front_stands_at_a_node() -> None:
    """Between walls equally far from melting the front ends in the middle, which is a node."""
    steps = melted(EQUAL, 10.0, walls(-10.0, 10.0), 4e5, 4000.0)
    assert closes(steps) and steps[-1].liquid_volume["b"] == pytest.approx(0.05, abs=1e-8)
    np.testing.assert_allclose(steps[-1].temperature["b"], MELTING + np.linspace(-10.0, 10.0, 21), atol=1e-6)


@pytest.mark.slow
def test_a_wall_that_is_cold_and_warm_in_turns_agrees_with_cut_cells() -> None:
    """Layers that melt and freeze again from the wall, while a front is deeper in the bar, or in the same cell."""
    turns = sw.bodies.Ramp(
        times=tuple(600.0 * k for k in range(6)), factors=tuple(MELTING + (-10.0 if k % 2 else 10.0) for k in range(6))
    )
    wall = heat.Temperature(on="b.left", value=1.0, ramp=turns)
    steps = melted(ice(), 5.0, (wall,), 3000.0, 20.0, cells=40)
    body = heat.Conductor(mesh=interval(0.1, cells=100), law=ice(), density=DENSITY, temperature=MELTING + 5.0)
    *_, cut = heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=(wall,)), until=3000.0, step=10.0)
    assert closes(steps) and steps[-1].liquid_volume["b"] == pytest.approx(cut.liquid_volume["b"], abs=1e-3)


def test_a_march_goes_on_with_the_same_bits() -> None:
    body = heat.Conductor(
        mesh=interval(0.1, cells=20), law=ice(), density=DENSITY, temperature=MELTING + 5.0, latent="front"
    )
    scene = heat.HeatScene(bodies={"b": body}, loads=walls(-10.0))
    whole = list(heat.march_heat(scene, until=600.0, step=20.0))
    rest = list(heat.march_heat(scene, until=600.0, step=20.0, state=whole[13].state))
    assert len(rest) == len(whole) - 14
    assert all((a.temperature["b"] == b.temperature["b"]).all() for a, b in zip(whole[14:], rest, strict=True))
    assert whole[-1].ledger == rest[-1].ledger


def tin(
    loads: tuple[object, ...], until: float, step: float, *, start: float = 0.0, capacity: float = 240.0,
    cells: int = 4, length: float = 0.02, state: heat.HeatState | None = None,
) -> list[heat.HeatStep]:  # fmt: skip
    """March of a bar of tin that starts some degrees above melting."""
    law = heat.Conduction(conductivity=60.0, capacity=capacity, latent=heat.Latent(heat=6e4, melting=TIN))
    body = heat.Conductor(
        mesh=interval(length, cells=cells), law=law, density=7300.0, temperature=TIN + start, latent="front"
    )
    scene = heat.HeatScene(bodies={"b": body}, loads=loads)
    return list(heat.march_heat(scene, until=until, step=step, state=state))


def fluxes(left: float, right: float = 0.0) -> tuple[heat.HeatFlux, ...]:
    """Heat fluxes into both ends."""
    return tuple(heat.HeatFlux(on=f"b.{end}", value=value) for end, value in (("left", left), ("right", right)))


def stefan(number: float, times: Array) -> Array:
    """Front of the one-phase problem of Stefan in tin (Carslaw and Jaeger, chapter XI)."""
    root = brentq(lambda x: x * np.exp(x * x) * erf(x) - number / np.sqrt(np.pi), 1e-6, 2.0, xtol=1e-14)
    return np.asarray(2.0 * root * np.sqrt(60.0 / (240.0 * 7300.0) * times))


@pytest.mark.slow
@pytest.mark.few(2)
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("number", [0.1, 1.0])
def test_the_front_of_stefan_from_the_temperature_of_melting_is_of_first_order(number: float, sign: float) -> None:
    """Solid at melting before a warm end; and liquid at melting, a microkelvin above it, before a cold one."""
    wall = (heat.Temperature(on="b.left", value=TIN + sign * number * 250.0),)
    errors = []
    for cells, step in ((20, 2.0), (40, 0.5)):
        steps = tin(wall, 40.0, step, start=1e-6 if sign < 0.0 else 0.0, cells=cells, length=0.1)
        changed = steps[-1].liquid_volume["b"] if sign > 0.0 else 0.1 - steps[-1].liquid_volume["b"]
        errors.append(abs(changed / stefan(number, np.array(40.0)) - 1.0))
        ahead = np.linspace(0.0, 0.1, cells + 1) > changed + 0.1 / cells
        np.testing.assert_allclose(steps[-1].temperature["b"][ahead], TIN, rtol=0.0, atol=2e-6)
        assert closes(steps)
    assert errors[0] < 1.2e-2 and errors[1] < 0.4 * errors[0]


@pytest.mark.parametrize("start", [0.0, 1e-13, -1e-13, -1e-10, -1e-7])
def test_a_flux_into_a_bar_at_melting_makes_one_front_whatever_the_last_bits(start: float) -> None:
    steps = tin(fluxes(1e5), 21.0, 1.0, start=start)
    warm, *ahead = steps[-1].temperature["b"] - TIN
    share = (1e5 * 21.0 - 7300.0 * 240.0 * 0.0025 * warm) / (7300.0 * 6e4 * 0.005)
    np.testing.assert_allclose(steps[-1].liquid["b"], [share, 0.0, 0.0, 0.0], rtol=0.0, atol=1e-6)
    assert warm == pytest.approx(1e5 * 0.005 * share / 60.0, rel=0.03)  # the node takes some of the flux
    assert closes(steps) and np.abs(ahead).max() < 2e-7


@pytest.mark.parametrize("start", [0.0, -0.01])
@pytest.mark.parametrize("capacity", [1e-3, 1e-6])
def test_without_capacity_all_heat_of_a_flux_is_the_fronts(capacity: float, start: float) -> None:
    """The front is at q t over the latent heat, but for the heat of the liquid, 1e-7 of it; with a linear fall."""
    steps = tin(fluxes(1e5), 40.0, 1.0, start=start, capacity=capacity)
    for step in steps:
        way = 1e5 * step.time / (7300.0 * 6e4)
        assert step.liquid_volume["b"] == pytest.approx(way, rel=4e-4 * capacity + 1e-9)
        fall = TIN + 1e5 / 60.0 * np.maximum(way - np.linspace(0.0, 0.02, 5), 0.0)
        np.testing.assert_allclose(step.temperature["b"], fall, rtol=0.0, atol=2e-2)


@pytest.mark.slow
@pytest.mark.few(4)
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("cells", [2, 4, 5])
def test_both_ends_of_a_bar_at_melting_have_their_front(cells: int, sign: float) -> None:
    steps = tin(fluxes(sign * 1e5, sign * 1e5), 80.0, 1.0, start=1e-6 if sign < 0.0 else 0.0, cells=cells)
    early = steps[cells]
    changed = early.liquid["b"] if sign > 0.0 else 1.0 - early.liquid["b"]
    assert changed[0] > 0.0 and changed[-1] == pytest.approx(changed[0]) and not changed[1:-1].any()
    assert closes(steps) and steps[-1].liquid_volume["b"] == pytest.approx(0.02 if sign > 0.0 else 0.0, abs=1e-15)


def test_a_source_from_melting_on_makes_all_of_a_bar_mushy() -> None:
    steps = tin((heat.HeatSource(of="b", value=5e6),), 80.0, 4.0)
    for step in steps:
        np.testing.assert_allclose(step.liquid["b"], 5e6 * step.time / (7300.0 * 6e4), rtol=1e-9)
        np.testing.assert_allclose(step.temperature["b"], TIN, rtol=0.0, atol=1e-6)


def test_a_mushy_bar_that_is_cooled_at_its_end_is_solid_as_far_as_heat_is_drawn() -> None:
    """At rest the source of the solid part, one half here, is what flows out: a parabola of q x^2 / 2 k."""
    steps = tin((heat.HeatSource(of="b", value=5e6), *fluxes(-5e4)), 80.0, 1.0)
    depth = np.maximum(0.01 - np.linspace(0.0, 0.02, 5), 0.0)
    np.testing.assert_allclose(steps[-1].temperature["b"], TIN - 5e6 * depth**2 / 120.0, rtol=0.0, atol=0.1)
    assert closes(steps)


def test_a_march_from_melting_goes_on_with_the_same_bits() -> None:
    whole = tin(fluxes(1e5), 30.0, 1.0)
    rest = tin(fluxes(1e5), 30.0, 1.0, state=whole[9].state)
    assert all((a.temperature["b"] == b.temperature["b"]).all() for a, b in zip(whole[10:], rest, strict=True))
    assert whole[-1].ledger == rest[-1].ledger


CELLS = FrontCells(
    nodes=np.array([[0, 1], [1, 2], [2, 3]]), numbers=np.arange(3), latent=np.ones(3), solid=np.ones(3),
    liquid=np.ones(3), melting=np.full(4, MELTING), capacity=np.ones(4), phases=(),
)  # fmt: skip


def test_what_is_left_between_two_fronts_is_a_pocket() -> None:
    fronts = first_fronts(CELLS, MELTING + np.array([-1.0, 3.0, -1.0, -1.0]))
    np.testing.assert_allclose(fronts.share, [0.75, 0.75, np.nan])
    closed = passed(CELLS, fronts, (1,))
    assert closed.latent_heat(CELLS) == pytest.approx(fronts.latent_heat(CELLS))
    assert np.isnan(closed.share).all() and not closed.liquid.any() and closed.pocket[1] == 1.5
    opened = overflowed(CELLS, closed, (1,))
    assert opened.liquid[1] and np.isnan(opened.pocket).all()
    np.testing.assert_allclose(opened.share, [0.75, 0.75, np.nan])


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"mesh": rectangle((1.0, 1.0), (1, 1))}, "latent"),
        ({"mesh": interval(0.1, cells=2, cell="bar3")}, "latent"),
        ({"law": ice(0.5)}, "latent"),
        ({"density": {"low": 1.0, "high": 2.0}}, "latent"),
        (
            {"law": heat.Conduction(
                conductivity=heat.TemperatureTable(temperatures=(200.0, 300.0), values=(2.0, 3.0)), capacity=2e3,
                latent=EQUAL.latent,
            )},
            "law.conductivity",
        ),
    ],
)  # fmt: skip
def test_fronts_are_refused_where_they_would_be_wrong(change: dict[str, object], where: str) -> None:
    mesh = (
        interval(0.1, cells=2)
        .with_region("low", lambda p: p[:, 0] < 0.05)
        .with_region("high", lambda p: p[:, 0] > 0.05)
    )
    given = {"mesh": mesh, "law": EQUAL, "density": DENSITY, "temperature": 280.0, "latent": "front", **change}
    with pytest.raises(sw.InputError, match=where):
        list(heat.march_heat(heat.HeatScene(bodies={"b": heat.Conductor(**given)}), until=1.0, step=1.0))
