"""Central differences on a device: the motion, events and ledger of the processor, and the state that stays there."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import softway as sw
from softway.marching import slabs

SMOOTH = sw.laws.Frictionless()
LINEAR, NEO = sw.LinearElastic(E=1e4, nu=0.3), sw.NeoHookean(E=1e4, nu=0.3)


def body(mesh: Any, law: Any, velocity: tuple[float, ...], **changes: Any) -> sw.Solid:
    return sw.Solid(
        mesh=mesh,
        material=law,
        density=1.0,
        mass=sw.bodies.Lumped(),
        velocity=sw.bodies.Uniform(value=velocity),
        **changes,
    )


def cube(law: Any = LINEAR, cell: str = "hex8", friction: Any = SMOOTH) -> sw.Scene:
    mesh = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3), cell=cell)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.05), normal=(0.1, 0.0, 1.0)))
    return sw.Scene(
        bodies={"cube": body(mesh, law, (0.0, 0.0, -5.0)), "floor": floor},
        contacts=(sw.Contact(between=("cube.bottom", "floor"), friction=friction),),
        loads=(sw.Gravity(acceleration=(0.0, 0.0, -9.81)),),
    )


def two_plates(cell: str = "tri3") -> sw.Scene:
    """Two plates above one floor, one of which hangs from supports."""
    left = body(sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4), cell=cell), LINEAR, (0.0, -5.0))
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4), cell=cell, origin=(2.0, 0.02))
    right = body(mesh, LINEAR, (0.0, 0.0), supports=(sw.bodies.Fixed(on="top"),))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.05), normal=(0.0, 1.0)))
    return sw.Scene(
        bodies={"a": left, "b": right, "floor": floor},
        contacts=(sw.Contact(between=("a.bottom", "floor")), sw.Contact(between=("b.bottom", "floor"))),
        loads=(sw.Gravity(acceleration=(0.0, -2e3)),),
    )


def march(
    scene: sw.Scene, device: str | None, tolerance: float = 1e-13, until: float = 0.04, **given: Any
) -> list[sw.Step]:
    method = sw.Explicit(device=device, tolerance=tolerance)
    return list(sw.march(scene, until=until, method=method, tolerance="off", **given))


def told(step: sw.Step) -> list[float]:
    """Balances of a step that are not rounding errors."""
    ledger = step.ledger
    contacts = [x for c in ledger.contacts.values() for x in (c.force_n, c.min_gap, float(c.count))]
    return [ledger.energy_kinetic, ledger.energy_strain, ledger.work_external, ledger.energy_error, *contacts]


@pytest.fixture
def resident(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of slabs of the batches on a device."""
    found, own = [], slabs.next_resident

    def counted(*arguments: Any) -> Any:
        batch = own(*arguments)
        if batch is not None:
            found.append(len(batch.iterations))
        return batch

    monkeypatch.setattr(slabs, "next_resident", counted)
    return found


SCENES = {
    "hex8": cube(),
    "tet4": cube(cell="tet4"),
    "tri3, supports": two_plates(),
    "quad4, supports": two_plates("quad4"),
}


@pytest.mark.parametrize("case", SCENES)
def test_the_motion_of_the_processor(case: str, device: str, resident: list[int]) -> None:
    exact, found = march(SCENES[case], None), march(SCENES[case], device)
    assert len(found) == len(exact)
    assert sum(resident) > 0.6 * len(found)
    events = [[(e.kind, e.node, e.contact) for s in steps for e in s.events] for steps in (exact, found)]
    assert events[0] == events[1]
    assert len(events[0]) > 8
    times = [[e.time for s in steps for e in s.events] for steps in (exact, found)]
    assert times[1] == pytest.approx(times[0], rel=1e-12)
    for a, b in zip(exact, found, strict=True):
        scale = [max(abs(x), 1e-3 * a.ledger.energy_kinetic, 1e-3) for x in told(a)]
        assert (np.array(told(b)) - told(a)) / scale == pytest.approx(0.0, abs=1e-10)
        assert b.ledger.momentum == pytest.approx(a.ledger.momentum, abs=1e-11 * np.abs(a.ledger.momentum).max())
        assert b.ledger.spin == pytest.approx(a.ledger.spin, abs=1e-10 * max(np.abs(a.ledger.spin).max(), 1.0))
        for name, support in a.reactions.items():
            assert b.reactions[name] == pytest.approx(support, abs=1e-9 * max(np.abs(support).max(), 1.0))
    for name, u in exact[-1].after.displacement.items():
        assert found[-1].after.displacement[name] == pytest.approx(u, abs=1e-12 * np.abs(u).max())
    for name, v in exact[-1].after.velocity.items():
        assert found[-1].after.velocity[name] == pytest.approx(v, abs=1e-11 * np.abs(v).max())


