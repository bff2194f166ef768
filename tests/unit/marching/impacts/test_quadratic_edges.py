"""Bodies with quadratic facets that meet between their nodes: edges of the triangles over the nodes have rows."""

import numpy as np
import pytest

import softway as sw
from softway.contact.contact import Contact, NodeToSurface
from softway.marching.start.initial_state import initial_state
from softway.meshes import Ball, Box, Mesh
from softway.record.audit.geometry.overlap import overlaps
from softway.record.audit.geometry.solids import Solids, solids

BOTH = NodeToSurface(nodes="both")
RUBBER = sw.NeoHookean(E=1e6, nu=0.3)


def solid(mesh: Mesh, speed: float = 0.0) -> sw.Solid:
    motion = sw.bodies.Uniform(value=(0.0, 0.0, -speed))
    return sw.Solid(mesh=mesh, material=RUBBER, density=1000.0, velocity=motion)


def ridge(cell: str, cells: tuple[int, int, int], *, upper: bool) -> Mesh:
    """Sheet bent smoothly over a ridge along x, with the top at z = 0, or one above it whose ridge is along y."""
    plain = Box(size=(0.12, 0.12, 0.02), cells=cells, origin=(-0.06, -0.06, -0.02), cell=cell).build()
    x = np.array(plain.points)
    x[:, 2] -= 2.0 * (np.hypot(x[:, 1], 0.01) - 0.01)
    if upper:
        x = x[:, [1, 0, 2]] * [1.0, 1.0, -1.0] + [0.004, 0.003, 5e-4]
    return Mesh(points=x, blocks=plain.blocks, tags=plain.tags)


def as_seen(bodies: dict[str, sw.Solid]) -> Solids:
    """Bodies as the audit of a run sees them; all cells of a kind are in one body here or there."""
    points, blocks, owners, first = [], {}, {}, 0
    for k, body in enumerate(bodies.values()):
        points.append(body.mesh.points)
        for cell, nodes in body.mesh.blocks.items():
            blocks.setdefault(cell, []).append(nodes + first)
            owners.setdefault(cell, []).append(np.full(len(nodes), k))
        first += len(body.mesh.points)
    joined = [{cell: np.concatenate(found) for cell, found in parts.items()} for parts in (blocks, owners)]
    return solids(list(bodies), np.concatenate(points), *joined)


def deepest(bodies: dict[str, sw.Solid], method: NodeToSurface | None, until: float) -> tuple[float, float]:
    """Greatest depth at nodes and between them that the audit sees [m]; the bodies push, and energy is conserved."""
    between = "all" if method is None else tuple(bodies)
    scene = sw.Scene(bodies=bodies, contacts=(Contact(between=between, method=method),))
    seen, nodes, most, force = as_seen(bodies), 0.0, 0.0, 0.0
    for step in sw.march(scene, until=until, step=2e-4):
        x = seen.reference + np.concatenate([step.after.displacement[name] for name in bodies])
        found = overlaps(seen, x)
        at_node = found.ends[:, 0] == found.ends[:, 1]
        nodes = max(nodes, found.depth[at_node].max(initial=0.0))
        most = max(most, found.depth[~at_node].max(initial=0.0))
        force = max(force, *(c.force_n for c in step.ledger.contacts.values()))
        assert abs(step.ledger.energy_error) < 1e-11 * (step.ledger.energy_kinetic + step.ledger.energy_strain)
    assert force > 20.0
    return nodes, most


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lower", "upper"), [(("hex27", (1, 4, 1)), ("hex27", (1, 4, 1))), (("hex27", (3, 2, 1)), ("hex20", (3, 4, 2)))]
)
def test_smooth_ridges_that_cross_between_nodes_do_not_overlap(
    lower: tuple[str, tuple[int, int, int]], upper: tuple[str, tuple[int, int, int]]
) -> None:
    """Their edges are not sharp, so a contact of the two solids has no rows for them: they pierce."""
    bodies = {"a": solid(ridge(*lower, upper=False)), "b": solid(ridge(*upper, upper=True), 2.0)}
    assert deepest(bodies, BOTH, 0.002)[1] > 5e-4
    assert deepest(bodies, None, 0.002) == (0.0, 0.0)


