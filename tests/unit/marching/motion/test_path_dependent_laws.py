"""Bodies with a history in the march: the energy balance closes, states restart, methods agree."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.laws.law import RateLaw
from softway.marching.results.step import Step

E, NU = 1.0, 0.3
LAWS = {
    "hypoelastic": sw.Hypoelastic(E=E, nu=NU),
    "linear hardening": sw.J2(E=E, nu=NU, yield_stress=0.01, hardening=sw.laws.LinearHardening(modulus=0.05)),
    "kinematic": sw.J2(E=E, nu=NU, yield_stress=0.01, kinematic=0.05, rate=sw.laws.GreenNaghdi()),
    "overstress": sw.J2(
        E=E,
        nu=NU,
        yield_stress=0.01,
        flow=sw.laws.Perzyna(drag=0.01, reference=1.0),
        rate=sw.laws.Jaumann(increment="polar"),
    ),
    "Norton flow": sw.J2(
        E=E, nu=NU, yield_stress=0.0, flow=sw.laws.NortonFlow(K=0.02, m=0.3), rate=sw.laws.Logarithmic()
    ),
    "Kelvin": sw.laws.Kelvin(E=E, nu=NU, shear_viscosity=0.02, bulk_viscosity=0.01),
    "Maxwell": sw.laws.Maxwell(E=E, nu=NU, shares=(0.5, 0.3), times=(0.1, 1.0)),
}


def thrown(law: RateLaw, dilatation: str = "point", speed: float = 0.1) -> sw.Scene:
    """A small block on its way to a wall, turning."""
    mesh = sw.meshes.Rectangle(size=(1.0, 0.6), cells=(4, 3))
    block = sw.Solid(
        mesh=mesh,
        material=law,
        density=1.0,
        velocity=sw.bodies.Affine(value=(0.0, -speed), gradient=((0.0, -0.02), (0.02, 0.0))),
        place=sw.bodies.Placement(bottom=0.0, rotations=(sw.bodies.Rotation(angle=0.1),)),
        dilatation=dilatation,
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"block": block, "wall": wall}, contacts=(sw.Contact(between=("block", "wall")),))


def marched(scene: sw.Scene, until: float = 2.0, **given: object) -> list[Step]:
    """All slabs."""
    return list(sw.march(scene, until=until, **given))


@pytest.mark.few(4)
@pytest.mark.parametrize("name", LAWS)
def test_the_energy_balance_closes(name: str) -> None:
    """Through impact and release: what is stored, dissipated and left in the motion is what there was."""
    steps = marched(thrown(LAWS[name]))
    first = steps[0].ledger
    energy = first.energy_kinetic + first.energy_strain + first.dissipation - first.energy_error
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * energy
    lost = np.diff([0.0, *(s.ledger.dissipation for s in steps)])
    assert lost.min() >= -1e-14 * energy
    assert any(s.ledger.contacts["block-wall"].force_n > 0.0 for s in steps)
    if name == "hypoelastic":
        assert np.abs(lost).max() == 0.0
    else:
        assert steps[-1].ledger.dissipation > 0.05 * energy


def test_a_march_goes_on_from_a_state_bit_by_bit() -> None:
    """From a state in the middle of flow, with all history variables; Newton's method needs nothing else."""
    for name in ("kinematic", "Kelvin"):
        scene = thrown(LAWS[name])
        whole = marched(scene, 0.8, step=0.1, method=sw.Newton())
        middle = whole[len(whole) // 2].after
        assert {k: v.shape for k, v in middle.memory["block"].law.items()}
        rest = marched(scene, 0.8, step=0.1, method=sw.Newton(), state=middle)
        last, again = whole[-1].after, rest[-1].after
        assert np.array_equal(last.displacement["block"], again.displacement["block"])
        assert np.array_equal(last.velocity["block"], again.velocity["block"])
        assert np.array_equal(last.memory["block"].stress, again.memory["block"].stress)
        for key, values in last.memory["block"].law.items():
            assert np.array_equal(values, again.memory["block"].law[key])


@pytest.mark.parametrize("dilatation", ["point", "mean"])
def test_central_differences_agree(dilatation: str) -> None:
    """With the implicit march, in the displacement and in the plastic work."""
    scene = thrown(LAWS["linear hardening"], dilatation)
    scene = replace(scene, contacts=())
    block = replace(
        scene.bodies["block"], velocity=sw.bodies.Affine(value=(0.0, 0.0), gradient=((-0.1, 0.0), (0.0, 0.1)))
    )
    scene = replace(scene, bodies={"block": block})
    one, other = marched(scene, 1.0, step=0.02), marched(scene, 1.0, step=0.02, method=sw.Explicit())
    u, v = (s[-1].after.displacement["block"] for s in (one, other))
    assert np.abs(u - v).max() < 5e-3 * np.abs(u).max()
    lost = one[-1].ledger.dissipation
    assert lost > 0.1 * (one[0].ledger.energy_kinetic + lost)
    assert other[-1].ledger.dissipation == pytest.approx(lost, rel=1e-2)
    assert other[-1].ledger.energy_error == pytest.approx(0.0, abs=5e-3 * lost)
