"""Stops of mechanisms: touches at their instants, impacts by the declared law, rest, release, and what is refused."""

import numpy as np
import pytest

import softway as sw
from softway.mechanisms import (
    AngleStop,
    DistanceStop,
    Hinge,
    Mechanism,
    PlaneStop,
    Rigid,
    Rod,
    Slider,
    Spring,
    StopEvent,
    march,
)
from softway.mechanisms.walk import walk_of


def events(mechanism: Mechanism, until: float, step: float) -> tuple[list[StopEvent], list]:
    """Events and steps of a march."""
    steps = list(march(mechanism, until=until, step=step))
    return [event for one in steps for event in one.events], steps


def row_of_balls(law: str, restitution: float) -> Mechanism:
    """Five equal balls, four of them in contact; the first flies at the others."""
    places = [(-0.5, 0.0), *((float(k), 0.0) for k in range(1, 5))]
    bodies = {
        f"b{k}": Rigid(mass=1.0, centre=place, velocity=(1.0 if k == 0 else 0.0, 0.0)) for k, place in enumerate(places)
    }
    stops = {
        f"s{k}": DistanceStop(
            between=(f"b{k}", f"b{k + 1}"), points=(places[k], places[k + 1]), distance=1.0, restitution=restitution
        )
        for k in range(4)
    }
    return Mechanism(bodies=bodies, stops=stops, impacts=law)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("law", "expected"), [("simultaneous", [-0.6, 0.4, 0.4, 0.4, 0.4]), ("sequential", [0.0, 0.0, 0.0, 0.0, 1.0])]
)
def test_a_cradle_by_both_laws(law: str, expected: list[float]) -> None:
    found, steps = events(row_of_balls(law, 1.0), 1.0, 0.01)
    assert [float(s.velocity[0]) for s in steps[-1].bodies.values()] == pytest.approx(expected, abs=1e-13)
    assert found[0].time == pytest.approx(0.5, abs=1e-13)
    assert max(abs(s.energy_error) for s in steps) < 1e-14 and steps[-1].dissipation == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose([s.momentum for s in steps], [[1.0, 0.0, 0.0]] * len(steps), atol=1e-14)


def test_an_impact_without_rebound_leaves_one_body_of_all() -> None:
    _, steps = events(row_of_balls("simultaneous", 0.0), 1.0, 0.01)
    assert [float(s.velocity[0]) for s in steps[-1].bodies.values()] == pytest.approx([0.2] * 5, abs=1e-13)
    assert set(steps[-1].closed) == {"s0", "s1", "s2", "s3"}
    assert steps[-1].dissipation == pytest.approx(0.5 - 5 * 0.5 * 0.04, abs=1e-13)


def test_free_bodies_in_space_keep_momentum_and_spin_in_an_oblique_impact() -> None:
    """A ball hits the corner of a plate that turns: Newton's ratio holds at the point of impact."""
    plate = Rigid(mass=2.0, centre=(0.0, 0.0, 0.0), inertia=(0.4, 0.4, 0.7), spin=(0.2, 0.5, -0.3))
    ball = Rigid(mass=1.0, centre=(0.8, 0.6, 1.0), inertia=(0.1, 0.1, 0.1), velocity=(0.0, 0.1, -2.0))
    top = PlaneStop(
        between=("plate", "ball"), point=ball.centre, plane=(0, 0, 0), normal=(0, 0, 1), radius=0.2, restitution=0.6
    )  # fmt: skip
    found, steps = events(Mechanism(bodies={"plate": plate, "ball": ball}, stops={"top": top}), 1.0, 0.01)
    assert len(found) == 1
    assert found[0].velocity_after == pytest.approx(-0.6 * found[0].velocity_before, rel=1e-12)
    np.testing.assert_allclose([s.momentum for s in steps], [steps[0].momentum] * len(steps), atol=1e-13)
    np.testing.assert_allclose([s.spin for s in steps], [steps[0].spin] * len(steps), atol=1e-12)
    assert max(abs(s.energy_error) for s in steps) < 1e-13
    lost = 0.5 * (1.0 - 0.6) * found[0].impulse * -found[0].velocity_before
    assert steps[-1].dissipation == pytest.approx(lost, rel=1e-12)


def test_a_resting_mass_is_lifted_when_its_spring_pulls_more_than_its_weight() -> None:
    """Two masses on a spring: the lower leaves the floor at (m1 + m2) g/k above the equilibrium of the upper."""
    k, g, amplitude = 100.0, 9.81, 0.35
    rest = 1.0
    level = rest - g / k
    lower, upper = Rigid(mass=1.0, centre=(0.0, 0.0)), Rigid(mass=1.0, centre=(0.0, level - amplitude))
    spring = Spring(between=("lower", "upper"), ends=(lower.centre, upper.centre), stiffness=k, rest=rest)
    floor = PlaneStop(between=("ground", "lower"), point=(0.0, 0.0), plane=(0.0, 0.0), normal=(0.0, 1.0))
    mechanism = Mechanism(
        bodies={"lower": lower, "upper": upper}, stops={"floor": floor}, springs=(spring,), gravity=(0.0, -g)
    )
    h = 1e-3
    found, steps = events(mechanism, 0.3, h)
    exact = np.arccos(-2.0 * g / (k * amplitude)) / np.sqrt(k)
    release = next(event for event in found if event.kind == "release")
    assert release.time == pytest.approx(exact, abs=h)
    at_rest = [s.bodies["lower"].centre[1] for s in steps if s.time < release.time]
    assert np.abs(at_rest).max() < 1e-15
    assert max(abs(s.energy_error) for s in steps) < 1e-12


