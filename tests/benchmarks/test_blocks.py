"""The figures of the contact of two solids, and the mesh that the peers have of it."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks" / "peers"))

from blocks import faces, lower, upper
from groups import blocks
from groups.asked import Asked
from record.figures import Figure

from softway.arrays import Array, IntArray

PUSHED = {
    "unknowns": 100, "facets": 9, "contact": 30.0, "free": 10.0, "iterations_contact": 6.0, "iterations_free": 5.0,
    "first": 90.0,
}  # fmt: skip


def named(figures: Iterator[Figure]) -> dict[str, Figure]:
    return {f.name: f for f in figures}


def test_a_slab_in_contact_is_compared_with_one_without(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "alone", lambda problem, **options: {"result": PUSHED, "peak": 300.0})
    figures = named(blocks.pressed(Asked(depth="quick")))
    slab, rubbing = figures["pressed/3k, no friction"], figures["pressed/3k, friction"]
    assert (slab.ratio, slab.passed, rubbing.target) == (3.0, False, "<= 2")
    assert figures["pressed/3k, no friction, iteration"].ratio == pytest.approx(2.5)
    assert figures["pressed/3k, no friction, first slab of the touch"].ratio == 3.0
    assert figures["pressed/3k, friction, peak memory"].value == 300.0


def test_open_contact_is_compared_with_the_floor_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "alone", lambda problem, **options: {"result": {"floor": 10.0, "mortar": 12.0}})
    figures = list(blocks.unmet(Asked()))
    assert [(f.name, f.ratio, f.passed) for f in figures] == [
        ("unmet/in flight, mortar", 1.2, False),
        ("unmet/resting, mortar", 1.2, False),
    ]


def test_the_cheapest_that_is_near_enough_counts_of_each_code(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run_of = {"cpu": 2.0, "time": [1e-3, 2e-3], "momentum": [-4.0, -4.0]}
    monkeypatch.setattr(blocks, "alone", lambda problem, **options: {"result": run_of})
    missing = named(blocks.blocks(Asked()))["blocks/3k/equal accuracy"]
    assert (missing.value, missing.ratio) == (2.0, None)
    assert "NGSolve" in capsys.readouterr().out

    def told(asked: Asked, peer: str, threads: int, **options: float) -> dict[str, object]:
        near = options.get("radius") == 0.8
        return run_of | {"cpu": 12.0 if near else 1.0, "momentum": [-4.0, -4.0] if near else [-5.0, -4.0]}

    monkeypatch.setattr(blocks.peers, "found", told)
    found = named(blocks.blocks(Asked()))["blocks/3k/equal accuracy"]
    assert (found.ratio, found.passed) == (6.0, True)
    assert "radius 0.8" in found.unit


@pytest.mark.parametrize("body", [lower, upper])
def test_the_peers_blocks_are_closed_surfaces_outside_of_their_cells(
    body: Callable[[int], tuple[Array, IntArray]],
) -> None:
    points, cubes = body(3)
    quads = np.concatenate([faces(cubes, 0), faces(cubes, 0, others=True)])
    assert len(quads) == 6 * round(len(cubes) ** (2 / 3))
    assert len(faces(cubes, 1)) == len(quads) // 6
    x = points[quads]
    areas = 0.5 * np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
    assert np.abs(areas.sum(axis=0)).max() < 1e-12
    assert np.einsum("fi,fi->", x.mean(axis=1), areas) > 0.0
    assert (areas[: len(faces(cubes, 0)), 2] < 0.0).all()
