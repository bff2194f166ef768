"""Blocks that slide and stop on a floor with Coulomb friction."""

import numpy as np
import pytest

import softway as sw

pytestmark = pytest.mark.slow

GRAVITY = 9.81
DRY = sw.Coulomb(mu=0.3)
STILL = sw.bodies.Still()


def sliding(
    *,
    dim: int = 2,
    speed: float = 3.0,
    friction=DRY,
    pull: float = 0.3,
    E: float = 1e9,
    along: tuple[float, ...] = (1.0, 0.0, 0.0),
    motion=STILL,
    cells: int = 4,
    slope: bool = False,
) -> sw.Scene:
    """A block of side 0.1 on a floor, in steady slip under its friction ``pull`` times the weight.

    On a ``slope`` the pull is a load that stays.
    """
    even = (
        sw.meshes.Rectangle(size=(0.1, 0.1), cells=(cells, cells))
        if dim == 2
        else sw.meshes.Box(size=(0.1, 0.1, 0.1), cells=(cells, cells, cells))
    )
    up = np.eye(dim)[1] if dim == 2 else np.eye(3)[2]
    way = np.array(along[:dim]) / np.linalg.norm(along[:dim])
    down = tuple(-GRAVITY * up)
    initial_load = tuple(GRAVITY * (pull * way - up))
    return sw.Scene(
        bodies={
            "block": sw.Solid(
                mesh=even,
                material=sw.LinearElastic(E=E, nu=0.3),
                density=1000.0,
                velocity=sw.bodies.Uniform(value=tuple(speed * way)),
            ),
            "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0,) * dim, normal=tuple(up)), motion=motion),
        },
        contacts=(sw.Contact(between=("block.bottom", "floor"), name="floor", friction=friction),),
        loads=(sw.Gravity(acceleration=initial_load if slope else down),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=initial_load),)),
    )


def mass(dim: int) -> float:
    return 10.0 if dim == 2 else 1.0


@pytest.mark.parametrize(("dim", "along"), [(2, (1.0, 0.0)), (2, (-1.0, 0.0)), (3, (1.0, 2.0, 0.0))])
def test_a_block_that_slides_loses_speed_evenly(dim, along):
    steps = list(sw.march(sliding(dim=dim, along=along, cells=4), until=0.1, step=0.01))
    way = np.array(along[:dim]) / np.linalg.norm(along[:dim])
    for s in steps:
        speed = 3.0 - 0.3 * GRAVITY * s.after.time
        assert s.ledger.momentum[:dim] / mass(dim) == pytest.approx(speed * way, abs=1e-8)
        assert s.ledger.contacts["floor"].force_t == pytest.approx(0.3 * mass(dim) * GRAVITY, rel=1e-8)
        lost = 0.5 * mass(dim) * (9.0 - speed**2)
        assert s.ledger.dissipation == pytest.approx(lost, rel=1e-7)
        assert abs(s.ledger.energy_error) < 1e-9 * lost
    assert not any(s.report.rejections for s in steps)


@pytest.mark.parametrize("step", [0.01, 0.0371])
def test_a_block_stops_where_it_should(step):
    """The distance is exact but for the elastic deflection, 1e-8 of it; the slab of the stop ends at that instant."""
    steps = list(sw.march(sliding(), until=1.3, step=step))
    distance, stop = 9.0 / (2.0 * 0.3 * GRAVITY), 3.0 / (0.3 * GRAVITY)
    last = steps[-1].after
    assert last.displacement["block"][:, 0].mean() == pytest.approx(distance, rel=1e-6)
    assert min(abs(s.after.time - stop) for s in steps) < 1e-7 * stop
    assert steps[-1].ledger.dissipation == pytest.approx(45.0, rel=1e-7)
    resting = [s for s in steps if s.before.time > stop + 1e-6]
    bottom = np.array([s.after.displacement["block"][:, 0] for s in resting])[:, :5]
    assert np.ptp(bottom, axis=0).max() < 1e-7 * distance


def test_nodes_that_stick_do_not_move():
    scene = sliding(speed=0.0, pull=0.2, slope=True)
    steps = list(sw.march(scene, until=0.05, step=5e-4))
    bottom = np.array([s.after.displacement["block"][:5] for s in steps])
    assert np.ptp(bottom, axis=0).max() < 1e-15
    rounding = np.finfo(float).eps * mass(2) * GRAVITY  # of a position of size one, times the weight
    assert steps[-1].ledger.dissipation == pytest.approx(0.0, abs=rounding)


