"""March state: from any slab on another march continues with the same bits, whatever carries it."""

from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import softway as sw
from softway.record.storage.serialisation import packed, unpacked
from softway.solve.operators.operator_memory import OperatorMemory

NEO = sw.NeoHookean(E=1.0, nu=0.3)
FLOOR = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))


def alike(one: Any, other: Any) -> bool:
    """Whether two values have the same bits throughout."""
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
    if isinstance(one, sp.csr_array):
        return one.shape == other.shape and alike(
            (one.data, one.indices, one.indptr), (other.data, other.indices, other.indptr)
        )
    if is_dataclass(one):
        return type(one) is type(other) and all(
            alike(getattr(one, f.name), getattr(other, f.name)) for f in fields(one)
        )
    if isinstance(one, tuple):
        return len(one) == len(other) and all(alike(a, b) for a, b in zip(one, other, strict=True))
    if hasattr(one, "keys"):
        return one.keys() == other.keys() and all(alike(one[k], other[k]) for k in one)
    return one == other or (one != one and other != other)


def bar(
    timing: object = sw.contact.Energy(), law: object = sw.LinearElastic(E=1.0), at: float = 1.1, **given: object
) -> sw.Scene:
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=8),
        material=law,
        density=1.0,
        velocity=sw.bodies.Uniform(value=0.5),
        **given,
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=at, normal=-1.0))
    return sw.Scene(
        bodies={"bar": solid, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall"), timing=timing),)
    )


def block(
    law: object, friction: object = sw.laws.Frictionless(), speed: float = 0.2, gap: float = 0.01, **given: object
) -> sw.Scene:
    """A turning block that falls on a floor obliquely."""
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.6), cells=(4, 3)),
        material=law,
        density=1.0,
        velocity=sw.bodies.Affine(value=(0.1, -speed), gradient=((0.0, -0.3), (0.3, 0.0))),
        place=sw.bodies.Placement(bottom=gap, rotations=(sw.bodies.Rotation(angle=0.1),)),
        **given,
    )
    contact = sw.Contact(between=("block", "floor"), friction=friction)
    return sw.Scene(bodies={"block": solid, "floor": FLOOR}, contacts=(contact,))


def pair(friction: object = sw.laws.Frictionless()) -> sw.Scene:
    """Two rubber blocks, one thrown at the other, with the mortar method."""
    mesh = sw.meshes.Rectangle(size=(1.0, 0.5), cells=(3, 2))
    one = sw.Solid(mesh=mesh, material=NEO, density=1.0)
    two = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.8, 0.5), cells=(4, 2)),
        material=NEO,
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.05, -0.2)),
        place=sw.bodies.Placement(translation=(0.1, 0.0), bottom=0.51),
    )
    contact = sw.Contact(between=("two.bottom", "one.top"), method=sw.contact.DualMortar(), friction=friction)
    return sw.Scene(bodies={"one": one, "two": two}, contacts=(contact,))


def on_a_floor() -> sw.Scene:
    """The pair on a floor at rest: its rows never change, those of the pair are open at first."""
    scene = pair()
    floor = sw.Contact(between=("one.bottom", "floor"))
    return replace(scene, bodies={**scene.bodies, "floor": FLOOR}, contacts=(floor, *scene.contacts))


J2 = sw.J2(E=1.0, nu=0.3, yield_stress=0.01, hardening=sw.laws.LinearHardening(modulus=0.05))
KELVIN = sw.laws.Kelvin(E=1.0, nu=0.3, shear_viscosity=0.02, bulk_viscosity=0.01)
DRY = sw.Coulomb(mu=0.3)
CASES: dict[str, tuple[sw.Scene, dict[str, Any]]] = {
    "fixed point, linear": (bar(), {"until": 1.5, "step": 0.05}),
    "fixed point, located": (bar(sw.contact.Energy(located=True)), {"until": 1.5, "step": 0.05}),
    "fixed point, turning": (block(NEO), {"until": 1.2, "step": 0.06}),
    "rejections": (block(NEO, speed=0.9), {"until": 0.8, "step": 0.2}),
    "automatic step": (block(NEO, speed=0.6), {"until": 0.8}),
    "matrix free": (block(NEO), {"until": 0.8, "step": 0.1, "method": sw.FixedPoint(operator=sw.solve.MatrixFree())}),
    "multigrid": (block(NEO), {"until": 0.4, "step": 0.1, "method": sw.FixedPoint(operator=sw.solve.Multigrid())}),
    "Newton": (block(NEO), {"until": 0.6, "step": 0.1, "method": sw.Newton()}),
    "explicit": (block(NEO, mass=sw.bodies.Lumped()), {"until": 0.5, "method": sw.Explicit()}),
    "ladder": (block(NEO, gap=1.0, speed=0.4), {"until": 4.0, "tolerance": 0.05}),
    "ladder, Impulse": (bar(sw.contact.Impulse(), at=2.0), {"until": 3.0, "step": 0.05, "tolerance": 0.05}),
    "Paper": (bar(sw.contact.Paper()), {"until": 1.5, "step": 0.05}),
    "Impulse": (bar(sw.contact.Impulse(), NEO), {"until": 1.5, "step": 0.05}),
    "Momentum": (bar(sw.contact.Impulse()), {"until": 1.5, "step": 0.04, "weight": sw.model.Momentum()}),
    "J2 with friction": (block(J2, DRY), {"until": 0.9, "step": 0.06}),
    "flow": (
        block(sw.J2(E=1.0, nu=0.3, yield_stress=0.0, flow=sw.laws.NortonFlow(K=0.02, m=0.3))),
        {"until": 0.5, "step": 0.05},
    ),
    "Kelvin": (
        block(sw.laws.Kelvin(E=1.0, nu=0.3, shear_viscosity=0.02, bulk_viscosity=0.01)),
        {"until": 0.8, "step": 0.08},
    ),
    "mortar": (pair(), {"until": 0.6, "step": 0.05}),
    "mortar with friction": (pair(DRY), {"until": 0.6, "step": 0.05}),
    "on a floor": (on_a_floor(), {"until": 1.2, "step": 0.05}),
    "on a floor, multigrid": (
        on_a_floor(),
        {"until": 0.8, "step": 0.1, "method": sw.FixedPoint(operator=sw.solve.Multigrid())},
    ),
}


