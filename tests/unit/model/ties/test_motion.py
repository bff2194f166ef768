"""Tied solids in motion: like one body where the meshes match, and with all balances where they do not."""

import numpy as np
import pytest

import softway as sw

LAW = sw.NeoHookean(E=10.0, nu=0.3)
THROWN = sw.bodies.Affine(gradient=((0.2, -0.4), (0.4, -0.3)))


def layer(height: float, cells: tuple[int, int], base: float, velocity: object, cell: str = "") -> sw.Solid:
    """A layer of a block of width one, its lower side at ``base``; with a ``cell``, the spin of slabs is not closed."""
    mesh = sw.meshes.Rectangle(size=(1.0, height), cells=cells, origin=(0.0, base), cell=cell or "quad4")
    force = sw.bodies.Weighted() if cell else sw.bodies.EnergyMomentum()
    return sw.Solid(mesh=mesh, material=LAW, density=1.0, velocity=velocity, force=force)


def two(one: tuple[int, int], other: tuple[int, int], velocity: object, cell: str = "") -> dict[str, sw.Solid]:
    """A layer ``a`` of height 0.5 below a layer ``b`` of height 0.25."""
    return {"a": layer(0.5, one, 0.0, velocity, cell), "b": layer(0.25, other, 0.5, velocity, cell)}


GLUE = sw.Tie(between=("a.top", "b.bottom"))


def drift(steps: list[sw.Step], name: str) -> float:
    """Greatest change of a momentum in a march."""
    values = np.array([getattr(s.ledger, name) for s in steps])
    return float(np.abs(values - values[0]).max())


@pytest.mark.parametrize("cell", ["quad4", "tri6"])
def test_matching_layers_are_one_body(cell: str) -> None:
    """A free block in two layers moves like the block of one mesh, to rounding."""
    parts = two((4, 4), (4, 2), THROWN, cell)
    model = sw.build(sw.Scene(bodies=parts, ties=(GLUE,)))
    whole = sw.build(sw.Scene(bodies={"c": layer(0.75, (4, 6), 0.0, THROWN, cell)}))
    glued, alone = (list(sw.march(m, until=1.0, step=0.02)) for m in (model, whole))
    same = np.linalg.norm(model.points[:, None] - whole.points[None], axis=2).argmin(axis=1)
    mine = model.join(glued[-1].after.displacement)
    np.testing.assert_allclose(mine, alone[-1].after.displacement["c"][same], atol=1e-11)
    assert np.abs(mine).max() > 0.2


@pytest.mark.few(2)
@pytest.mark.parametrize(
    "method",
    [
        sw.FixedPoint(),
        sw.Newton(),
        sw.FixedPoint(operator=sw.solve.MatrixFree()),
        sw.FixedPoint(operator=sw.solve.Multigrid()),
    ],
    ids=["fixed-point", "newton", "matrix-free", "multigrid"],
)
def test_layers_that_do_not_match_keep_all_balances(method: sw.FixedPoint | sw.Newton) -> None:
    """A free block that spins and vibrates keeps energy, momentum and angular momentum; the surfaces stay closed."""
    model = sw.build(sw.Scene(bodies=two((4, 4), (7, 2), THROWN), ties=(GLUE,)))
    steps = list(sw.march(model, until=2.0, step=0.02, method=method))
    energy = steps[0].ledger.energy_kinetic + steps[0].ledger.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12 * energy
    assert drift(steps, "momentum") < 1e-12
    assert drift(steps, "spin") < 1e-10
    u = model.join(steps[-1].after.displacement)
    np.testing.assert_allclose(model.dofs.nodes(model.dofs.unknowns(u)), u, atol=1e-12)


@pytest.mark.slow
def test_three_layers_and_a_tool() -> None:
    """A stack of three layers that do not match falls on the floor and rebounds: the energy is kept."""
    down = sw.bodies.Uniform(value=(0.05, -0.2))
    parts: dict[str, sw.Solid | sw.Tool] = {**two((4, 4), (7, 2), down), "c": layer(0.25, (5, 2), 0.75, down)}
    parts["floor"] = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    ties = (GLUE, sw.Tie(between=("b.top", "c.bottom")))
    contacts = (sw.Contact(between=("a.bottom", "floor"), friction=sw.Coulomb(mu=0.3)),)
    model = sw.build(sw.Scene(bodies=parts, contacts=contacts, ties=ties))
    assert model.linked.tolist() == [0, 0, 0]
    steps = list(sw.march(model, until=2.0, step=0.02))
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12
    assert steps[-1].ledger.momentum[1] > 0.15
    assert any(e.kind == "touch" for s in steps for e in s.events)