def test_a_moving_floor_carries_a_block_along():
    """In the frame of the floor it is a block that is thrown, and stops."""
    belt = sw.bodies.Translation(velocity=(1.0, 0.0))
    steps = list(sw.march(sliding(speed=0.0, pull=-0.3, motion=belt), until=0.5, step=0.01))
    stop = 1.0 / (0.3 * GRAVITY)
    for s in steps:
        if s.after.time < stop:
            assert s.ledger.momentum[0] / 10.0 == pytest.approx(0.3 * GRAVITY * s.after.time, abs=1e-7)
    last = steps[-1]
    travelled = 0.5 * stop + (0.5 - stop)
    assert last.after.displacement["block"][:, 0].mean() == pytest.approx(travelled, rel=1e-5)
    assert last.ledger.dissipation == pytest.approx(5.0, rel=1e-6)
    assert last.ledger.work_external == pytest.approx(10.0, rel=1e-3)


def test_a_march_goes_on_from_a_state_bit_by_bit():
    scene = sliding(E=1e6)
    step = 2.0**-10
    whole = list(sw.march(scene, until=20.0 * step, step=step))
    rest = list(sw.march(scene, until=20.0 * step, step=step, state=whole[9].after))
    for name in ("displacement", "velocity"):
        assert np.array_equal(getattr(rest[-1].after, name)["block"], getattr(whole[-1].after, name)["block"])
    for name in ("traction", "sliding", "pressure"):
        assert np.array_equal(getattr(rest[-1].after, name)["floor"], getattr(whole[-1].after, name)["floor"])


def test_the_located_rule_refuses_friction():
    scene = sliding()
    located = sw.contact.Energy(located=True)
    contact = sw.Contact(between=("block.bottom", "floor"), friction=sw.Coulomb(mu=0.3), timing=located)
    scene = sw.Scene(bodies=scene.bodies, contacts=(contact,), loads=scene.loads)
    with pytest.raises(sw.InputError) as refused:
        next(iter(sw.march(scene, until=0.1, step=0.01)))
    assert refused.value.where == "contacts[0].friction"


def test_bars_refuse_friction():
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=8), material=sw.LinearElastic(E=1.0), density=1.0)
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), friction=sw.Coulomb(mu=0.3))
    with pytest.raises(sw.InputError, match="friction in 1D"):
        sw.build(sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,)))


def colliding(
    force: sw.bodies.Weighted | sw.bodies.EnergyMomentum, material: sw.LinearElastic | sw.NeoHookean
) -> sw.Scene:
    """Two blocks that meet off centre and rub."""
    meshes = {"lower": (4, (0.0, 0.0), -1.0), "upper": (5, (0.3, 1.01), 1.0)}
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(cells, cells)),
            material=material,
            density=1.0,
            velocity=sw.bodies.Uniform(value=(0.02 * sign, -0.1 * sign)),
            place=sw.bodies.Placement(translation=place),
            force=force,
        )
        for name, (cells, place, sign) in meshes.items()
    }
    return sw.Scene(bodies=bodies, contacts=(sw.Contact(between=("lower", "upper"), name="both", friction=DRY),))


@pytest.mark.parametrize("law", [sw.LinearElastic(E=1.0, nu=0.3), sw.NeoHookean(E=1.0, nu=0.3)], ids=repr)
def test_two_bodies_keep_energy_momentum_and_spin(law):
    steps = list(sw.march(colliding(sw.bodies.EnergyMomentum(), law), until=4.0, step=0.1))
    ledgers = [s.ledger for s in steps]
    assert ledgers[-1].dissipation > 1e-4
    assert max(abs(m.energy_error) for m in ledgers) < 1e-14
    assert np.ptp([m.momentum for m in ledgers], axis=0).max() < 1e-13
    assert np.ptp([m.spin for m in ledgers], axis=0).max() < 1e-13
    for m in ledgers:
        assert m.contacts["both"].force_t <= 0.3 * m.contacts["both"].force_n + 1e-12
    assert {e.kind for s in steps for e in s.events} == {"touch", "release", "stick", "slip"}


def test_central_differences_lose_as_much_by_friction():
    scene = colliding(sw.bodies.Weighted(), sw.NeoHookean(E=1.0, nu=0.3))
    implicit = list(sw.march(scene, until=4.0, step=0.1))[-1].ledger
    explicit = list(sw.march(scene, until=4.0, method=sw.Explicit()))[-1].ledger
    assert explicit.dissipation == pytest.approx(implicit.dissipation, rel=0.1)
    assert np.abs(explicit.momentum).max() < 1e-9
