"""Work of fracture: pulled apart, snapped, peeled; against the fracture energy and closed forms."""

import numpy as np
import pytest

import softway as sw
from softway.meshes.generators.shapes import rectangle
from softway.model.model import Model

E = 10.0


def bars(energy: float, contact: bool = False, still: bool = False) -> Model:
    """Two bars of length one on a line, glued at x = 1, whose right end is pulled."""
    law, meshes = sw.LinearElastic(E=E, nu=0.0), sw.meshes
    left = sw.Solid(
        mesh=meshes.Interval(length=1.0, cells=10), material=law, density=1.0, supports=(sw.Fixed(on="left"),)
    )
    pull = sw.Driven(on="right", components="x", velocity=0.02)
    right = sw.Solid(
        mesh=meshes.Interval(length=1.0, cells=10, origin=1.0), material=law, density=1.0, supports=(pull,)
    )
    glue = sw.BilinearCohesive(strength=0.1, energy=energy, stiffness=1e3)
    tie = sw.Tie(between=("a.right", "b.left"), breaks=glue)
    contacts = (sw.Contact(between=("a.right", "b.left")),) if contact else ()
    inertia = sw.bodies.Off() if still else sw.bodies.Full()
    return sw.build(sw.Scene(bodies={"a": left, "b": right}, ties=(tie,), contacts=contacts, inertia=inertia))


@pytest.mark.slow
@pytest.mark.few(2)
@pytest.mark.parametrize("energy", [2e-3, 2e-4], ids=["stable", "snap"])
@pytest.mark.parametrize("contact", [False, True], ids=["alone", "contact"])
def test_bars_pulled_apart_dissipate_the_fracture_energy(energy: float, contact: bool) -> None:
    """Shorter and longer than the critical length ``2 E Gc / strength^2``: what is released becomes kinetic energy."""
    steps = list(sw.march(bars(energy, contact), until=2.5, step=0.01))
    ledger = steps[-1].ledger
    assert ledger.dissipation == pytest.approx(energy, abs=1e-12)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-13
    assert (ledger.energy_kinetic + ledger.energy_strain > 3e-4) == (energy < 1e-3)


def test_without_inertia_what_a_snap_releases_is_dissipated() -> None:
    """All energy of bars longer than the critical length is lost at the break, and the ledger closes."""
    steps = list(sw.march(bars(2e-4, still=True), until=1.5, step=0.05))
    ledger = steps[-1].ledger
    assert ledger.energy_strain < 1e-20
    assert ledger.dissipation == pytest.approx(ledger.work_external, abs=1e-15)
    strength = 0.5 * 0.1**2 / E * 2.0 + 0.5 * 0.1**2 / 1e3
    assert ledger.dissipation == pytest.approx(strength, rel=0.1), "the strain energy at the strength, to the slab"


def test_slow_bars_follow_the_softening_line() -> None:
    """Shorter than the critical length: force and damage of the closed form at every instant, without inertia.

    A slab is accepted when its velocities change by less than 1e-11; softening amplifies what is left, and it adds up
    over forty slabs to a few 1e-10 of the strength.
    """
    model, energy = bars(1e-2, still=True), 1e-2
    last, first, flexible = 2.0 * energy / 0.1, 1e-4, 2.0 / E
    for step in sw.march(model, until=4.0, step=0.1):
        pulled = 0.02 * step.after.time
        force = min(pulled / (flexible + 1e-3), 0.1 * (last - pulled) / (last - first - 0.1 * flexible))
        found = step.after.displacement["b"][-1, 0] - step.after.displacement["b"][0, 0]
        assert found * E == pytest.approx(force, abs=1e-9 * 0.1)
        opening = pulled - force * flexible
        spent = energy * max(0.0, opening - first) / (last - first)
        assert step.ledger.dissipation == pytest.approx(spent, abs=1e-12)


def blocks(direction: tuple[float, float], glue: sw.BilinearCohesive) -> Model:
    """Two stiff blocks of width one, the upper one pulled along a direction."""
    solids = {}
    for name, base, cells in (("a", 0.0, 3), ("b", 0.5, 4)):
        mesh = sw.meshes.Rectangle(size=(1.0, 0.5), cells=(cells, 2), origin=(0.0, base))
        moves = [
            sw.Driven(on="top" if name == "b" else "bottom", components=c, velocity=v if name == "b" else 0.0)
            for c, v in zip("xy", direction, strict=True)
        ]
        law = sw.LinearElastic(E=1e6, nu=0.0)
        solids[name] = sw.Solid(mesh=mesh, material=law, density=1.0, supports=tuple(moves))
    tie = sw.Tie(between=("a.top", "b.bottom"), breaks=glue)
    return sw.build(sw.Scene(bodies=solids, ties=(tie,), inertia=sw.bodies.Off()))


