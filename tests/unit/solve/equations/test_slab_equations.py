"""The equations of one slab: residual, operator, and the scalar that closes the energy balance."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from softway.bodies.assembled.nodal_loads import dead_load
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, Weighted
from softway.bodies.setup.loads import Gravity
from softway.bodies.solid import Fixed, Tool
from softway.contact.impact_rule import Impulse
from softway.contact.slab_motion.trajectory import ContactEvents, Trajectory, contact_events
from softway.laws.bulk import LinearElastic
from softway.model.model import Model
from softway.model.time_weight import Collocation, EndPeaks, Momentum, TimeWeight, moments
from softway.obstacles.primitives import Sphere
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.equations.closure import EnergyScalar, Unclosed
from softway.solve.equations.mean_force import WeightedMean
from softway.solve.equations.slab_contact import FixedContact, InitialContact, TurningContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation, SlabStart

WEIGHTS = [
    EndPeaks(),
    EndPeaks(theta=0.8),
    Momentum(),
    Momentum(points=4),
    Collocation(at=(0.3, 0.8), weights=(0.4, 0.6)),
]
LINEAR = LinearElastic(E=1.0, nu=0.3)


def system(model: Model, weight: TimeWeight, span: float = 0.3, balanced: bool = False, seed: int = 0) -> SlabEquations:
    """A slab without contact from a random start, with massless nodes wherever they are."""
    rng = np.random.default_rng(seed)
    u = 0.02 * rng.normal(size=model.shape) * model.free
    energy, force = model.energy_and_force(u)
    rows = model.rows(u)
    m = len(rows.node)
    none = np.zeros(m, bool)
    v = 0.1 * rng.normal(size=model.shape) * model.free
    return SlabEquations(
        model=model, start=SlabStart(displacement=u, velocity=v, force=force, energy=energy), weight=weight,
        path=Trajectory(
            span=span, start=u, velocity=v, massive=model.massive, free=model.free,
            rows=rows, events=contact_events(none)
        ),
        average=WeightedMean(weight),
        closure=EnergyScalar() if balanced else Unclosed(),
        contact=FixedContact(
            rows=rows, conditions=RowConditions(target=np.zeros(m), equal=none, unilateral=none),
            initial=InitialContact(rows=rows, pressure=np.zeros(m), traction=np.zeros((m, model.shape[1]))),
        ),
    )  # fmt: skip


def evaluated(s: SlabEquations, q: np.ndarray) -> Evaluation:
    """Without contact forces."""
    return s.evaluate(q, np.zeros(len(s.contact.conditions.target)))


def random_q(model: Model, seed: int = 1) -> np.ndarray:
    return 0.1 * np.random.default_rng(seed).normal(size=model.shape) * model.free


@pytest.mark.parametrize("weight", WEIGHTS, ids=str)
def test_the_residual_is_the_weighted_momentum_balance(weight: TimeWeight, block: Callable[..., Model]) -> None:
    """Of a linear body: M (q - v0) + h K (u0 + h (mu1 v0 + mu2 (q - v0) / 2)) - h load."""
    model = block(material=LINEAR, timing=Impulse(), supports=(Fixed(on="left"),))
    s, q = system(model, weight), random_q(model)
    mu1, mu2 = moments(weight)
    h, v0 = s.path.span, s.start.velocity
    mean = s.start.displacement + h * (mu1 * v0 + mu2 * (q - v0) / 2)
    stiffness = model.tangent(model.displacement)
    expected = model.mass @ (q - v0) + h * (stiffness @ mean.ravel()).reshape(model.shape) - h * model.load
    np.testing.assert_allclose(evaluated(s, q).residual, expected, atol=1e-14)


@pytest.mark.parametrize("weight", WEIGHTS, ids=str)
def test_the_operator_is_the_derivative_for_a_linear_body(weight: TimeWeight, block: Callable[..., Model]) -> None:
    model = block(material=LINEAR, timing=Impulse(), supports=(Fixed(on="left"),))
    s, q = system(model, weight), random_q(model)
    step = random_q(model, 2)
    change = evaluated(s, q + step).residual - evaluated(s, q).residual
    np.testing.assert_allclose(s.stiffness.operator(q) @ step[model.free], change[model.free], atol=1e-13)


def test_massless_nodes_are_in_equilibrium_at_the_end(block: Callable[..., Model]) -> None:
    model = block()
    s, q = system(model, EndPeaks(), balanced=True), random_q(model)
    end = evaluated(s, q)
    still = ~model.massive
    np.testing.assert_allclose(end.residual[still], 0.5 * 0.3 * end.force[still], atol=1e-16)
    np.testing.assert_array_equal(end.displacement, s.path.end(q))
    np.testing.assert_allclose(end.displacement[still], s.start.displacement[still] + 0.15 * q[still], atol=1e-16)


@pytest.mark.parametrize("force", [Weighted(), AverageField(points=2), DiscreteGradient()], ids=str)
def test_the_scalar_makes_work_equal_to_stored_energy(block: Callable[..., Model], force: object) -> None:
    model = block(force=force)
    s, q = system(model, EndPeaks(), balanced=True), random_q(model)
    end = evaluated(s, q)
    moved = (end.displacement - s.start.displacement) * model.massive[:, None]
    assert end.scalar[0] != 0.0
    assert not end.clipped
    assert np.sum(end.mean_force * moved) == pytest.approx((end.energy - s.start.energy)[0], rel=1e-12)


def test_a_scalar_out_of_bounds_is_told(block: Callable[..., Model]) -> None:
    """Massless nodes that move alone store energy that no work of the others accounts for."""
    model = block()
    s = system(model, EndPeaks(), balanced=True)
    alone = np.where(model.massive[:, None], -s.start.velocity + 1e-3 * random_q(model), random_q(model))
    end = evaluated(s, alone)
    assert end.clipped and end.bounded
    assert 0.0 < np.abs(end.scalar[0]) <= 0.5


def test_a_slab_at_rest_has_no_scalar(block: Callable[..., Model]) -> None:
    model = block()
    s = system(model, EndPeaks(), balanced=True)
    end = evaluated(s, np.where(model.massive[:, None], -s.start.velocity, 0.0))
    assert end.scalar.tolist() == [0.0]


def test_the_chord_average_does_work_equal_to_stored_energy(block: Callable[..., Model]) -> None:
    for force in (AverageField(points=6), DiscreteGradient()):
        model = block(timing=Impulse(), force=force)
        s, q = system(model, EndPeaks()), random_q(model)
        end = evaluated(s, q)
        work = np.sum(end.mean_force * (end.displacement - s.start.displacement))
        assert work == pytest.approx((end.energy - s.start.energy)[0], rel=1e-11)


def test_a_quadratic_path_is_sampled_exactly_by_two_points(block: Callable[..., Model]) -> None:
    model = block(material=LINEAR, timing=Impulse())
    q = random_q(model)
    means = [evaluated(system(model, Momentum(points=p)), q).mean_force for p in (2, 5)]
    np.testing.assert_allclose(*means, atol=1e-15)


def test_a_kinked_path_is_averaged_exactly_under_the_constant_weight(block: Callable[..., Model]) -> None:
    """Of a linear body the mean force belongs to the mean position, though the kinks fall between the time points."""
    model = block(material=LINEAR, timing=Impulse())
    m = len(model.contacts.node)
    rng = np.random.default_rng(3)
    way = ContactEvents(
        closed=np.array([True, True, False, False]), touch=np.array([np.nan, 0.3, 0.6, np.nan]),
        speed=rng.normal(size=m), slope=rng.normal(size=m), release=np.array([np.nan, np.nan, 0.9, np.nan]),
    )  # fmt: skip
    s, q = system(model, Momentum()), random_q(model)
    kinked = replace(s, path=replace(s.path, events=way, jumps=((0.3, random_q(model, 4)),)))
    expected = model.force(kinked.path.mean(q))
    np.testing.assert_allclose(evaluated(kinked, q).mean_force, expected, atol=1e-14)


def test_the_conditions_of_turning_rows_are_their_gaps_linearised(block: Callable[..., Model]) -> None:
    """``gap(u1(z))`` up to the square of z - q, with supports that move."""
    model = block(floor=Tool(shape=Sphere(centre=(0.4, -2.0), radius=2.0)), supports=(Fixed(on="left"),))
    plain = system(model, EndPeaks(), balanced=True)
    start = plain.start.displacement
    pairs = model.contacts.rest(start, 0.0)
    initial, conditions = plain.contact.initial, plain.contact.conditions
    s = replace(plain, contact=TurningContact(pairs=pairs, facets=pairs, conditions=conditions, initial=initial))
    drawn = np.where(model.free, 0.0, 0.2)
    q = random_q(model) + drawn
    end = evaluated(s, q)
    basis = s.directions()
    C, rows = s.conditions(q, end, basis)
    np.testing.assert_allclose((C @ basis.directions.T).toarray(), end.rows.matrix(model.dofs).toarray(), atol=1e-15)
    assert rows.unilateral.sum() == len(rows.unilateral) - 1, "one node is held"
    z = q + 1e-5 * random_q(model, 2)
    u1 = s.path.end(z)
    linear = 0.5 * s.path.span * (C @ (basis.directions.T @ z[model.free]) - rows.target)
    np.testing.assert_allclose(linear[rows.unilateral], pairs.at(u1).gap(u1)[rows.unilateral], atol=1e-12)
    np.testing.assert_array_equal(model.dofs.nodes(np.zeros(model.dofs.size), drawn), drawn)


def test_loads_and_known_impulses_enter_the_balance(block: Callable[..., Model]) -> None:
    model = block(timing=Impulse())
    s, q = system(model, EndPeaks()), random_q(model)
    kick, jump = np.random.default_rng(3).normal(size=(2, *model.shape))
    plain = evaluated(s, q).residual
    np.testing.assert_allclose(evaluated(replace(s, impulses=kick), q).residual, plain - kick, atol=1e-14)
    jumped = evaluated(replace(s, unbalanced=jump), q).residual
    np.testing.assert_allclose(jumped, plain - model.mass @ jump, atol=1e-14)
    load = dead_load(model.parts, model.weight, (Gravity(acceleration=(0.0, -1.0)),), "loads").at(0.0)
    heavy = replace(s, model=replace(model, load=load, load_before=load))
    np.testing.assert_allclose(evaluated(heavy, q).residual, plain - 0.3 * load, atol=1e-14)


def test_the_mass_in_the_operator(block: Callable[..., Model]) -> None:
    model = block()
    s = system(model, EndPeaks(), span=1e-9)
    heavy = sp.kron(model.mass, sp.eye_array(2)).toarray()
    np.testing.assert_allclose(s.stiffness.operator(model.displacement).toarray(), heavy, atol=1e-15)
