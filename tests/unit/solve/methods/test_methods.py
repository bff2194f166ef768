"""Fixed point, Newton, and the loop that drives them."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import count, islice

import numpy as np
import pytest

from softway.bodies.setup.initial_fields import Affine
from softway.bodies.solid import Fixed, Solid, Tool
from softway.contact.impact_rule import Impulse
from softway.contact.slab_motion.trajectory import Trajectory, contact_events
from softway.errors import Cancelled, InputError, NoConvergence
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.marching.march import march
from softway.meshes.generators.shapes import rectangle
from softway.model.model import Model
from softway.model.scene import Scene
from softway.model.time_weight import EndPeaks
from softway.obstacles.primitives import Sphere
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.equations.closure import EnergyScalar, Unclosed
from softway.solve.equations.mean_force import WeightedMean
from softway.solve.equations.slab_contact import FixedContact, InitialContact, TurningContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import SlabStart
from softway.solve.methods.anderson import Anderson
from softway.solve.methods.cancellable import cancellable
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.iteration import Guess, Iterate, Solution, iterate, lost
from softway.solve.methods.newton import Newton
from softway.solve.operators import Factored, MatrixFree, Multigrid
from softway.solve.operators.operator_memory import OperatorMemory

BALL = Tool(shape=Sphere(centre=(0.4, -2.0), radius=2.0))
METHODS = [FixedPoint(), FixedPoint(depth=0), FixedPoint(depth=2), Newton(), Newton(renew="slab")]
methods = pytest.mark.parametrize("method", METHODS, ids=["anderson", "plain", "short", "newton", "modified"])
OPERATORS = [
    Factored(precision="single"),
    Factored(backend="superlu", precision="single"),
    MatrixFree(),
    MatrixFree(tolerance=0.1),
    Multigrid(),
]
operators = pytest.mark.parametrize("operator", OPERATORS, ids=["single", "superlu", "free", "crude", "multigrid"])
CONTACTS = {"energy": {}, "impulse": {"timing": Impulse()}, "ball": {"floor": BALL}}


def slab(model: Model, span: float = 0.2) -> SlabEquations:
    """A body deformed and moving at random, with its contact rows as inequalities at the end of the slab."""
    rng = np.random.default_rng(0)
    u = 0.02 * rng.normal(size=model.shape) * model.free
    u[:, 1] += 0.03 * model.free[:, 1]
    v = (0.1 * rng.normal(size=model.shape) - [0.0, 0.5]) * model.free
    energy, force = model.energy_and_force(u)
    pairs = None if model.contacts.fixed else model.contacts.rest(u, 0.0)
    rows = model.rows(u)
    none = np.zeros(len(rows.node), bool)
    path = Trajectory(
        span=span, start=u, velocity=v, massive=model.massive, free=model.free, rows=rows, events=contact_events(none)
    )
    target = -2.0 * rows.gap(path.end(np.zeros(model.shape))) / span
    conditions = RowConditions(target=target, equal=none, unilateral=~none)
    initial = InitialContact(rows=rows, pressure=np.zeros(len(none)), traction=np.zeros_like(rows.normal))
    return SlabEquations(
        model=model,
        start=SlabStart(displacement=u, velocity=v, force=force, energy=energy),
        weight=EndPeaks(),
        path=path,
        average=WeightedMean(EndPeaks()),
        closure=Unclosed() if model.massive.all() else EnergyScalar(),
        contact=FixedContact(rows=rows, conditions=conditions, initial=initial)
        if pairs is None
        else TurningContact(pairs=pairs, facets=pairs, conditions=conditions, initial=initial),
    )


def solve(system: SlabEquations, method: FixedPoint | Newton, start: np.ndarray | None = None) -> Solution:
    q = system.start.velocity if start is None else start
    impulse = np.zeros(len(system.contact.conditions.target))
    guess = Guess(q=q, impulse=impulse, active=impulse != 0.0, memory=OperatorMemory())
    iterates = method.iterate(system, guess)
    return next(iterate(system, iterates, method.tolerance, method.limit))


@operators
@pytest.mark.parametrize("options", CONTACTS.values(), ids=CONTACTS)
def test_operators_lead_to_the_same_solution(
    operator: Factored | MatrixFree | Multigrid, options: dict[str, object], block: Callable[..., Model]
) -> None:
    """Whatever the operator, the equations are met, and the answer is that of Newton's method."""
    if isinstance(operator, Multigrid):
        pytest.importorskip("pyamg")
    system = slab(block(supports=(Fixed(on="top"),), **options))
    method = FixedPoint(operator=operator, limit=100, handover=False)
    solution = solve(system, method)
    solved(system, solution)
    np.testing.assert_allclose(solution.last.q, solve(system, Newton()).last.q, atol=1e-10)


