"""Friction that is greater at rest: the instants at which sliding begins and ends, belts, and their energies."""

import json
from collections.abc import Sequence
from importlib.resources import files

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from softway.errors import InputError
from softway.mechanisms import Mechanism, MechanismStep, Motor, PlaneStop, Rigid, Sine, Slider, Spring, Steady, march

G = 9.81
SHEET = json.loads(files("softway.apps.verify.data.friction").joinpath("C03.json").read_text(encoding="utf-8"))
PERIOD, SLIDES, FARTHEST = (SHEET["reference"][key] for key in ("period", "t_slip", "x_max"))
"""Period and time of sliding [s] and greatest place [m] of the mass on the belt, from the closed form."""


def on_plane(point: tuple[float, ...], slope: float = 0.0, **changes: object) -> PlaneStop:
    """Contact of a point of the body with a plane through the origin that falls to the right."""
    normal = (np.sin(slope), np.cos(slope), 0.0)[: len(point)]
    words = {"between": ("ground", "b"), "plane": (0.0,) * len(point), "normal": normal}
    return PlaneStop(point=point, **(words | changes))


def marched(mechanism: Mechanism, until: float, h: float) -> list[MechanismStep]:
    """Steps of a march whose energy is balanced, and dissipated at all times."""
    steps = list(march(mechanism, until=until, step=h))
    scale = max(s.energy_kinetic + abs(s.energy_potential) + s.dissipation for s in steps)
    assert max(abs(s.energy_error) for s in steps) <= 1e-12 * scale
    assert min(np.diff([s.dissipation for s in steps])) >= -1e-12 * scale
    return steps


def instants(steps: Sequence[MechanismStep], kind: str, stop: str = "s") -> list[float]:
    """Instants of the events of a stop."""
    return [event.time for s in steps for event in s.events if (event.kind, event.stop) == (kind, stop)]


def sprung(h: float, **stops: PlaneStop) -> list[MechanismStep]:
    """Two periods of a mass of 1 kg on a belt of .1 m/s, held by a spring of 100 N/m (case C03)."""
    dim = len(next(iter(stops.values())).point)
    at, wall, v, down = ((0.0, 0.05, 0.0)[:dim], (-1.0, 0.05, 0.0)[:dim], (0.1, 0.0, 0.0)[:dim], (0.0, -G, 0.0)[:dim])
    body = Rigid(mass=1.0, centre=at, velocity=v, inertia=0.01 if dim == 2 else (0.01,) * 3)
    spring = Spring(between=("ground", "b"), ends=(wall, at), stiffness=100.0, rest=1.0)
    return marched(Mechanism(bodies={"b": body}, stops=stops, springs=(spring,), gravity=down), 2.0, h)


BELT = {"friction": 0.2, "mu_s": 0.4, "velocity": (0.1, 0.0)}


@pytest.mark.parametrize(("h", "accuracy"), [(1e-2, 1e-3), (1e-3, 1e-5)])
def test_the_period_of_a_mass_on_a_belt_is_that_of_the_closed_form(h: float, accuracy: float) -> None:
    """Case C03; a hundredth of the error with a tenth of the slab."""
    steps = sprung(h, s=on_plane((0.0, 0.05), plane=(0.0, 0.05), **BELT))
    slips, sticks = instants(steps, "slip"), instants(steps, "stick")
    assert len(slips) == 3 and len(sticks) == 2
    assert slips[0] == pytest.approx(0.3924, rel=1e-8), "exact while it sticks"
    np.testing.assert_allclose(np.diff(slips), PERIOD, rtol=accuracy)
    np.testing.assert_allclose(np.subtract(sticks, slips[:2]), SLIDES, rtol=2.0 * accuracy)
    places = [s.bodies["b"].centre[0] for s in steps]
    assert max(places) == pytest.approx(FARTHEST, rel=1e-5)
    stuck = [s for s in steps if s.time < slips[0]]
    assert max(abs(s.bodies["b"].velocity[0] - 0.1) for s in stuck) < 1e-14
    assert steps[-1].work > 0.3 and steps[-1].dissipation > 0.3