def test_two_pieces_of_one_body() -> None:
    """A tie within a body whose mesh has two pieces, with contact of the body with itself and the floor."""
    lower = sw.meshes.Rectangle(size=(1.0, 0.5), cells=(6, 3), origin=(0.0, 0.02)).build()
    upper = sw.meshes.Rectangle(size=(0.6, 0.4), cells=(5, 4), origin=(0.2, 0.52)).build()
    n = lower.n_nodes
    mesh = sw.Mesh(
        points=np.concatenate([lower.points, upper.points]),
        blocks={"quad4": np.concatenate([lower.blocks["quad4"], upper.blocks["quad4"] + n])},
        tags={"under": lower.nodes("top"), "over": upper.nodes("bottom") + n},
    )
    thrown = sw.bodies.Uniform(value=(0.05, -0.4))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.1, 1.0)))
    bodies = {"s": sw.Solid(mesh=mesh, material=LAW, density=1.0, velocity=thrown), "floor": floor}
    ties = (sw.Tie(between=("s.under", "s.over")),)
    model = sw.build(sw.Scene(bodies=bodies, contacts=(sw.Contact(between="all"),), ties=ties))
    steps = list(sw.march(model, until=1.0, step=0.02))
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12
    assert min(c.min_gap for s in steps for c in s.ledger.contacts.values()) > -1e-12
    assert {e.bodies for s in steps for e in s.events} == {("s", "floor")}
    assert steps[-1].ledger.momentum[1] > 0.1
    u = model.join(steps[-1].after.displacement)
    np.testing.assert_allclose(model.dofs.nodes(model.dofs.unknowns(u)), u, atol=1e-12)


def test_all_surfaces_with_a_second_body() -> None:
    """A tied block hits another one beside its glue: the rims carry the contact, the glued surfaces have none."""
    thrown = sw.bodies.Uniform(value=(0.2, 0.0))
    mesh = sw.meshes.Rectangle(size=(0.5, 0.75), cells=(3, 5), origin=(1.01, 0.02))
    parts = two((4, 4), (4, 2), thrown) | {"d": sw.Solid(mesh=mesh, material=LAW, density=1.0)}
    model = sw.build(sw.Scene(bodies=parts, contacts=(sw.Contact(between="all"),), ties=(GLUE,)))
    steps = list(sw.march(model, until=0.6, step=0.01))
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12
    assert drift(steps, "momentum") < 1e-12
    touched = {name for s in steps for e in s.events for name in e.bodies}
    assert touched == {"a", "b", "d"}
    inner = np.flatnonzero((model.points[:, 1] == 0.5) & (model.points[:, 0] > 0.0) & (model.points[:, 0] < 1.0))
    assert model.massive[inner].all()
    assert not np.isin(inner, model.touchable).any()


def test_a_wave_passes_the_glue() -> None:
    """Behind a pulse that goes through a tie of meshes that do not match, less than 2e-3 of its speed is left."""
    at = np.linspace(0.0, 3.0, 1501)
    pulse = np.exp(-(((at - 0.9) / 0.15) ** 2))
    profile = {"displacement": 1e-3 * pulse, "velocity": 2e-3 * pulse * (at - 0.9) / 0.15**2}
    fields = {k: sw.bodies.Profile(at=tuple(at), values=tuple(v)) for k, v in profile.items()}
    parts = {}
    for name, origin, cells in (("a", 0.0, (75, 4)), ("b", 1.5, (75, 6))):
        mesh = sw.meshes.Rectangle(size=(1.5, 0.16), cells=cells, origin=(origin, 0.0))
        law = sw.LinearElastic(E=1.0, nu=0.0)
        parts[name] = sw.Solid(mesh=mesh, material=law, density=1.0, **fields)
    model = sw.build(sw.Scene(bodies=parts, ties=(sw.Tie(between=("a.right", "b.left")),)))
    steps = list(sw.march(model, until=1.25, step=0.01))
    behind, ahead = (np.abs(steps[-1].after.velocity[n]).max() for n in ("a", "b"))
    assert behind < 2e-3 * np.abs(profile["velocity"]).max()
    assert ahead > 0.95 * np.abs(profile["velocity"]).max()
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-12 * steps[0].ledger.energy_kinetic