def test_where_iterates_contract_poorly_newton_takes_over(block: Callable[..., Model]) -> None:
    """A plain fixed point at a long slab: on its own it fails, handed over it converges."""
    system = slab(block(supports=(Fixed(on="top"),), timing=Impulse()), 0.9)
    plain = FixedPoint(depth=0, limit=30)
    with pytest.raises(NoConvergence) as failed:
        solve(system, replace(plain, handover=False))
    assert not failed.value.contracting
    solution = solve(system, plain)
    solved(system, solution)
    assert solution.last.memory.factorisations > 1


@methods
@pytest.mark.parametrize("options", CONTACTS.values(), ids=CONTACTS)
def test_a_method_solves_the_slab(
    method: FixedPoint | Newton, options: dict[str, object], block: Callable[..., Model]
) -> None:
    system = slab(block(supports=(Fixed(on="top"),), **options))
    solved(system, solve(system, method))


def solved(system: SlabEquations, solution: Solution) -> None:
    """Balance of forces, no overlap, no tension, no force across a gap, supports that hold."""
    model = system.model
    rows = model.rows(solution.end.displacement)
    pushed = rows.spread(solution.last.impulse, model.shape)
    left = (solution.end.residual - pushed)[model.free]
    np.testing.assert_allclose(left, 0.0, atol=1e-11 * np.abs(model.mass @ system.start.velocity).max())
    gap = rows.gap(solution.end.displacement)
    assert gap.min() >= -1e-15
    assert solution.last.impulse.min() >= 0.0
    assert solution.last.impulse.max() > 0.0
    assert np.abs(solution.last.impulse * gap).max() <= 1e-15
    assert not solution.last.q[~model.free].any()


@methods
@pytest.mark.parametrize("options", [{}, {"floor": BALL}], ids=["plane", "ball"])
def test_a_slab_at_rest_is_solved_at_once(
    method: FixedPoint | Newton, options: dict[str, object], block: Callable[..., Model]
) -> None:
    model = block(**options)
    moving = slab(model)
    zero = np.zeros(model.shape)
    energy, force = model.energy_and_force(zero)
    rest = SlabStart(displacement=zero, velocity=zero, force=force, energy=energy)
    solution = solve(replace(moving, start=rest, path=replace(moving.path, start=zero, velocity=zero)), method)
    assert solution.iterations == 1
    assert not solution.last.q.any()


@methods
def test_a_linear_slab_takes_two_iterations(method: FixedPoint | Newton, block: Callable[..., Model]) -> None:
    model = block(timing=Impulse(), material=LinearElastic(E=1.0, nu=0.3))
    solution = solve(slab(model), method)
    assert solution.iterations <= 2


def test_newton_takes_fewer_iterations_and_anderson_no_more_than_plain(block: Callable[..., Model]) -> None:
    model, plain = block(timing=Impulse()), FixedPoint(depth=0, limit=200, handover=False)
    taken = [solve(slab(model, 0.4), m).iterations for m in (Newton(), FixedPoint(), plain)]
    assert taken == sorted(taken)


def test_newton_shortens_steps_that_would_invert_cells() -> None:
    """A stretch and shear of a nearly incompressible block, in one slab of the time in which a wave crosses it."""
    solid = Solid(
        mesh=rectangle((1.0, 1.0), (3, 3)), material=NeoHookean(E=1.0, nu=0.45), density=1.0,
        supports=(Fixed(on="bottom"),), velocity=Affine(gradient=((0.0, 0.6), (0.0, 0.4))),
    )  # fmt: skip
    (step,) = march(Scene(bodies={"block": solid}), until=1.0, step=1.0, method=Newton())
    assert not step.report.rejections and step.report.iterations < 20


def test_the_answer_does_not_depend_on_the_first_guess(block: Callable[..., Model]) -> None:
    system = slab(block())
    far = system.start.velocity + 0.3 * np.random.default_rng(5).normal(size=system.model.shape)
    near, other = (solve(system, FixedPoint(), q).last.q for q in (None, far))
    np.testing.assert_allclose(other, near, atol=1e-9)


@methods
def test_a_limit_that_is_too_small_is_a_failure(method: FixedPoint | Newton, block: Callable[..., Model]) -> None:
    system = slab(block(timing=Impulse()))
    with pytest.raises(NoConvergence, match="1 iterations leave a relative change"):
        solve(system, replace(method, limit=1))
    with pytest.raises(NoConvergence) as failed:
        solve(system, replace(method, limit=3))
    assert failed.value.contracting


@pytest.mark.filterwarnings("error")
@methods
def test_an_inverted_guess_is_a_failure_without_warnings(
    method: FixedPoint | Newton, block: Callable[..., Model]
) -> None:
    system = slab(block())
    crushed = -20.0 * system.model.parts[0].mesh.points * [1.0, 0.0] / system.path.span
    with pytest.raises(NoConvergence, match="admissible") as failed:
        solve(system, method, crushed)
    assert not failed.value.contracting


