"""Exchange of heat between bodies that touch: exact steady flows, meshes that do not match, the ledger."""

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.meshes.generators.shapes import box, interval, rectangle

heat = sw.heat
FIRST = heat.Conduction(conductivity=2.0, capacity=1.0)
SECOND = heat.Conduction(conductivity=5.0, capacity=3.0)
COLD, HOT, CONDUCTANCE = 300.0, 400.0, 4.0
FLUX = (HOT - COLD) / (1.0 / 2.0 + 1.0 / CONDUCTANCE + 1.0 / 5.0)
"""Steady heat flux through a metre of each body and the contact between them."""


def moved(mesh: sw.Mesh) -> sw.Mesh:
    shift = np.zeros(mesh.dim)
    shift[0] = 1.0
    return sw.Mesh(points=mesh.points + shift, blocks=mesh.blocks, tags=mesh.tags)


def marched(one: sw.Mesh, other: sw.Mesh, until: float = 40.0) -> list[heat.HeatStep]:
    bodies = {
        "a": heat.Conductor(mesh=one, law=FIRST, density=1.0, temperature=COLD),
        "b": heat.Conductor(mesh=moved(other), law=SECOND, density=1.0, temperature=COLD),
    }
    loads = heat.Temperature(on="a.left", value=HOT), heat.Temperature(on="b.right", value=COLD)
    contact = heat.HeatContact(between=("a.right", "b.left"), conductance=CONDUCTANCE)
    scene = heat.HeatScene(bodies=bodies, loads=loads, contacts=(contact,))
    return list(heat.march_heat(scene, until=until, step=0.5))


MESHES = {
    "bars": (interval(1.0, cells=4), interval(1.0, cells=3)),
    "matching": (rectangle((1.0, 1.0), (3, 3)), rectangle((1.0, 1.0), (2, 3), cell="tri3")),
    "other meshes": (rectangle((1.0, 1.0), (3, 7)), rectangle((1.0, 1.0), (2, 3))),
    "quadratic": (rectangle((1.0, 1.0), (2, 3), cell="quad8"), rectangle((1.0, 1.0), (2, 2), cell="tri6")),
    "in space": (box((1.0, 1.0, 1.0), (2, 3, 3), cell="tet4"), box((1.0, 1.0, 1.0), (2, 2, 2))),
}


@pytest.mark.parametrize(
    ("name", "error"),
    [("bars", 1e-7), ("matching", 1e-7), ("other meshes", 1e-4), ("quadratic", 2e-4), ("in space", 2e-3)],
)
def test_a_steady_flow_passes_through_the_contact(name: str, error: float) -> None:
    """A plane flow is exact on meshes that match, and nearly so on others."""
    one, other = MESHES[name]
    *_, before, last = marched(one, other)
    assert last.ledger.by_contact[0] - before.ledger.by_contact[0] == pytest.approx(0.5 * FLUX, rel=error)
    assert last.temperature["a"] == pytest.approx(HOT - FLUX / 2.0 * one.points[:, 0], abs=1e-3 + 3e3 * error)
    assert last.temperature["b"] == pytest.approx(
        COLD + FLUX / 5.0 * (1.0 - other.points[:, 0]), abs=1e-3 + 3e3 * error
    )
    assert last.ledger.relative_error < 1e-12


def test_smaller_cells_bring_the_flow_through_other_meshes_closer() -> None:
    missed = []
    for fine in (1, 2):
        steps = marched(rectangle((1.0, 1.0), (3, 3 * fine)), rectangle((1.0, 1.0), (2, 2 * fine)))
        passed = steps[-1].ledger.by_contact[0] - steps[-2].ledger.by_contact[0]
        missed.append(abs(passed / (0.5 * FLUX) - 1.0))
    assert missed[1] < 0.4 * missed[0]


def test_what_passes_the_contact_is_what_the_second_body_gains() -> None:
    one, other = MESHES["other meshes"]
    bodies = {
        "a": heat.Conductor(mesh=one, law=FIRST, density=1.0, temperature=HOT),
        "b": heat.Conductor(mesh=moved(other), law=SECOND, density=1.0, temperature=COLD),
    }
    contact = heat.HeatContact(between=("a.right", "b.left"), conductance=CONDUCTANCE)
    steps = list(heat.march_heat(heat.HeatScene(bodies=bodies, contacts=(contact,)), until=40.0, step=0.25))
    mean = (1.0 * HOT + 3.0 * COLD) / 4.0
    assert steps[-1].temperature["a"] == pytest.approx(np.full(one.n_nodes, mean), abs=1e-4)
    assert steps[-1].ledger.by_contact[0] == pytest.approx(3.0 * (mean - COLD), rel=1e-6)
    assert steps[-1].ledger.heat_in == 0.0 and abs(steps[-1].ledger.error) < 1e-9
    assert min(step.entropy_produced for step in steps) > -1e-10


def test_a_large_conductance_is_one_body() -> None:
    halves = marched(interval(1.0, cells=20), interval(1.0, cells=20))
    law = heat.Conduction(conductivity=2.0, capacity=1.0)
    contact = heat.HeatContact(between=("a.right", "b.left"), conductance=1e9)
    bodies = {
        "a": heat.Conductor(mesh=interval(1.0, cells=20), law=law, density=1.0, temperature=COLD),
        "b": heat.Conductor(mesh=moved(interval(1.0, cells=20)), law=law, density=1.0, temperature=COLD),
    }
    loads = (heat.Temperature(on="a.left", value=HOT),)
    *_, both = heat.march_heat(heat.HeatScene(bodies=bodies, loads=loads, contacts=(contact,)), until=0.5, step=0.01)
    whole = heat.Conductor(mesh=interval(2.0, cells=40), law=law, density=1.0, temperature=COLD)
    *_, one = heat.march_heat(heat.HeatScene(bodies={"a": whole}, loads=loads), until=0.5, step=0.01)
    joined = np.concatenate([both.temperature["a"], both.temperature["b"][1:]])
    assert joined == pytest.approx(one.temperature["a"], abs=1e-5)
    assert halves[-1].temperature["a"][-1] > halves[-1].temperature["b"][0] + 1.0


def test_surfaces_that_do_not_touch_are_refused() -> None:
    bar = heat.Conductor(mesh=interval(1.0, cells=2), law=FIRST, density=1.0, temperature=COLD)
    contact = heat.HeatContact(between=("a.right", "b.right"), conductance=1.0)
    far = heat.Conductor(mesh=moved(interval(1.0, cells=2)), law=FIRST, density=1.0, temperature=COLD)
    with pytest.raises(InputError, match="apart") as found:
        heat.build_heat(heat.HeatScene(bodies={"a": bar, "b": far}, contacts=(contact,)))
    assert found.value.where == "contacts[0].between"
