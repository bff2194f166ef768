"""Bodies in motion that break apart: momentum, angular momentum, energy, and the bits of a march that goes on."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.model.scene import StaticStart
from softway.record.storage.serialisation import packed, unpacked

GLUE = sw.BilinearCohesive(strength=0.4, energy=0.02, stiffness=40.0, shear_strength=0.6, shear_energy=0.05)
TIE = sw.Tie(between=("a.top", "b.bottom"), breaks=GLUE)
THROWN = sw.bodies.Affine(gradient=((0.1, -1.6), (1.6, 0.7)))


def layers() -> dict[str, sw.Solid]:
    """Two layers of a block of width one whose meshes do not match, which spin and move apart."""
    found = {}
    for name, base, height, cells in (("a", 0.0, 0.5, (4, 3)), ("b", 0.5, 0.25, (7, 2))):
        mesh = sw.meshes.Rectangle(size=(1.0, height), cells=cells, origin=(0.0, base))
        law, force = sw.NeoHookean(E=10.0, nu=0.3), sw.bodies.EnergyMomentum()
        found[name] = sw.Solid(mesh=mesh, material=law, density=1.0, velocity=THROWN, force=force)
    return found


def drift(steps: list[sw.Step], name: str) -> float:
    """Greatest change of a momentum in a march."""
    values = np.array([getattr(s.ledger, name) for s in steps])
    return float(np.abs(values - values[0]).max())


def require_balances(steps: list[sw.Step], spin: float = 1e-10) -> None:
    """All balances hold, and the dissipation never falls."""
    energy = steps[0].ledger.energy_kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * energy
    assert drift(steps, "momentum") < 1e-12
    assert drift(steps, "spin") < spin
    assert np.diff([s.ledger.dissipation for s in steps]).min() > -1e-15


def worst(step: sw.Step) -> float:
    """Greatest damage after a step."""
    return max(float(damage.max()) for damage in step.after.fields["damage"].values())


@pytest.mark.slow
@pytest.mark.parametrize("contact", [False, True], ids=["alone", "contact"])
def test_a_block_that_spins_breaks_apart(contact: bool) -> None:
    """All balances hold while it turns and breaks in both modes, with unilateral contact of the pieces or without."""
    contacts = (sw.Contact(between=("a.top", "b.bottom")),) if contact else ()
    model = sw.build(sw.Scene(bodies=layers(), ties=(TIE,), contacts=contacts))
    assert model.linked.tolist() == [0, 0]
    assert model.massive.all() != contact
    steps = list(sw.march(model, until=1.5, step=0.01))
    assert worst(steps[-1]) == 1.0
    require_balances(steps)
    breaks = [e for s in steps for e in s.events if e.kind == "break"]
    assert len(breaks) == len({(e.bodies[0], e.node) for e in breaks}) == 8, "one for each node of the finer surface"
    glue = steps[-1].ledger.ties[TIE.label]
    assert glue.broken == pytest.approx(1.0) and glue.opening > 0.01
    assert glue.dissipated == pytest.approx(steps[-1].ledger.dissipation, abs=1e-14)
    assert 0.02 < steps[-1].ledger.dissipation < 0.05, "between the fracture energies of the two modes"
    assert min((c.min_gap for s in steps for c in s.ledger.contacts.values()), default=0.0) > -1e-12


@pytest.mark.slow
@pytest.mark.parametrize(
    "method",
    [sw.Newton(), sw.FixedPoint(operator=sw.solve.MatrixFree()), sw.FixedPoint(operator=sw.solve.Multigrid())],
    ids=["newton", "matrix-free", "multigrid"],
)
def test_every_method_finds_the_same_motion(method: sw.FixedPoint | sw.Newton) -> None:
    model = sw.build(sw.Scene(bodies=layers(), ties=(TIE,)))
    steps = list(sw.march(model, until=0.4, step=0.01, method=method))
    other = list(sw.march(model, until=0.4, step=0.01))
    require_balances(steps)
    damage, same = (model.join(found[-1].after.fields["damage"]) for found in (steps, other))
    assert damage.max() > 0.9
    np.testing.assert_allclose(damage, same, atol=1e-7)


def test_a_march_goes_on_with_the_same_bits() -> None:
    """From the stored state of the march, and to rounding from the bare state, which makes its operator anew."""
    model = sw.build(sw.Scene(bodies=layers(), ties=(TIE,)))
    steps = list(sw.march(model, until=0.4, step=0.01))
    half = steps[19]
    assert 0.0 < worst(half) < 1.0
    stored = unpacked(*packed(replace(half.march_state, memory=half.march_state.memory.bare())))
    again = list(sw.march(model, until=0.4, step=0.01, state=stored))
    other = list(sw.march(model, until=0.4, step=0.01, state=half.after))
    assert again[-1].ledger.ties["a.top-b.bottom"].dissipated == pytest.approx(steps[-1].ledger.dissipation, abs=1e-15)
    mine, same, near = (model.join(found[-1].after.displacement) for found in (steps, again, other))
    np.testing.assert_array_equal(same, mine)
    np.testing.assert_allclose(near, mine, atol=1e-9)


@pytest.mark.slow
def test_bodies_in_space_break_apart() -> None:
    """A block of tetrahedra on one of hexahedra that spins: energy, momentum and angular momentum are kept."""
    thrown = sw.bodies.Affine(gradient=((0.1, -0.8, 0.3), (0.8, 0.0, -0.5), (-0.3, 0.5, 0.8)))
    solids = {}
    for name, base, cell, cells in (("a", 0.0, "hex8", (2, 2, 1)), ("b", 0.5, "tet4", (3, 3, 1))):
        mesh = sw.meshes.Box(size=(1.0, 1.0, 0.5), cells=cells, origin=(0.0, 0.0, base), cell=cell)
        law, force = sw.NeoHookean(E=10.0, nu=0.3), sw.bodies.EnergyMomentum()
        solids[name] = sw.Solid(mesh=mesh, material=law, density=1.0, velocity=thrown, force=force)
    model = sw.build(sw.Scene(bodies=solids, ties=(TIE,)))
    steps = list(sw.march(model, until=1.0, step=0.02))
    assert worst(steps[-1]) == 1.0
    require_balances(steps)


def test_glue_under_pressure_or_turned_as_a_whole_does_not_break() -> None:
    """Pressed together far beyond the strength there is no damage; and none where all nodes turn by a right angle."""
    model = sw.build(sw.Scene(bodies=layers(), ties=(TIE,)))
    (bond,) = model.bonds
    (tie,) = bond.ties
    none = np.zeros(len(tie.jump.node))
    u = np.zeros(model.shape)
    u[model.parts[1].nodes, 1] = -0.1
    damage, lost = tie.grown(none, u, model.points + u)
    assert not damage.any() and not lost.any()
    energy, force = tie.stored(none + 0.7, u, model.points + u)
    assert energy == pytest.approx(0.5 * 40.0 * 0.1**2), "compression has the full stiffness whatever the damage"
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    whole = u @ turn.T + model.points @ (turn - np.eye(2)).T
    energy, turned = tie.stored(none + 0.7, whole, model.points + whole)
    np.testing.assert_allclose(turned, force @ turn.T, atol=1e-13)
    assert energy == pytest.approx(0.5 * 40.0 * 0.1**2)


def test_ties_that_break_refuse_what_they_do_not_know() -> None:
    """A static start, and parts of a body of revolution."""
    scene = sw.Scene(bodies=layers(), ties=(TIE,))
    with pytest.raises(sw.InputError, match="start"):
        sw.build(replace(scene, start=StaticStart()))
    plain = sw.bodies.Weighted()
    round_ = {
        name: replace(solid, section=sw.bodies.Axisymmetric(), force=plain) for name, solid in scene.bodies.items()
    }
    with pytest.raises(sw.InputError, match=r"ties\[0\].breaks"):
        sw.build(replace(scene, bodies=round_))