def test_a_string_that_becomes_taut_stops_a_falling_mass() -> None:
    string = DistanceStop(between=("ground", "m"), points=((0.0, 0.0), (0.6, 0.0)), distance=1.0, side="most")
    mechanism = Mechanism(
        bodies={"m": Rigid(mass=1.0, centre=(0.6, 0.0))}, stops={"string": string}, gravity=(0.0, -9.81)
    )
    found, steps = events(mechanism, 2.0, 0.002)
    assert found[0].time == pytest.approx(np.sqrt(2.0 * 0.8 / 9.81), abs=1e-12)
    assert max(float(np.hypot(*s.bodies["m"].centre)) for s in steps) < 1.0 + 1e-13
    assert max(abs(s.energy_error) for s in steps) < 1e-12
    assert all(b.dissipation >= a.dissipation - 1e-14 for a, b in zip(steps, steps[1:], strict=False))


def test_hundreds_of_impacts_without_loss_keep_the_energy() -> None:
    """A mass on a guide between two walls."""
    mass = Rigid(mass=1.0, centre=(0.5, 0.0), inertia=0.1, velocity=(7.3, 0.0))
    guide = Slider(between=("ground", "m"), at=(0.5, 0.0), axis=(1.0, 0.0))
    ends = ((0.0, 1.0), (1.0, -1.0))
    stops = {
        f"wall{k}": PlaneStop(
            between=("ground", "m"), point=(0.5, 0.0), plane=(x, 0.0), normal=(n, 0.0), restitution=1.0
        )
        for k, (x, n) in enumerate(ends)
    }
    found, steps = events(Mechanism(bodies={"m": mass}, joints={"g": guide}, stops=stops), 50.0, 0.1)
    assert len(found) == 365
    assert max(abs(s.energy_error) for s in steps) < 1e-11
    exact = [(0.5 + k) / 7.3 for k in range(365)]
    np.testing.assert_allclose([event.time for event in found], exact, atol=1e-11)


def test_a_hinged_door_that_hits_its_stop_loses_by_restitution() -> None:
    """The impulse acts through the hinge, too: the angular velocity turns by the ratio."""
    door = Rigid(mass=3.0, centre=(0.5, 0.0), inertia=0.25, spin=1.0, velocity=(0.0, 0.5))
    hinge = Hinge(between=("ground", "door"), at=(0.0, 0.0))
    block = PlaneStop(
        between=("ground", "door"), point=(1.0, 0.0), plane=(0.0, 0.5), normal=(0.0, -1.0), restitution=0.5
    )
    found, steps = events(Mechanism(bodies={"door": door}, joints={"hinge": hinge}, stops={"block": block}), 1.0, 0.01)
    assert found[0].time == pytest.approx(np.pi / 6.0, abs=1e-4)
    assert float(steps[-1].bodies["door"].spin[0]) == pytest.approx(-0.5, rel=1e-12)
    assert steps[-1].dissipation == pytest.approx(0.5 * (1.0 - 0.25), rel=1e-12)


def test_an_open_stop_does_not_hold_a_free_mechanism() -> None:
    """Two hinged bodies fly above a floor that they do not reach: momentum and spin stay."""
    bodies = {
        "a": Rigid(mass=1.0, centre=(0.0, 5.0), inertia=0.1, velocity=(1.0, 0.3), spin=4.0),
        "b": Rigid(mass=2.0, centre=(1.0, 5.0), inertia=0.3, velocity=(-0.5, 0.1), spin=-3.0),
    }
    hinge = Hinge(between=("a", "b"), at=(0.4, 5.0))
    floor = PlaneStop(between=("ground", "a"), point=(0.0, 5.0), plane=(0.0, 0.0), normal=(0.0, 1.0))
    mechanism = Mechanism(bodies=bodies, joints={"hinge": hinge}, stops={"floor": floor})
    found, steps = events(mechanism, 2.0, 0.02)
    assert not found and max(s.scalar for s in steps) > 1e-9
    np.testing.assert_allclose([s.momentum for s in steps], [steps[0].momentum] * len(steps), atol=1e-13)
    np.testing.assert_allclose([s.spin for s in steps], [steps[0].spin] * len(steps), atol=1e-12)