def kept(march_state: sw.MarchState) -> sw.MarchState:
    """What a checkpoint makes of it: text and arrays."""
    text, arrays = packed(march_state)
    return unpacked(text, {name: np.array(values) for name, values in arrays.items()})


LONG = ("Impulse", "J2 with friction", "on a floor")


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow if n in LONG else []) for n in CASES])
def test_a_march_goes_on_with_the_same_bits(name: str) -> None:
    scene, asked = CASES[name]
    model = sw.build(scene)
    whole = list(sw.march(model, **asked))
    assert any(s.ledger.contacts and next(iter(s.ledger.contacts.values())).force_n > 0.0 for s in whole), "no contact"
    assert name != "rejections" or any(s.report.rejections for s in whole)
    assert not name.startswith("ladder") or len({round(s.slab.span / whole[0].slab.span, 9) for s in whole}) >= 3
    for k in {len(whole) // 3, 2 * len(whole) // 3}:
        rest = list(sw.march(model, state=kept(whole[k].march_state), **asked))
        assert len(rest) == len(whole) - k - 1
        for before, after in zip(whole[k + 1 :], rest, strict=True):
            assert alike(before, after), f"slab at {before.before.time:g} after {whole[k].after.time:g}"


def test_the_operator_matters_in_the_last_digits() -> None:
    """What the test above holds is no matter of course: with an operator of its own the march has other bits."""
    scene, asked = CASES["fixed point, turning"]
    whole = list(sw.march(scene, **asked))
    march_state = replace(whole[len(whole) // 2].march_state, memory=OperatorMemory())
    last = list(sw.march(scene, state=march_state, **asked))[-1]
    one, other = (s.after.displacement["block"] for s in (last, whole[-1]))
    assert not alike(one, other) and np.abs(one - other).max() < 1e-9


def test_a_model_built_again_is_the_same() -> None:
    scene, asked = CASES["J2 with friction"]
    whole = list(sw.march(scene, **asked))
    (last,) = sw.march(sw.build(scene), state=kept(whole[-2].march_state), **asked)
    assert alike(last, whole[-1])


def test_steps_hold_no_factor() -> None:
    for step in sw.march(CASES["fixed point, linear"][0], until=0.2, step=0.05):
        assert step.march_state.memory.frozen is None and step.march_state.memory.analysis is None


def test_a_march_continues_to_a_later_end_with_other_slabs() -> None:
    """To a later end and with other slabs it continues from the same state, and so do the sums of its ledger."""
    scene, asked = CASES["fixed point, linear"]
    whole = list(sw.march(scene, **asked))
    longer = list(sw.march(scene, until=3.0, step=0.04, state=whole[-1].march_state))
    assert longer[0].before.time == 1.5 and longer[-1].after.time == 3.0
    assert alike(longer[0].before.displacement, whole[-1].after.displacement)
    assert abs(longer[-1].ledger.energy_error) < 1e-13 and abs(longer[0].slab.span - 1.5 / 38) < 1e-15


def test_another_scene_is_refused() -> None:
    (march_state,) = (s.march_state for s in sw.march(bar(), until=0.05, step=0.05))
    with pytest.raises(sw.InputError, match="another scene"):
        next(sw.march(block(NEO), until=0.1, step=0.05, state=march_state))


def test_only_known_classes_are_stored_and_made() -> None:
    with pytest.raises(TypeError, match="cannot be stored"):
        packed(object())
    with pytest.raises(TypeError, match="cannot be stored"):
        packed(NEO)
    with pytest.raises(ValueError, match="KeyError: 'NeoHookean'"):
        unpacked('{"kind": "NeoHookean", "with": {}}', {})


def test_the_order_of_numbers_in_memory_is_kept() -> None:
    """Sums run along memory: an array that is stored by columns has to come back so."""
    for array in (
        np.asfortranarray(np.ones((3, 2))),
        np.ones((2, 3, 4)).transpose(2, 0, 1),
        np.ones(4),
        np.ones((2, 0)),
    ):
        again = kept((array,))[0]
        assert again.strides == array.strides and not again.flags.writeable
    twice = kept((array := np.ones(3), array))
    assert np.shares_memory(*twice)