@pytest.mark.parametrize("dim", [2, 3])
def test_all_feet_of_a_block_begin_to_slide_and_stick_together(dim: int) -> None:
    """The friction of some reaches its limit before the block slides: several feet in one direction."""
    feet = {"l": (-0.1, 0.0), "r": (0.15, 0.0)} if dim == 2 else {"l": (-0.1, 0.0, 0.1), "r": (0.15, 0.0, 0.0),
                                                                   "m": (-0.1, 0.0, -0.1)}  # fmt: skip
    belt = BELT | {"velocity": (0.1, 0.0, 0.0)[:dim]}
    steps = sprung(1e-3, **{name: on_plane(at, **belt) for name, at in feet.items()})
    for kind, count in (("slip", 3), ("stick", 2)):
        found = [instants(steps, kind, name) for name in feet]
        assert [len(one) for one in found] == [count] * len(feet)
        assert np.ptp(found, axis=0).max() == 0.0
        np.testing.assert_allclose(np.diff(found, axis=1), PERIOD, rtol=2e-5)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(("slope", "returns"), [(0.35, False), (0.45, True)])
def test_a_block_that_slides_up_a_slope_stays_there_or_returns(slope: float, returns: bool, dim: int) -> None:
    """It stays if tan(slope) <= mu_s, even if it is more than the friction in motion; then it does not creep."""
    h, speed, kinetic, m = 0.01, 1.0, 0.2, 2.0
    normal = np.array([np.sin(slope), np.cos(slope), 0.0])[:dim]
    up = np.array([-np.cos(slope), np.sin(slope), 0.0])[:dim]
    down = (0.0, -G, 0.0)[:dim]
    body = Rigid(mass=m, centre=(0.0,) * dim, velocity=tuple((speed * up).tolist()))
    stop = on_plane(body.centre, normal=tuple(normal.tolist()), friction=kinetic, mu_s=0.4)
    steps = marched(Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=down), 1.0, h)
    stopping = speed / (G * (np.sin(slope) + kinetic * np.cos(slope)))
    height = 0.5 * speed * stopping
    place = np.array([s.bodies["b"].centre @ up for s in steps])
    if returns:
        fallen = 0.5 * G * (np.sin(slope) - kinetic * np.cos(slope)) * (1.0 - stopping) ** 2
        assert not instants(steps, "stick") and not instants(steps, "slip")
        assert place[-1] == pytest.approx(height - fallen, abs=1e-9)
    else:
        assert instants(steps, "stick") == [pytest.approx(stopping, abs=1e-12)]
        assert np.abs(place[int(stopping / h) + 1 :] - height).max() < 1e-13


def test_a_pulled_block_slips_when_the_pull_exceeds_the_friction_at_rest() -> None:
    """A spring whose end a motor moves at a constant speed, from rest: k v t = mu_s m g, then a jump."""
    k, m, speed, h = 50.0, 2.0, 0.2, 3e-3
    bodies = {
        "b": Rigid(mass=m, centre=(0.0, 0.0)),
        "pull": Rigid(mass=1.0, centre=(1.0, 0.0), inertia=1.0, velocity=(speed, 0.0)),
    }
    mechanism = Mechanism(
        bodies=bodies,
        joints={"rail": Slider(between=("ground", "pull"), at=(1.0, 0.0), axis=(1.0, 0.0))},
        motors={"drive": Motor(joint="rail", motion=Steady(rate=speed))},
        stops={"s": on_plane((0.0, 0.0), friction=0.3, mu_s=0.5)},
        springs=(Spring(between=("b", "pull"), ends=((0.0, 0.0), (1.0, 0.0)), stiffness=k, rest=1.0),),
        gravity=(0.0, -G),
    )
    steps = marched(mechanism, 2.0, h)
    begins = 0.5 * m * G / (k * speed)
    rate, excess = np.sqrt(k / m), 0.2 * m * G / k
    assert instants(steps, "slip")[0] == pytest.approx(begins, rel=1e-7)
    for s in steps:
        t = s.time - begins
        if t < 1.0:  # until it sticks again
            x = speed * t - speed / rate * np.sin(rate * t) + excess * (1.0 - np.cos(rate * t)) if t > 0.0 else 0.0
            sticks = speed + excess * rate * np.sin(rate * t) - speed * np.cos(rate * t) <= 0.0 < t
            if sticks:
                break
            assert s.bodies["b"].centre[0] == pytest.approx(x, abs=2e-5)
    assert s.time > begins + 0.5


