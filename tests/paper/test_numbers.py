"""Numbers of docs/theory/paper.md that no other test holds."""

import numpy as np
import pytest
import scipy.linalg as la

import softway as sw


def thrown(step: float, solver: sw.FixedPoint | sw.Newton) -> tuple[float, int]:
    """Iterations a slab, and factors, of a tilted square block of rubber that hits a floor with a tenth of c."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(8, 8)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -0.1)),
        place=sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=0.2),), bottom=0.02),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    scenario = sw.Scenario(
        bodies={"block": block, "floor": floor},
        contacts=(sw.Contact(between=("block.surface", "floor")),),
        time=sw.Time(end=3.0, step=step),
        solver=solver,
    )
    steps: list[sw.Step] = []
    sw.run(scenario, progress=lambda p: steps.append(p.step))
    return sum(s.report.iterations for s in steps) / len(steps), steps[-1].report.factorisations


@pytest.mark.parametrize("step", [pytest.param(0.05, marks=pytest.mark.slow), 0.2])
def test_the_fixed_point_takes_more_iterations_and_fewer_factors(step):
    """Newton's method factors in each of its iterations, the fixed point a few times in the march."""
    plain, anderson, newton = (
        thrown(step, s) for s in (sw.FixedPoint(depth=0, handover=False), sw.FixedPoint(), sw.Newton())
    )
    assert newton[0] < anderson[0] < plain[0] < 2.5 * newton[0]
    assert anderson[1] <= plain[1] <= 15
    assert newton[1] >= 40 * anderson[1]


@pytest.mark.parametrize(("cells", "least"), [(20, 2.4), (200, 2.499)])
def test_the_system_of_a_slab_is_well_conditioned(cells, least):
    """The automatic step makes of a uniform bar with consistent mass a system of condition 2.5, on every mesh."""
    edge = 1.0 / cells
    mass = edge / 6.0 * (np.diag([2.0, *[4.0] * (cells - 1), 2.0]) + np.eye(cells + 1, k=1) + np.eye(cells + 1, k=-1))
    stiff = (np.diag([1.0, *[2.0] * (cells - 1), 1.0]) - np.eye(cells + 1, k=1) - np.eye(cells + 1, k=-1)) / edge
    step = edge / np.sqrt(2.0)
    values = la.eigh(mass + 0.25 * step**2 * stiff, mass, eigvals_only=True)
    assert least <= values[-1] / values[0] <= 2.5 + 1e-12


def test_the_integration_by_parts_of_the_power():
    """(3.8) to (3.11) for the force and the gap of a body that touches twice, linear by pieces, at points in time."""
    t = np.linspace(0.0, 1.0, 100_001)
    gap = np.maximum(0.0, np.abs(t - 0.5) - 0.2) * np.where(t > 0.5, 2.0, 1.0)
    force = np.where(gap > 0.0, 0.0, 3.0 + t)
    rate = np.gradient(gap, t)
    assert abs(np.trapezoid(force * rate, t)) < 1e-4, "(3.9): a force that jumps where the gap closes does no work"
    assert abs(np.sum(np.diff(force) * 0.5 * (gap[1:] + gap[:-1]))) < 1e-4, "(3.11)"