def test_large_deformation_agrees_up_to_the_equilibrium_of_contact_nodes(device: str, resident: list[int]) -> None:
    """Slabs are shortened as cells are compressed; massless nodes have residual forces up to 1e-5 on the processor."""
    exact, found = march(cube(NEO), None, 1e-8), march(cube(NEO), device, 1e-8)
    assert len(found) == len(exact)
    assert sum(resident) > 0.5 * len(found)
    spans = [s.slab.span for s in found]
    assert min(spans[:-2]) < 0.97 * max(spans)
    assert spans == pytest.approx([s.slab.span for s in exact], rel=1e-7)
    a, b = (steps[-1].after.displacement["cube"] for steps in (exact, found))
    assert np.abs(a - b).max() < 1e-8 * np.abs(a).max()
    assert [e.node for s in found for e in s.events] == [e.node for s in exact for e in s.events]


def test_energy_oscillates_and_returns(device: str) -> None:
    """The energy error is of the order of the squared slab: half the slab leaves about a quarter."""
    errors = [
        max(abs(s.ledger.energy_error) for s in march(cube(), device, 1e-6, 0.024, step=h)) for h in (2.4e-4, 1.2e-4)
    ]
    assert 3.0 < errors[0] / errors[1] < 5.5


def test_without_contact_momentum_is_kept(device: str, resident: list[int]) -> None:
    """In flight without loads: all slabs but the last two are on the device, momentum and spin are constant."""
    scene = replace(cube(NEO), loads=())
    mesh = scene.bodies["cube"].mesh.build()  # type: ignore[union-attr]
    turning = np.cross((0.0, 3.0, 1.0), mesh.points - 0.5) + (0.0, 0.0, 2.0)
    scene = replace(scene, bodies={**scene.bodies, "cube": replace(scene.bodies["cube"], velocity=turning)})
    steps = march(scene, device, 1e-8, 0.05)
    assert sum(resident) >= len(steps) - 3
    first, last = steps[0].ledger, steps[-1].ledger
    assert last.momentum == pytest.approx(first.momentum, abs=1e-12 * np.abs(first.momentum).max())
    assert last.spin == pytest.approx(first.spin, rel=1e-5)


def test_a_resumed_march_has_the_same_bits(device: str) -> None:
    whole = march(cube(NEO), device, 1e-6)
    middle = len(whole) // 2
    rest = march(cube(NEO), device, 1e-6, state=whole[middle].march_state)
    assert len(rest) == len(whole) - middle - 1
    assert rest[-1].after.displacement["cube"].tobytes() == whole[-1].after.displacement["cube"].tobytes()
    assert rest[-1].after.velocity["cube"].tobytes() == whole[-1].after.velocity["cube"].tobytes()


def test_friction_leaves_the_state_on_the_processor(device: str, resident: list[int]) -> None:
    scene = cube(friction=sw.Coulomb(mu=0.3))
    exact, found = march(scene, None, 1e-10), march(scene, device, 1e-10)
    assert not resident
    u = exact[-1].after.displacement["cube"]
    assert found[-1].after.displacement["cube"] == pytest.approx(u, abs=1e-11 * np.abs(u).max())