@pytest.mark.slow
def test_a_box_on_a_conveyor_takes_twice_the_energy_that_it_gets() -> None:
    """It slides until it has the speed of the belt: the belt does the work m v^2, half of it is dissipated."""
    m, speed, friction = 3.0, 2.0, 0.3
    for dim, law in ((2, {"friction": friction}), (3, {"friction": friction, "mu_s": 0.5})):
        body = Rigid(mass=m, centre=(0.0,) * dim)
        stop = on_plane(body.centre, velocity=(speed, 0.0, 0.0)[:dim], **law)
        steps = marched(Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=(0.0, -G, 0.0)[:dim]), 1.0, 0.001)
        last = steps[-1]
        assert last.bodies["b"].velocity[0] == pytest.approx(speed, rel=1e-12)
        assert last.work == pytest.approx(m * speed**2, rel=1e-6)
        assert last.dissipation == pytest.approx(0.5 * m * speed**2, rel=1e-6)
        assert last.bodies["b"].centre[0] == pytest.approx(speed - 0.5 * speed**2 / (friction * G), abs=1e-6)


def test_the_instant_of_slip_is_of_second_order_in_a_curved_force() -> None:
    """A spring whose end moves as a sine; the force of a slab is the mean of those at its ends."""
    k, m, amplitude, rate = 50.0, 2.0, 0.3, 2.0
    bodies = {
        "b": Rigid(mass=m, centre=(0.0, 0.0)),
        "pull": Rigid(mass=1.0, centre=(1.0, 0.0), inertia=1.0, velocity=(amplitude * rate, 0.0)),
    }
    mechanism = Mechanism(
        bodies=bodies,
        joints={"rail": Slider(between=("ground", "pull"), at=(1.0, 0.0), axis=(1.0, 0.0))},
        motors={"drive": Motor(joint="rail", motion=Sine(amplitude=amplitude, frequency=rate / (2.0 * np.pi)))},
        stops={"s": on_plane((0.0, 0.0), friction=0.3, mu_s=0.6)},
        springs=(Spring(between=("b", "pull"), ends=((0.0, 0.0), (1.0, 0.0)), stiffness=k, rest=1.0),),
        gravity=(0.0, -G),
    )
    begins = np.arcsin(0.6 * m * G / (k * amplitude)) / rate
    curved = 0.5 * rate * np.tan(rate * begins)  # half of the second derivative of the force over the first
    for h in (0.013, 0.005, 0.0025):
        found = instants(marched(mechanism, 0.8, h), "slip")[0] - begins
        assert 0.0 <= found <= 1.1 * curved * h**2


def test_a_belt_on_a_cart_moves_box_and_cart_apart() -> None:
    """The momentum stays zero, and the belt gives both the difference of their velocities."""
    speed, box, cart = 0.8, 1.0, 3.0
    bodies = {
        "b": Rigid(mass=box, centre=(0.0, 0.1), inertia=0.01),
        "cart": Rigid(mass=cart, centre=(0.0, 0.0), inertia=0.1),
    }
    words = {"between": ("cart", "b"), "plane": (0.0, 0.05), "normal": (0.0, 1.0), "velocity": (speed, 0.0)}
    feet = {k: PlaneStop(point=(x, 0.05), friction=0.2, mu_s=0.3, **words) for k, x in (("l", -0.1), ("r", 0.1))}
    rails = {"rails": Slider(between=("ground", "cart"), at=(0.0, 0.0), axis=(1.0, 0.0))}
    mechanism = Mechanism(bodies=bodies, joints=rails, stops=feet, gravity=(0.0, -G))
    steps = marched(mechanism, 0.6, 0.002)
    assert max(abs(s.momentum[0]) for s in steps) < 1e-13
    last = steps[-1]
    moving = [last.bodies[name].velocity[0] for name in ("b", "cart")]
    np.testing.assert_allclose(moving, [speed * cart / (box + cart), -speed * box / (box + cart)], rtol=1e-10)
    kinetic = 0.5 * box * cart / (box + cart) * speed**2
    assert last.work == pytest.approx(2.0 * kinetic, rel=1e-6)
    assert last.dissipation == pytest.approx(kinetic, rel=1e-6)