@pytest.mark.parametrize("angle", [0.0, 30.0, 60.0, 90.0])
def test_mixed_mode_dissipates_the_energy_of_its_mode(angle: float) -> None:
    """Blocks pulled at an angle to the normal: Benzeggagh and Kenane with the share ``sin^2`` of sliding."""
    glue = sw.BilinearCohesive(
        strength=0.4, energy=0.02, stiffness=40.0, shear_strength=0.6, shear_energy=0.05, exponent=1.5
    )
    sine, cosine = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    steps = list(sw.march(blocks((0.1 * sine, 0.1 * cosine), glue), until=2.5, step=0.05))
    toughness = 0.02 + 0.03 * sine**3
    assert steps[-1].ledger.dissipation == pytest.approx(toughness, rel=2e-4), "to the strain of the stiff blocks"
    assert abs(steps[-1].ledger.energy_error) < 1e-10 * toughness


H, LENGTH, CRACK, MODULUS, TOUGHNESS = 0.1, 2.0, 0.6, 100.0, 1e-4


def arm(base: float, glued: float) -> sw.Mesh:
    """Arm of a cantilever, glued at the height ``glued`` from the end of the crack on; ``tip`` is its loaded corner."""
    mesh = rectangle((LENGTH, H), (80, 1), cell="quad8", origin=(0.0, base))
    x, y = mesh.points.T
    near = np.abs(y - glued) < 1e-9
    tip = (x < 1e-9) & (np.abs(np.abs(y - glued) - H) < 1e-9)
    tags = {**mesh.tags, "glued": np.flatnonzero(near & (x > CRACK - 1e-9)), "tip": np.flatnonzero(tip)}
    return sw.Mesh(points=mesh.points, blocks=mesh.blocks, tags=tags)


def test_double_cantilever_beam() -> None:
    """The force on the arms while the crack grows is that of beams with the energy release rate Gc, to one percent.

    ``G = P^2 a^2 / (E I)`` and the opening ``2 P a^3 / (3 E I)`` give ``P^2 = 2 (Gc E I)^1.5 / (3 E I opening)``, for
    any length of the crack, and any rotation at its end.
    """
    solids = {}
    for name, base, sign in (("low", 0.0, -1.0), ("up", H, 1.0)):
        pull = sw.Driven(on="tip", components="y", velocity=0.005 * sign)
        law, section = sw.LinearElastic(E=MODULUS, nu=0.0), sw.bodies.PlaneStress()
        held = sw.Fixed(on="right", components="x")
        solids[name] = sw.Solid(mesh=arm(base, H), material=law, density=1.0, section=section, supports=(held, pull))
    glue = sw.BilinearCohesive(strength=0.1, energy=TOUGHNESS, stiffness=1e3)
    tie = sw.Tie(between=("low.glued", "up.glued"), breaks=glue)
    model = sw.build(sw.Scene(bodies=solids, ties=(tie,), inertia=sw.bodies.Off()))
    tip, bending = model.meshes["up"].tags["tip"], MODULUS * H**3 / 12.0
    forces, exact, spent = [], [], []
    for step in sw.march(model, until=8.0, step=0.1):
        opening = 0.01 * step.after.time
        forces.append(float(step.reactions["up"][tip, 1].sum()))
        exact.append(np.sqrt(2.0 * (TOUGHNESS * bending) ** 1.5 / (3.0 * bending * (opening - 0.0005))))
        spent.append(step.ledger.dissipation)
        assert abs(step.ledger.energy_error) < 1e-16
    np.testing.assert_allclose(forces[45:], exact[45:], rtol=0.01)
    lengths = np.sqrt(TOUGHNESS * bending) / np.array(forces)
    assert spent[-1] - spent[50] == pytest.approx(TOUGHNESS * (lengths[-1] - lengths[50]), rel=0.02)
    assert max(forces) < 1.05 * np.sqrt(TOUGHNESS * bending) / CRACK