def test_an_overlap_at_the_start_is_refused() -> None:
    floor = PlaneStop(between=("ground", "b"), point=(0.0, 0.5), plane=(0.0, 0.0), normal=(0.0, 1.0), radius=0.6)
    mechanism = Mechanism(bodies={"b": Rigid(mass=1.0, centre=(0.0, 0.5))}, stops={"floor": floor})
    with pytest.raises(sw.InputError, match="stops.floor: is overlapped by 0.1 m at the start"):
        list(march(mechanism, until=1.0, step=0.1))


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: DistanceStop(between=("a", "b"), points=((0.0,), (1.0,)), distance=-1.0), "distance"),
        (
            lambda: DistanceStop(between=("a", "b"), points=((0.0,), (1.0,)), distance=1.0, restitution=1.2),
            "restitution",
        ),
        (lambda: DistanceStop(between=("a", "b"), points=((0.0,), (1.0,)), distance=1.0, side="none"), "side"),
        (lambda: PlaneStop(between=("a", "b"), point=(0.0, 0.0), plane=(0.0, 0.0), normal=(0.0, 0.0)), "normal"),
        (
            lambda: Mechanism(
                bodies={"b": Rigid(mass=1.0, centre=(0.0, 0.0))},
                joints={"one": Rod(between=("ground", "b"), ends=((1.0, 0.0), (0.0, 0.0)))},
                stops={"one": DistanceStop(between=("ground", "b"), points=((1.0, 0.0), (0.0, 0.0)), distance=1.0)},
            ),
            "names of joints, too",
        ),
        (lambda: Mechanism(bodies={"b": Rigid(mass=1.0, centre=(0.0, 0.0))}, impacts="both"), "impacts"),
    ],
)
def test_wrong_stops_are_refused(make, told: str) -> None:
    with pytest.raises(sw.InputError, match=told):
        make()


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_hinge_that_turns_between_two_limits(friction: float) -> None:
    """An arm without weight at a constant rate: beyond a turn, and back from each limit with the ratio."""
    arm = Rigid(mass=2.0, centre=(0.5, 0.0), inertia=0.5, velocity=(0.0, 2.0), spin=4.0)
    hinge = Hinge(between=("ground", "arm"), at=(0.0, 0.0))
    stops: dict = {
        "open": AngleStop(joint="hinge", limit=7.0, restitution=0.5),
        "shut": AngleStop(joint="hinge", limit=-1.0, side="least", restitution=1.0),
    }
    if friction:  # another stop with friction, far away
        stops["wall"] = PlaneStop(
            between=("ground", "arm"), point=(1.0, 0.0), plane=(5.0, 0.0), normal=(-1.0, 0.0), friction=friction
        )
    found, steps = events(Mechanism(bodies={"arm": arm}, joints={"hinge": hinge}, stops=stops), 6.0, 0.01)
    assert [(event.stop, event.kind) for event in found] == [("open", "touch"), ("shut", "touch")]
    np.testing.assert_allclose([event.time for event in found], [7.0 / 4.0, 7.0 / 4.0 + 8.0 / 2.0], rtol=3e-4)
    assert found[0].velocity_after == pytest.approx(2.0, rel=1e-12)
    assert float(steps[-1].bodies["arm"].spin[0]) == pytest.approx(2.0, rel=1e-12)
    assert max(abs(s.energy_error) for s in steps) < 1e-13 and steps[-1].dissipation == pytest.approx(6.0, rel=1e-12)


def test_a_weight_rests_on_the_limit_of_its_hinge() -> None:
    arm = Rigid(mass=2.0, centre=(0.5, 0.0), inertia=0.05)
    hinge = Hinge(between=("ground", "arm"), at=(0.0, 0.0))
    limit = AngleStop(joint="hinge", limit=-0.3, side="least", restitution=0.4)
    mechanism = Mechanism(bodies={"arm": arm}, joints={"hinge": hinge}, stops={"limit": limit}, gravity=(0.0, -9.81))
    found, steps = events(mechanism, 2.0, 0.005)
    assert found[-1].kind == "rest" and steps[-1].closed == ("limit",)
    x, y = steps[-1].bodies["arm"].centre
    assert np.arctan2(y, x) == pytest.approx(-0.3, abs=1e-12)
    assert steps[-1].dissipation == pytest.approx(2.0 * 9.81 * 0.5 * np.sin(0.3), rel=1e-9)


@pytest.mark.parametrize("rolling", [0.0, 1e-3])
def test_tables_of_stops_are_contiguous(rolling: float) -> None:
    """Kernels are compiled again for arrays of another kind."""
    stop = PlaneStop(
        between=("ground", "ball"), point=(0.0, 1.0), plane=(0.0, 0.0), normal=(0.0, 1.0), friction=0.3, rolling=rolling
    )
    ball = Rigid(mass=1.0, centre=(0.0, 2.0), inertia=1.0)
    walk = walk_of(Mechanism(bodies={"ball": ball}, stops={"floor": stop}), 1.0, 0.1, 1, None)
    assert walk.stops is not None
    tables = (walk.it.bodies, walk.it.motion, walk.room, walk.stops.stops.table)
    assert all(array.flags.c_contiguous and array.flags.writeable for table in tables for array in table)