def test_a_belt_across_a_slope_carries_a_box_that_sticks() -> None:
    """The friction at rest holds both the weight along the slope and the inertia."""
    slope, speed = 0.3, 0.5
    normal, down = (0.0, np.cos(slope), np.sin(slope)), (0.0, -G, 0.0)
    body = Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), velocity=(speed, 0.0, 0.0))
    stop = on_plane(body.centre, normal=normal, friction=0.1, mu_s=0.4, velocity=(speed, 0.0, 0.0))
    steps = marched(Mechanism(bodies={"b": body}, stops={"s": stop}, gravity=down), 1.0, 0.01)
    np.testing.assert_allclose(steps[-1].bodies["b"].centre, [speed, 0.0, 0.0], atol=1e-13)
    assert not steps[-1].events and steps[-1].dissipation < 1e-13


def test_a_block_at_rest_that_is_struck_slides_with_the_friction_in_motion() -> None:
    """A block on two feet is struck along the floor; a ball on top of it strikes down only, and it stays."""
    for direction, moves in (((1.0, 0.0), True), ((0.0, -1.0), False)):
        point = (-0.1, 0.05) if moves else (0.0, 0.1)
        ball = tuple((np.array(point) - 0.2 * np.array(direction)).tolist())
        bodies = {
            "b": Rigid(mass=1.0, centre=(0.0, 0.05), inertia=0.01),
            "ball": Rigid(mass=0.5, centre=ball, velocity=tuple((2.0 * np.array(direction)).tolist())),
        }
        stops = {k: on_plane((x, 0.0), friction=0.2, mu_s=0.6) for k, x in (("l", -0.1), ("r", 0.1))}
        face = tuple((-np.array(direction)).tolist())
        stops["hit"] = PlaneStop(between=("b", "ball"), point=ball, plane=point, normal=face, restitution=1.0)
        steps = marched(Mechanism(bodies=bodies, stops=stops, gravity=(0.0, -G)), 1.0, 0.002)
        kinds = {event.kind for s in steps for event in s.events if event.stop in "lr"}
        assert ("slip" in kinds) == moves
        place = steps[-1].bodies["b"].centre
        assert place[1] == pytest.approx(0.05, abs=1e-6) if not moves else place[0] > 0.01
        assert moves or abs(place[0]) < 1e-13


@pytest.mark.parametrize("h", [0.01, 0.003])
def test_a_box_that_is_thrown_on_a_belt_tumbles_and_goes_with_it(h: float) -> None:
    """Impacts, sliding and sticking of four corners in turn: the energy is balanced, and it lies still on the belt."""
    half, turn, centre = np.array([0.1, 0.05]), 0.4, np.array([0.0, 0.4])
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    corners = {f"{i}{j}": tuple((centre + rotation @ (half * [i, j])).tolist()) for i in (-1, 1) for j in (-1, 1)}
    body = Rigid(
        mass=1.0, centre=tuple(centre.tolist()), inertia=(0.2**2 + 0.1**2) / 12.0, velocity=(1.0, 0.0), spin=3.0
    )
    law = {"friction": 0.3, "mu_s": 0.5, "restitution": 0.3, "velocity": (-0.5, 0.0)}
    stops = {name: on_plane(at, **law) for name, at in corners.items()}
    steps = marched(Mechanism(bodies={"b": body}, stops=stops, gravity=(0.0, -G)), 3.0, h)
    last = steps[-1].bodies["b"]
    np.testing.assert_allclose([*last.velocity, *last.spin], [-0.5, 0.0, 0.0], atol=1e-11)
    assert len(steps[-1].closed) == 2 and steps[-1].work != 0.0


