"""Tied solids in space: like one body where meshes match, all balances where they do not, contact beside the glue."""

import numpy as np
import pytest

import softway as sw

LAW = sw.NeoHookean(E=10.0, nu=0.3)
THROWN = sw.bodies.Affine(gradient=((0.1, -0.3, 0.2), (0.3, -0.2, 0.1), (-0.2, -0.1, 0.1)))
GLUE = sw.Tie(between=("a.top", "b.bottom"))


def block(
    height: float, cells: tuple[int, int, int], base: float, velocity: object, cell: str = "hex8", spin: bool = False
) -> sw.Solid:
    """A layer of a block of the width one, its lower side at ``base``; with ``spin`` slabs keep that of each layer."""
    mesh = sw.meshes.Box(size=(1.0, 1.0, height), cells=cells, origin=(0.0, 0.0, base), cell=cell)
    force = sw.bodies.EnergyMomentum() if spin else sw.bodies.Weighted()
    return sw.Solid(mesh=mesh, material=LAW, density=1.0, velocity=velocity, force=force)


def drift(steps: list[sw.Step], name: str) -> float:
    """Greatest change of a momentum in a march."""
    values = np.array([getattr(s.ledger, name) for s in steps])
    return float(np.abs(values - values[0]).max())


@pytest.mark.parametrize("cell", ["hex8", "tet10"])
def test_matching_layers_are_one_body(cell: str) -> None:
    layers = {"a": block(0.5, (2, 2, 2), 0.0, THROWN, cell), "b": block(0.5, (2, 2, 2), 0.5, THROWN, cell)}
    model = sw.build(sw.Scene(bodies=layers, ties=(GLUE,)))
    whole = sw.build(sw.Scene(bodies={"c": block(1.0, (2, 2, 4), 0.0, THROWN, cell)}))
    glued, alone = (list(sw.march(m, until=0.5, step=0.02))[-1] for m in (model, whole))
    distance = np.linalg.norm(model.points[:, None] - whole.points[None], axis=2)
    assert distance.min(axis=1).max() < 1e-12
    mine, theirs = model.join(glued.after.displacement), alone.after.displacement["c"]
    np.testing.assert_allclose(mine, theirs[distance.argmin(axis=1)], atol=1e-11)
    assert np.abs(mine).max() > 0.1


def test_layers_that_do_not_match_keep_all_balances() -> None:
    layers = {
        "a": block(0.5, (2, 2, 1), 0.0, THROWN, spin=True),
        "b": block(0.5, (3, 3, 2), 0.5, THROWN, spin=True),
    }
    model = sw.build(sw.Scene(bodies=layers, ties=(GLUE,)))
    steps = list(sw.march(model, until=1.0, step=0.02))
    energy = steps[0].ledger.energy_kinetic + steps[0].ledger.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12 * energy
    assert drift(steps, "momentum") < 1e-12 and drift(steps, "spin") < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("cells", [(3, 3, 2), (4, 4, 2)], ids=["matching", "not matching"])
def test_contact_beside_the_glue(cells: tuple[int, int, int]) -> None:
    """A tied block slides into another one and onto a floor, with friction, both across its glue."""
    thrown = sw.bodies.Uniform(value=(0.3, 0.0, -0.1))
    bodies: dict[str, sw.Solid | sw.Tool] = {
        "a": block(0.5, (3, 3, 2), 0.01, thrown),
        "b": block(0.5, cells, 0.51, thrown),
        "floor": sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))),
    }
    mesh = sw.meshes.Box(size=(0.5, 0.8, 0.7), cells=(3, 3, 3), origin=(1.02, 0.1, 0.2))
    bodies["d"] = sw.Solid(mesh=mesh, material=LAW, density=1.0)
    contacts = (sw.Contact(between="all", friction=sw.Coulomb(mu=0.2)),)
    model = sw.build(sw.Scene(bodies=bodies, contacts=contacts, ties=(GLUE,)))
    inner = np.all(np.abs(model.points[:, :2] - 0.5) < 0.49, axis=1)
    inner &= np.abs(model.points[:, 2] - 0.51) < 1e-9
    assert inner.any() and not np.isin(np.flatnonzero(inner), model.touchable).any()
    assert model.massive[inner].all() == (cells == (3, 3, 2))
    steps = list(sw.march(model, until=0.15, step=0.0125))
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12
    assert min(c.min_gap for s in steps for c in s.ledger.contacts.values()) > -1e-12
    touched = {name for s in steps for e in s.events for name in e.bodies}
    assert touched == {"a", "b", "d", "floor"}
    u = model.join(steps[-1].after.displacement)
    np.testing.assert_allclose(model.dofs.nodes(model.dofs.unknowns(u)), u, atol=1e-12)
