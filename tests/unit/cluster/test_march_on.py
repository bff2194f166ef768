"""March over ranks: every number has the same bits for any number of ranks, and the motion is that of one process."""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
import pytest

import softway as sw
from softway.cluster.march import march_on
from softway.marching.results.step import Step
from softway.marching.state.march_state import MarchState, Settings
from softway.marching.state.step_control import StepControl
from softway.model.build import build
from softway.model.model import Model
from softway.model.time_weight import EndPeaks
from softway.ranks.alone import Alone
from softway.ranks.interface import Ranks
from softway.ranks.threads import in_threads
from softway.solve.operators import MatrixFree


def thrown(cells: int = 3, material: object = None, **more: object) -> Model:
    """Cube thrown at an inclined plane, so that its nodes touch one after the other."""
    cube = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells)),
        material=material or sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        **{"velocity": sw.bodies.Uniform(value=(0.0, 0.0, -5.0)), **more},
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.02), normal=(0.0, 0.1, 1.0)))
    bodies = {"cube": cube, "floor": floor}
    return build(
        sw.Scene(
            bodies=bodies,
            contacts=(sw.Contact(between=("cube.bottom", "floor")),),
            loads=(sw.Gravity(acceleration=(0.0, 0.0, -9.81)),),
        )
    )


def settings(until: float, step: float) -> Settings:
    """Settings of a march with conjugate gradients."""
    method = sw.FixedPoint(operator=MatrixFree(), handover=False)
    return Settings(until=until, step=step, weight=EndPeaks(), method=method, control=StepControl())


def told(step: Step) -> list[object]:
    """Every number of a step, as bits."""
    states = step.before, step.after
    numbers = [
        getattr(state, name)["cube"] for state in states for name in ("displacement", "velocity", "acceleration")
    ]
    numbers += [*step.after.pressure.values(), step.reactions["cube"], step.march_state.state.start.force]
    numbers += [np.array([getattr(step.certificate, f.name) for f in fields(step.certificate)])]
    ledger = step.ledger
    numbers += [
        ledger.momentum,
        ledger.spin,
        np.array([ledger.energy_kinetic, ledger.energy_strain, ledger.energy_error]),
    ]
    events = [(e.kind, e.node, e.time, e.position.tobytes()) for e in step.events]
    return [step.report.iterations, step.report.factorisations, events, *(x.tobytes() for x in numbers)]


def steps_on(ranks: Ranks, model: Model, given: Settings, state: MarchState | None = None) -> list[Step]:
    """Steps of a march on rank 0; empty on the others."""
    return [step for step in march_on(ranks, model, given, state) if step is not None]


def in_ranks(size: int, model: Model, given: Settings, state: MarchState | None = None) -> list[Step]:
    """Steps of a march over a number of threads."""
    return in_threads(size, lambda ranks: steps_on(ranks, model, given, state))[0]


def equal(some: Sequence[Step], others: Sequence[Step]) -> bool:
    """True if two marches have the same bits."""
    return [told(s) for s in some] == [told(s) for s in others]


def test_an_impact_has_the_same_bits_on_one_two_and_three_ranks() -> None:
    model, given = thrown(material=sw.NeoHookean(E=4e4, nu=0.3)), settings(0.021, 1e-3)
    one = steps_on(Alone(), model, given)
    kinds = {e.kind for step in one for e in step.events}
    assert kinds == {"touch", "release"}
    assert equal(in_ranks(2, model, given), one)
    assert equal(in_ranks(3, model, given), one)


def test_the_motion_is_that_of_one_process() -> None:
    """The motion to the tolerance of the iterations, about as many of these; energy and momentum are closed."""
    model, given = thrown(), settings(0.016, 1e-3)
    ours = steps_on(Alone(), model, given)
    theirs = list(sw.march(model, until=given.until, step=1e-3, method=given.method))
    counts = [[s.report.iterations for s in steps] for steps in (ours, theirs)]
    assert counts[0] == pytest.approx(counts[1], abs=2)
    for mine, other in zip(ours, theirs, strict=True):
        for name, scale in (("displacement", 1e-12), ("velocity", 1e-9)):
            found = getattr(mine.after, name)["cube"]
            np.testing.assert_allclose(found, getattr(other.after, name)["cube"], atol=scale, rtol=0.0)
        assert abs(mine.certificate.energy_error) < 1e-11 * 12.5
        assert mine.certificate.momentum_error < 1e-11 * 5.0
        assert mine.certificate.energy_error == pytest.approx(other.certificate.energy_error, abs=1e-11 * 12.5)


def test_a_checkpoint_goes_on_with_another_number_of_ranks() -> None:
    model, given = thrown(), settings(0.012, 1e-3)
    whole = in_ranks(2, model, given)
    assert equal(in_ranks(3, model, given, whole[5].march_state), whole[6:])
    assert equal(steps_on(Alone(), model, given, whole[5].march_state), whole[6:])


def test_a_linear_body_on_supports_that_move() -> None:
    """Linear law, several nodes held, a face driven: reactions have the same bits, too."""
    supports = (
        sw.Driven(on="top", components="z", velocity=-2.0),
        sw.Fixed(on="left", components="x"),
    )
    model = thrown(material=sw.LinearElastic(E=1e4, nu=0.3), supports=supports)
    given = settings(0.012, 1e-3)
    one = steps_on(Alone(), model, given)
    assert max(float(np.abs(s.reactions["cube"]).max()) for s in one) > 1.0
    assert equal(in_ranks(2, model, given), one)


def test_a_body_that_turns_takes_its_operator_with_it() -> None:
    """A cube turns by about half a radian in flight: the operator turns with the nodes on every rank."""
    spin = np.array([[0.0, -10.0, 30.0], [10.0, 0.0, 0.0], [-30.0, 0.0, 0.0]])
    turning = sw.bodies.Affine(value=tuple(-spin @ np.full(3, 0.5) + (0.0, 0.0, 20.0)), gradient=spin.tolist())
    model, given = thrown(velocity=turning), settings(0.016, 1e-3)
    one = steps_on(Alone(), model, given)
    assert equal(in_ranks(3, model, given), one)
    assert one[-1].ledger.spin == pytest.approx(one[0].ledger.spin, abs=2e-2 * float(np.abs(one[0].ledger.spin).max()))