FEET = np.array([[np.cos(angle), 0.0, np.sin(angle)] for angle in (0.0, 2.1, 4.2)]) * 0.1


def slowing(_: float, state: np.ndarray, friction: float, height: float, inertia: float) -> np.ndarray:
    """Rates of the place, angle, velocity (x, z) and spin of a disc of 1 kg on three feet that slide on a floor.

    The forces of the feet carry the weight, and their moments about x and z with those of the friction are zero.
    """
    angle, velocity, spin = state[2], state[3:5], state[5]
    x, z = (
        np.cos(angle) * FEET[:, 0] + np.sin(angle) * FEET[:, 2],
        np.cos(angle) * FEET[:, 2] - np.sin(angle) * FEET[:, 0],
    )
    slide = np.stack([velocity[0] + spin * z, velocity[1] - spin * x], axis=1)
    share = -friction * slide / np.linalg.norm(slide, axis=1)[:, None]
    normal = np.linalg.solve([np.ones(3), -z - height * share[:, 1], x + height * share[:, 0]], [G, 0.0, 0.0])
    force = share * normal[:, None]
    turning = (z * force[:, 0] - x * force[:, 1]).sum() / inertia
    return np.array([*velocity, spin, *force.sum(axis=0), turning])


@pytest.mark.parametrize("mu_s", [None, 0.2, 0.3])
def test_a_spinning_disc_slides_to_rest_on_three_feet(mu_s: float | None) -> None:
    """In space the directions of the sliding turn, to second order; friction at rest holds nothing before all rest."""
    height, inertia, errors = 0.02, 0.005, []
    feet = {f"f{k}": tuple(foot.tolist()) for k, foot in enumerate(FEET)}
    body = Rigid(mass=1.0, centre=(0.0, height, 0.0), inertia=(0.003, inertia, 0.003), velocity=(0.5, 0.0, 0.1),
                 spin=(0.0, 6.0, 0.0))  # fmt: skip
    stops = {name: on_plane(at, friction=0.2, mu_s=mu_s) for name, at in feet.items()}
    laws = (0.2, height, inertia)
    exact = solve_ivp(slowing, (0.0, 0.2), [0.0, 0.0, 0.0, 0.5, 0.1, 6.0], "DOP853", args=laws, rtol=1e-11, atol=1e-13)
    for h in (0.002, 0.001):
        steps = marched(Mechanism(bodies={"b": body}, stops=stops, gravity=(0.0, -G, 0.0)), 0.6, h)
        then = steps[round(0.2 / h)].bodies["b"]
        errors.append(
            np.abs([*then.centre[[0, 2]], *then.velocity[[0, 2]], then.spin[1]] - exact.y[[0, 1, 3, 4, 5], -1])
        )
    assert (errors[1] < [1e-7, 1e-7, 1e-6, 1e-6, 1e-5]).all()
    assert (errors[1][[0, 2, 3, 4]] < 0.27 * errors[0][[0, 2, 3, 4]]).all()
    assert steps[-1].energy_kinetic < 1e-20 and len(steps[-1].closed) == 3
    for name in feet if mu_s is not None else ():
        slips, sticks = instants(steps, "slip", name), instants(steps, "stick", name)
        assert len(sticks) == len(slips) + 1
        assert sticks[-1] == pytest.approx(0.326, abs=0.0011)


@pytest.mark.parametrize(
    ("words", "key"),
    [
        ({"friction": 0.3, "mu_s": 0.2}, "mu_s"),
        ({"mu_s": np.inf}, "mu_s"),
        ({"friction": 0.3, "velocity": (0.0, 1.0)}, "velocity"),
        ({"friction": 0.3, "velocity": (1.0, 0.0, 0.0)}, "velocity"),
        ({"velocity": (1.0, 0.0)}, "velocity"),
    ],
)
def test_wrong_friction_is_refused(words: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as refused:
        on_plane((0.0, 0.0), **words)
    assert refused.value.where == key
