"""A march on meshes that follow the waves: as accurate as the finest uniform mesh, its balances exact, far smaller."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from adapting import adaptive_march

import softway as sw
from softway.apps.verify.exact.thrown import Thrown
from softway.errors import InputError
from softway.meshes.adaptive.adapt import Adapt

BAR = sw.Solid(
    mesh=sw.meshes.Interval(length=1.0, cells=10),
    material=sw.LinearElastic(E=1.0, nu=0.0),
    density=1.0,
    velocity=sw.bodies.Uniform(value=1.0),
)
GAP, LEVELS = 0.3, 3
WALL = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + GAP, normal=-1.0))
THROWN = sw.Scene(bodies={"bar": BAR, "wall": WALL}, contacts=(sw.Contact(between=("bar.right", "wall")),))
EXACT = Thrown(gap=GAP)
STEP = 0.1 / 2**LEVELS / np.sqrt(2.0)


def uniform(levels: int) -> sw.Scene:
    bar = replace(BAR, mesh=sw.meshes.Interval(length=1.0, cells=10 * 2**levels))
    return replace(THROWN, bodies={"bar": bar, "wall": WALL})


def force_error(steps: Sequence[sw.Step]) -> float:
    """Root mean square error of the force of the wall over the slabs."""
    total = 0.0
    for step in steps:
        start, end = step.before.time, step.after.time
        mean = EXACT.push(np.linspace(start, end, 41)).mean()
        (contact,) = step.ledger.contacts.values()
        total += (contact.force_n - float(mean)) ** 2 * (end - start)
    return float(np.sqrt(total))


@pytest.fixture(scope="module")
def adapted() -> list[sw.Step]:
    return list(adaptive_march(THROWN, {"bar": Adapt(levels=LEVELS)}, until=2.8, step=STEP))


@pytest.fixture(scope="module")
def fine() -> list[sw.Step]:
    return list(sw.march(uniform(LEVELS), until=2.8, step=STEP))


@pytest.mark.slow
def test_the_force_is_as_good_as_on_the_finest_mesh(adapted: list[sw.Step], fine: list[sw.Step]) -> None:
    assert len(adapted) == len(fine)
    assert force_error(adapted) < 1.03 * force_error(fine)


@pytest.mark.slow
def test_it_has_a_fraction_of_the_unknowns(adapted: list[sw.Step], fine: list[sw.Step]) -> None:
    nodes = sum(taken.model.shape[0] for taken in adapted)
    assert nodes < 2 / 3 * len(fine) * (10 * 2**LEVELS + 1)  # 37 % with one level more, 3 % with five
    assert any(taken.transfers for taken in adapted)


@pytest.mark.slow
def test_energy_and_momentum_of_the_whole_march(adapted: list[sw.Step]) -> None:
    impulse = 0.0
    for step in adapted:
        (contact,) = step.ledger.contacts.values()
        impulse += contact.force_n * (step.after.time - step.before.time)
        assert step.ledger.momentum[0] == pytest.approx(1.0 - impulse, abs=1e-12)
        assert abs(step.ledger.energy_error) < 1e-12
        energy = step.ledger.energy_kinetic + step.ledger.energy_strain
        assert energy == pytest.approx(0.5 - step.ledger.remeshing, abs=1e-12)
    assert abs(adapted[-1].ledger.remeshing) < 1e-12


@pytest.mark.slow
def test_no_slab_is_tried_twice(adapted: list[sw.Step]) -> None:
    assert not any(taken.report.rejections for taken in adapted)


@pytest.mark.slow
def test_the_front_is_in_the_finest_cells(adapted: list[sw.Step]) -> None:
    for taken in adapted:
        time = taken.before.time
        if not GAP + 0.1 < time < GAP + 0.9:
            continue
        mesh = taken.model.adapted["bar"]
        front = 1.0 - (time - GAP)  # where the wave from the wall is
        around = abs(mesh.mesh.centres()[:, 0] - front).argmin()
        assert mesh.leaves.level[around] == LEVELS


@pytest.mark.parametrize("names", [("one", "other"), ("one",)])
def test_two_bars_keep_their_momentum(names: tuple[str, ...]) -> None:
    one = replace(BAR, velocity=sw.bodies.Uniform(value=0.1))
    mesh = sw.meshes.Interval(length=0.5, cells=5, origin=1.01)
    other = replace(BAR, mesh=mesh, velocity=sw.bodies.Uniform(value=-0.05))
    scene = sw.Scene(bodies={"one": one, "other": other}, contacts=(sw.Contact(between=("one.right", "other.left")),))
    steps = list(adaptive_march(scene, {name: Adapt(levels=2) for name in names}, until=1.0, step=0.0175))
    for taken in steps:
        ledger = taken.ledger
        assert ledger.momentum[0] == pytest.approx(0.075, abs=1e-13)
        assert abs(ledger.energy_error) < 1e-13
        assert ledger.energy_kinetic + ledger.energy_strain == pytest.approx(0.005625 - ledger.remeshing, abs=1e-13)
    assert sum(bool(taken.transfers) for taken in steps) > 3
    assert abs(steps[-1].ledger.remeshing) < 1e-6 * 0.005625


def test_meshes_that_stay_give_the_plain_march() -> None:
    plain = list(sw.march(uniform(0), until=0.6, step=0.05))
    steps = list(adaptive_march(THROWN, {"bar": Adapt(levels=0)}, until=0.6, step=0.05))
    assert not any(taken.transfers for taken in steps)
    for one, other in zip(plain, steps, strict=True):
        assert other.after.velocity["bar"] == pytest.approx(one.after.velocity["bar"], abs=1e-12)


@pytest.mark.parametrize(
    "wrong", [{"levels": -1}, {"levels": 41}, {"levels": 2, "every": 0}, {"levels": 2, "tolerance": 0.0}]
)
def test_numbers_out_of_range(wrong: dict[str, int]) -> None:
    with pytest.raises(InputError):
        Adapt(**wrong)


def test_the_explicit_method_cannot_adapt() -> None:
    with pytest.raises(InputError, match="Explicit"):
        adaptive_march(THROWN, {"bar": Adapt(levels=1)}, until=0.1, step=0.01, method=sw.Explicit())