@pytest.mark.slow
def test_quadratic_facets_on_bilinear_ones_do_not_overlap() -> None:
    bodies = {"a": solid(ridge("hex8", (4, 6, 2), upper=False)), "b": solid(ridge("hex27", (1, 4, 1), upper=True), 2.0)}
    assert max(deepest(bodies, None, 0.002)) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["hex20", "hex27"])
def test_smooth_balls_push_as_two_solids_do(cell: str) -> None:
    """Nodes are on curved facets; the edges of flat triangles lie below them and do not touch."""
    mesh = Ball(radius=0.05, cells=4, cell=cell).build()
    moved = Mesh(points=mesh.points + [0.013, 0.007, 0.1], blocks=mesh.blocks, tags=mesh.tags)
    bodies, found = {"a": solid(mesh), "b": solid(moved, 2.0)}, []
    for contact in (Contact(between="all"), Contact(between=("a", "b"), method=BOTH)):
        steps = list(sw.march(sw.Scene(bodies=bodies, contacts=(contact,)), until=0.004, step=4e-4))
        found.append([c.force_n for step in steps for c in step.ledger.contacts.values()])
    assert max(found[0]) > 50.0
    assert found[0] == pytest.approx(found[1], rel=1e-8, abs=1e-8)


def turned(cell: str) -> dict[str, sw.Solid]:
    """Three blocks of quadratic cells, turned and shifted, that fall on each other."""
    bodies = {}
    for k, name in enumerate("abc"):
        plain = Box(size=(0.1, 0.1, 0.1), cells=(2, 2, 2), cell=cell).build()
        c, s = np.cos(0.35 * k), np.sin(0.35 * k)
        x = (np.asarray(plain.points) - 0.05) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        mesh = Mesh(points=x + [0.02 * k, 0.013 * k, 0.103 * k], blocks=plain.blocks, tags=plain.tags)
        bodies[name] = solid(mesh, 2.0 * k)
    return bodies


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["tet10", "hex20", "hex27"])
def test_turned_blocks_overlap_between_nodes_by_their_curvature_only(cell: str) -> None:
    """Nodes of one block are on the facets of another; what is left is the bow of an edge over its two halves, below
    one hundredth of a cell.
    """
    nodes, between = deepest(turned(cell), None, 0.0026)
    assert nodes < 1e-12
    assert between < 0.01 * 0.05


def test_a_patch_of_two_blocks_of_skew_cells_bears_uniform_stress() -> None:
    """Nodes lie on nodes and edges on edges, which are flat and have no rows; no digits are lost to redundant ones."""
    bodies = {}
    for k, name in enumerate(("lower", "upper")):
        plain = Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 2), origin=(0.0, 0.0, float(k)), cell="hex27").build()
        x = np.array(plain.points)
        x[:, :2] += 0.06 * (np.sin(np.pi * x[:, 0]) * np.sin(np.pi * x[:, 1]))[:, None] * [1.0, 0.7]
        held = [sw.Fixed(on="left", components="x"), sw.Fixed(on="front", components="y")]
        held += [sw.Fixed(on="bottom", components="z")] if k == 0 else []
        mesh = Mesh(points=x, blocks=plain.blocks, tags=plain.tags)
        material = sw.LinearElastic(E=1e6, nu=0.3)
        bodies[name] = sw.Solid(mesh=mesh, material=material, density=1.0, supports=tuple(held))
    scene = sw.Scene(
        bodies=bodies,
        contacts=(Contact(between="all"),),
        loads=(sw.Traction(on="upper.top", value=(0.0, 0.0, -1.0)),),
        start=sw.model.StaticStart(),
    )
    model = sw.build(scene)
    first = initial_state(model)
    own = model.split(first.start.displacement)
    stress = np.concatenate([model.stress(name, own[name]) for name in bodies])
    exact = np.zeros((3, 3))
    exact[2, 2] = -1.0
    assert np.abs(stress - exact).max() < 1e-9
    assert first.pressure.sum() == pytest.approx(1.0, rel=1e-9)