def test_an_iteration_at_the_rounding_level_is_accepted(block: Callable[..., Model]) -> None:
    system = slab(block())
    q = system.start.velocity
    scale = np.abs(q).max()

    def stuck(change: float, sound_from: int = 0, falls_at: int = 1000) -> Iterator[Iterate]:
        none = np.zeros(len(system.contact.conditions.target))
        for k in count():
            left = change * scale * (1e-3 if k >= falls_at else 1.0)
            yield Iterate(
                q=q, change=left, impulse=none, active=none > 0, free=none, memory=OperatorMemory(),
                system=system, sound=k >= sound_from,
            )  # fmt: skip

    def taken(change: float, tolerance: float = 1e-11, sound_from: int = 0) -> int:
        return next(iterate(system, stuck(change, sound_from), tolerance, 60)).iterations

    assert taken(5e-10) == 7
    assert taken(5e-9) == 13, "mixed iterates stand still for a while and fall again"
    assert taken(0.0) == 1
    assert taken(0.0, sound_from=7) == 8, "surfaces overlap before"
    assert taken(5e-9, tolerance=1e-8) == 1
    with pytest.raises(NoConvergence):
        taken(5e-8, tolerance=1e-10)
    with pytest.raises(NoConvergence):
        next(iterate(system, stuck(5e-8), 1e-11, 60))
    falling = iterate(system, stuck(5e-10, falls_at=9), 1e-11, 60)
    assert [solution.iterations for solution in falling] == [7, 10], "refused at a standstill, it may still converge"


def test_a_method_may_be_cancelled_after_any_iterate(block: Callable[..., Model]) -> None:
    system = slab(block())
    none = np.zeros(len(system.contact.conditions.target))
    guess = Guess(q=system.start.velocity, impulse=none, active=none > 0.0, memory=OperatorMemory())
    for last in (0, 1, 3):
        calls = count()
        taken = cancellable(FixedPoint(), lambda calls=calls, last=last: next(calls) > last, 0.25).iterate(
            system, guess
        )
        assert len(list(islice(taken, last + 1))) == last + 1
        with pytest.raises(Cancelled, match=r"in the slab at t = 0\.25 s"):
            next(taken)


def test_values_that_add_nothing_do_not_disturb_the_mixing() -> None:
    """A linear map of two unknowns is solved by three values; the differences of all later ones depend on these."""
    matrix = np.array([[0.5, 0.2], [0.0, -0.9]])
    for depth in (2, 3, 8):
        mixing, x = Anderson(depth), np.zeros(2)
        for k in range(20):
            x = mixing.mix(x, matrix @ x + 1.0)
            assert k < 2 or x == pytest.approx(np.linalg.solve(np.eye(2) - matrix, np.ones(2)), rel=1e-12)


def test_what_follows_from_the_unknowns_is_mixed_with_them() -> None:
    """The map depends on its last value, too, as equations of velocities on impulses that its last step gave."""
    matrix, follows = np.array([[0.5, 0.2], [0.0, -0.9]]), np.array([2.0, -1.0])
    mixing, x, last = Anderson(2), np.zeros(2), 0.0
    for _ in range(5):
        value = matrix @ x + 0.3 * last + 1.0
        mixed = mixing.mix(x, np.append(value, follows @ x))
        x, last = mixed[:2], float(mixed[2])
    whole = np.eye(2) - matrix - 0.3 * follows
    assert x == pytest.approx(np.linalg.solve(whole, np.ones(2)), rel=1e-9)


def test_a_lost_iterate_has_an_infinite_change(block: Callable[..., Model]) -> None:
    none = np.zeros(2)
    guess = Guess(q=np.zeros((1, 1)), impulse=none, active=none > 0.0, memory=OperatorMemory())
    it = lost(guess, slab(block()))
    assert it.change == np.inf
    assert it.impulse.tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("wrong", "where"),
    [
        (lambda: FixedPoint(depth=-1), "depth"),
        (lambda: FixedPoint(tolerance=0.0), "tolerance"),
        (lambda: FixedPoint(limit=0), "limit"),
        (lambda: Newton(tolerance=1.0), "tolerance"),
        (lambda: Newton(limit=0), "limit"),
    ],
)
def test_wrong_parameters_are_refused(wrong: Callable[[], object], where: str) -> None:
    with pytest.raises(InputError) as error:
        wrong()
    assert error.value.where == where


@pytest.mark.parametrize(("factor", "refused"), [(1.0, False), (50.0, False), (1e4, True)])
def test_an_iterate_whose_velocity_has_no_cause_ends_the_attempt(
    factor: float, refused: bool, block: Callable[..., Model]
) -> None:
    """An iterate that crosses the scene in the slab, at a multiple of the velocities at the start."""
    system = slab(block(supports=(Fixed(on="top"),)))
    none = np.zeros(len(system.contact.conditions.target))
    guess = Guess(q=system.start.velocity, impulse=none, active=none > 0.0, memory=OperatorMemory())
    first = next(Newton().iterate(system, guess))
    astray = replace(first, q=factor * first.q, change=system.model.space.greatest(factor * first.q))
    failure = "an iterate moves a node at" if refused else "1 iterations leave a relative change of 1.0e\\+00"
    with pytest.raises(NoConvergence, match=failure):
        next(iterate(system, iter([astray]), 1e-11, 1))
