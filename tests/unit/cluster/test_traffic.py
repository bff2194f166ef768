"""Traffic of ranks, counted: what a slab sends does not depend on the size of the body."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.cluster.march import march_on
from softway.cluster.rank_model import held_by, rank_model
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import StepControl
from softway.model.build import build
from softway.model.model import Model
from softway.model.time_weight import EndPeaks
from softway.ranks.counted import Counted
from softway.ranks.threads import Threads, in_threads
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.operators import MatrixFree


def block(cells: int = 3) -> Model:
    """Cube in flight above a plane."""
    cube = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells)),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Affine(value=(0.0, 0.0, -5.0), gradient=((1.0, 0, 0), (0, 0, 0), (0, 0, 0))),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.02), normal=(0.0, 0.1, 1.0)))
    return build(
        sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))
    )


def test_an_inner_step_is_one_exchange_and_one_reduction() -> None:
    model = block()

    def solve(ranks: Threads) -> tuple[dict[str, int], int]:
        counted = Counted(ranks=ranks)
        local = rank_model(model, held_by(model, counted), counted)
        slab = SlabMatrix(model=local, stiffness_factor=5e-7, viscous_factor=0.0)
        products: list[int] = []
        factor = MatrixFree(tolerance=1e-6).make(slab, np.zeros(local.shape), None).factor
        times = factor.times

        def watched(x: np.ndarray) -> np.ndarray:
            products.append(len(x))
            return times(x)

        counted.calls.clear()
        replace(factor, times=watched).solve(local.dofs.forces(np.cos(local.points)))
        return counted.calls, len(products)

    for calls, products in in_threads(2, solve):
        assert products > 5
        assert calls == {"exchanged": products, "added": products}


@pytest.mark.parametrize("cells", [3, pytest.param(6, marks=pytest.mark.slow)])
def test_the_traffic_of_an_iteration_does_not_depend_on_the_size(cells: int) -> None:
    """Besides inner steps an iteration makes 3 sums and 5 comparisons, a slab 25 and 10; it is collected once."""
    model = block(cells)
    method = sw.FixedPoint(operator=MatrixFree(), handover=False)
    given = Settings(until=0.008, step=1e-3, weight=EndPeaks(), method=method, control=StepControl())

    def march(ranks: Threads) -> tuple[dict[str, int], int, int]:
        counted = Counted(ranks=ranks)
        steps = [s for s in march_on(counted, model, given) if s is not None]
        return counted.calls, sum(s.report.iterations for s in steps), len(steps)

    calls, iterations, slabs = in_threads(2, march)[0]
    assert iterations > 5 * slabs
    assert calls["added"] - calls["exchanged"] <= 3 * iterations + 25 * slabs
    assert calls["greatest"] <= 5 * iterations + 10 * slabs
    assert calls["collected"] == 2 * slabs
