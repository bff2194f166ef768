"""Renewal of the operator inside a slab: its contraction, its price, and the way back from wild iterates."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

import softway as sw
from softway.contact.slab_motion.trajectory import Trajectory, contact_events
from softway.model.build import build
from softway.model.model import Model
from softway.model.time_weight import EndPeaks
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.equations.mean_force import WeightedMean
from softway.solve.equations.slab_contact import FixedContact, InitialContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import SlabStart
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess, Iterate
from softway.solve.methods.renewal import ASTRAY, RETREATS, Course
from softway.solve.operators.operator_memory import OperatorMemory

PLAIN = FixedPoint(depth=0)


@pytest.fixture
def square() -> Model:
    """A rubber square without contact."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3))
    return build(sw.Scene(bodies={"square": sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0)}))


def slab(model: Model, span: float = 1.25) -> SlabEquations:
    """The square is stretched to twice its width and sheared."""
    zero, none = np.zeros(model.shape), np.zeros(0, bool)
    v = model.points @ np.array([[0.8, 0.2], [0.3, -0.4]])
    energy, force = model.energy_and_force(zero)
    rows = model.rows(zero)
    path = Trajectory(
        span=span, start=zero, velocity=v, massive=model.massive, free=model.free, rows=rows,
        events=contact_events(none),
    )  # fmt: skip
    contact = FixedContact(
        rows=rows,
        conditions=RowConditions(target=np.zeros(0), equal=none, unilateral=none),
        initial=InitialContact(rows=rows, pressure=np.zeros(0), traction=np.zeros_like(rows.normal)),
    )
    start = SlabStart(displacement=zero, velocity=v, force=force, energy=energy)
    average = WeightedMean(EndPeaks())
    return SlabEquations(model=model, start=start, weight=EndPeaks(), path=path, average=average, contact=contact)


def iterates(model: Model, method: FixedPoint, count: int) -> list[Iterate]:
    """First iterates from the velocity at the start."""
    system, none = slab(model), np.zeros(0)
    guess = Guess(q=system.start.velocity, impulse=none, active=none != 0.0, memory=OperatorMemory())
    return list(islice(method.iterate(system, guess), count))


def test_after_the_renewal_the_plain_fixed_point_contracts_like_newton(square: Model) -> None:
    """The operator of the start leaves 0.43 of each change, that of the eleventh iterate less than a thousandth."""
    found = iterates(square, PLAIN, 14)
    change = np.array([it.change for it in found])
    assert [it.memory.renewals for it in found] == [0] * 11 + [1] * 3
    assert np.diff(np.log(change[6:11])) == pytest.approx(np.log(0.43), abs=0.05)
    assert change[12] < 1e-3 * change[11] and change[13] < 1e-3 * change[12]
    frozen = iterates(square, replace(PLAIN, handover=False), 14)
    assert [it.change for it in frozen[:11]] == change[:11].tolist()
    assert frozen[13].change > 0.1 * change[11] and frozen[13].memory.factorisations == 1
    assert found[13].memory.factorisations == 2


def test_the_operator_of_an_iterate_is_made_again_with_the_same_bits(square: Model) -> None:
    """Its origin tells the place: the end of the iterate, not the start of the slab."""
    eleventh, last = iterates(square, PLAIN, 12)[-2:]
    origin, load = last.memory.origin, np.ones(square.dofs.size)
    assert origin is not None and last.memory.frozen is not None
    np.testing.assert_array_equal(origin.at, eleventh.system.path.end(eleventh.q))
    again = origin.operator.make(origin.stiffness(square), origin.at, last.memory.analysis)
    np.testing.assert_array_equal(again.factor.solve(load), last.memory.frozen.factor.solve(load))


def course(iterate: Iterate, changes: list[float]) -> Course:
    """Course of iterates with given changes."""
    found = Course()
    for change in changes:
        found = found.after(replace(iterate, change=change))
    return found


def test_a_renewal_is_asked_for_where_it_saves_iterations(square: Model) -> None:
    """From 0.6^10 to 1e-11 it takes 40 more iterations at 0.6, at 0.1 only one; a price of 40 is too much."""
    (it,) = iterates(square, PLAIN, 1)
    slow, fast = (course(it, [rate**k for k in range(11)]) for rate in (0.6, 0.1))
    assert slow.contraction == pytest.approx(0.6)
    assert slow.asks_for_renewal(1e-11, 10.0)
    assert not slow.asks_for_renewal(1e-11, 40.0)
    assert not fast.asks_for_renewal(1e-11, 0.0)
    assert not course(it, [0.6**k for k in range(10)]).asks_for_renewal(1e-11, 10.0)


def test_an_operator_without_gain_is_not_renewed_again(square: Model) -> None:
    (it,) = iterates(square, PLAIN, 1)
    second = course(it, [0.6**k for k in range(11)]).renewed()
    for k in range(11):
        second = second.after(replace(it, change=0.7**k))
    assert not second.asks_for_renewal(1e-11, 10.0)


@pytest.mark.parametrize("wild", [np.inf, 2.0 * ASTRAY])
def test_wild_iterates_lead_back_to_the_closest_one_before(wild: float, square: Model) -> None:
    """Not to the last one: only the next iterate shows that it is admissible.  And only a few times."""
    (it,) = iterates(square, PLAIN, 1)
    found = course(it, [3.0, 1.0, 2.0, wild])
    assert found.way_back is not None and found.way_back.change == 1.0
    assert course(it, [3.0, 1.0, 2.0, 0.5 * ASTRAY]).way_back is None
    assert course(it, [wild]).way_back is None
    for _ in range(RETREATS):
        found = replace(course(it, [3.0, 1.0, wild]), retreats=found.renewed().retreats)
    assert found.way_back is None
