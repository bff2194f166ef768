"""Slabs that one solution solves: the residual confirms it, and it has the digits of a second solution."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from typing import Any

import numpy as np
import pytest

import softway as sw
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.methods.one_solution import SAFE, FirstResidual

FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
LINEAR, SOFT = sw.LinearElastic(E=1e3, nu=0.3), sw.NeoHookean(E=1e3, nu=0.3)


def pressed(law: object, tolerance: float) -> Iterator[sw.Step]:
    """A block that its weight begins to press onto a floor, in a march too short for compiled slabs."""
    block = sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(6, 6)), material=law, density=1.0)
    contact = sw.Contact(between=("block.bottom", "floor"))
    scene = sw.Scene(
        bodies={"block": block, "floor": FLOOR}, contacts=(contact,), loads=(sw.Gravity(acceleration=(0.0, -5.0)),)
    )
    return sw.march(scene, until=0.05, step=2e-3, method=sw.FixedPoint(tolerance=tolerance))


@contextmanager
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """Number of solutions for residuals."""
    calls, plain = [0], FrozenOperator.solve

    def solve(self: FrozenOperator, b: np.ndarray) -> np.ndarray:
        calls[0] += 1
        return plain(self, b)

    with monkeypatch.context() as patch:
        patch.setattr(FrozenOperator, "solve", solve)
        yield calls


def test_the_solution_has_the_digits_of_a_second_one(monkeypatch: pytest.MonkeyPatch) -> None:
    once, twice = pressed(LINEAR, 1e-8), pressed(LINEAR, 1e-13)
    for _ in range(12):
        with counted(monkeypatch) as calls:
            one = next(once)
        two = next(twice)
        assert calls == [1]
        assert sum(c.count for c in one.ledger.contacts.values()) > 0
        for of in ("displacement", "velocity"):
            fast, slow = (getattr(step.after, of)["block"] for step in (one, two))
            assert np.abs(fast - slow).max() <= 1e-12 * np.abs(slow).max()
        assert abs(one.certificate.energy_error) <= 1e-13 * one.ledger.energy_strain
        assert one.certificate.min_gap >= -1e-15


def test_other_laws_are_solved_for_until_the_change_is_small(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = pressed(SOFT, 1e-8)
    for _ in range(3):
        with counted(monkeypatch) as calls:
            step = next(steps)
        assert calls[0] >= step.report.iterations >= 2


@pytest.mark.parametrize("crossed", [2.0, 8.0, 32.0, 128.0])
def test_the_operator_amplifies_the_rest_of_the_residual_within_the_bound(
    crossed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Waves cross so many bars in a slab: at most the condition of the operator, and below the factor that is safe.

    Lumped masses at the ends are half those inside; the consistent ones have a third of the least eigenvalue.
    """
    found, plain = list[float](), FirstResidual.confirmed

    def confirmed(self: FirstResidual, now: Any, system: Any, end: Any, made: Any, tolerance: float) -> Iterator[Any]:
        frozen = now.memory.frozen
        rows, _ = system.conditions(now.q, end, frozen)
        left = system.model.dofs.forces(end.residual) - frozen.prolong(rows.spread(now.impulse))
        told = made[1] * np.abs(left).max() / max(self.greatest, 1e-300)
        if told > 0.0:
            found.append(float(np.abs(frozen.solve(left)).max() / told))
        return plain(self, now, system, end, made, tolerance)

    monkeypatch.setattr(FirstResidual, "confirmed", confirmed)
    cells = 16
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1e-3),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.00001, normal=-1.0))
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    step = crossed / cells
    for _ in islice(sw.march(scene, until=60.0 * step, step=step, method=sw.FixedPoint(tolerance=1e-8)), 12):
        pass
    assert len(found) > 4
    assert max(found) <= min(6.0 * (1.0 + crossed**2), SAFE)
    assert crossed < 100.0 or max(found) > 0.05 * crossed**2  # the bound has the right power
