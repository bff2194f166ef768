"""Flat interfaces of meshes that do not match: pressure, momentum, linear fields, motion of rigid bodies."""

from itertools import product

import numpy as np
import pytest
from facet_solids import PLANE, SOLIDS

from softway.contact.mortar.mortar import Mortar
from softway.errors import InputError
from softway.meshes.cells import CELLS, linear
from softway.meshes.element import element, tabulate
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

SPACE = ("tri3", "tri6", "quad4", "quad8", "quad9")
KINDS = [*product(PLANE, PLANE), *product(SPACE, SPACE)]


def block(kind: str, cells: int, low: float, seed: int) -> Mesh:
    """A layer of unit width above ``low`` with irregular facets of one kind at its top and bottom."""
    cell = SOLIDS[kind]
    if kind in PLANE:
        mesh = rectangle((1.0, 0.5), (cells, 1), origin=(0.0, low), cell=cell)
    else:
        mesh = box((1.0, 1.0, 0.5), (cells, cells, 1), origin=(0.0, 0.0, low), cell=cell)
    x, rng = mesh.points.copy(), np.random.default_rng(seed)
    columns, column = np.unique(x[:, :-1].round(9), axis=0, return_inverse=True)
    inner = (columns > 1e-9) & (columns < 1.0 - 1e-9)
    x[:, :-1] += (inner * rng.uniform(-0.2, 0.2, columns.shape) / cells)[column]
    nodes, corners = mesh.blocks[cell], CELLS[cell].corners
    x[nodes] = tabulate(linear(cell), CELLS[cell].nodes)[0] @ x[nodes[:, :corners]]  # edges stay straight
    return Mesh(points=x, blocks=mesh.blocks, tags=mesh.tags)


def pair(below: Mesh, above: Mesh, tags: tuple[str, str] = ("top", "bottom")) -> tuple[np.ndarray, Mortar]:
    """Nodes of both bodies, and the mortar with the upper body as slave."""
    x = np.concatenate([below.points, above.points])
    slave = {kind: facets + below.n_nodes for kind, facets in above.facets_on(tags[1]).items()}
    return x, Mortar(slave_facets=slave, master_facets=below.facets_on(tags[0]))


def loads(x: np.ndarray, facets: dict[str, np.ndarray]) -> np.ndarray:
    """Nodal forces (n,) of a unit pressure on facets, as the bodies' elements have them."""
    out = np.zeros(len(x))
    for kind, nodes in facets.items():
        table = element(kind, 8)
        tangents = np.einsum("qar,fad->rfqd", table.dN, x[nodes])
        area = np.linalg.norm(tangents[0] if len(tangents) == 1 else np.cross(*tangents), axis=-1)
        np.add.at(out, nodes, np.einsum("fq,q,qa->fa", area, table.weights, table.N))
    return out


def turned(x: np.ndarray, seed: int) -> np.ndarray:
    """Points after a rigid motion."""
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.standard_normal((x.shape[1],) * 2))[0]
    turn[:, 0] *= np.linalg.det(turn)
    return x @ turn.T + rng.standard_normal(x.shape[1])


@pytest.mark.parametrize(("slave", "master"), KINDS)
def test_uniform_pressure_passes_an_interface_of_irregular_meshes(slave: str, master: str) -> None:
    x, mortar = pair(block(master, 5, 0.0, 1), block(slave, 3, 0.5, 2))
    x = turned(x, 3)
    rows = mortar.meet(x, x, 0.1).at(x)
    weights = rows.weights.toarray()
    own = loads(x, mortar.slave_facets)
    multipliers = np.linalg.solve(weights[:, mortar.node].T, own[mortar.node])
    assert (multipliers > 0.0).all()
    assert np.allclose(weights.T @ multipliers, own - loads(x, mortar.master_facets), atol=1e-13)
    assert np.abs(rows.gap).max() < 1e-14
    assert np.abs(weights.sum(axis=1)).max() < 1e-14


@pytest.mark.parametrize(
    ("slave", "master"),
    [("bar2", "bar3"), ("quad4", "quad9"), ("tri6", "quad4"), ("quad8", "tri6"), ("quad9", "quad8")],
)
def test_linear_fields_are_continuous_over_the_interface(slave: str, master: str) -> None:
    x, mortar = pair(block(master, 4, 0.0, 4), block(slave, 3, 0.5, 5))
    rows = mortar.meet(x, x, 0.1).at(x)
    strain = np.random.default_rng(6).standard_normal((x.shape[1],) * 2)
    assert np.abs(rows.weights @ (x @ strain.T)).max() < 1e-13


@pytest.mark.parametrize("kind", [*PLANE, *SPACE])
def test_bodies_apart_have_the_gap_and_its_derivative_is_exact(kind: str) -> None:
    below, above = block("bar3" if kind in PLANE else "quad4", 4, 0.0, 7), block(kind, 3, 0.5, 8)
    x0, mortar = pair(below, above)
    up = np.zeros_like(x0)
    up[below.n_nodes :, -1] = 1.0
    pairing = mortar.meet(x0 + 0.2 * up, x0, 0.1)
    for height in (0.2, 0.03, 0.0, -0.02, -0.15):
        rows = pairing.at(x0 + height * up)
        assert np.allclose(rows.gap, height, atol=1e-14)
        assert np.allclose(np.einsum("mi,mi->m", rows.normal, rows.weights @ up), 1.0, atol=1e-14)
        assert np.allclose(rows.normal, up[mortar.node], atol=1e-14)


@pytest.mark.parametrize("kind", [*PLANE, *SPACE])
def test_rigid_motions_change_nothing(kind: str) -> None:
    x, mortar = pair(block(kind, 4, 0.0, 9), block(kind, 3, 0.52, 10))
    x = x + 0.01 * np.sin(5.0 * x[:, ::-1])
    before = mortar.meet(x, x, 0.1).at(x)
    after = mortar.meet(turned(x, 11), turned(x, 11), 0.1).at(turned(x, 11))
    assert np.isfinite(before.gap).all()
    assert np.abs(after.gap - before.gap).max() < 1e-13
    assert np.abs((after.weights - before.weights).toarray()).max() < 1e-12


def test_the_patch_test_of_two_strips() -> None:
    """B01: four elements on seven, irregular; the two-node facets of the slave carry D_jj p."""
    slave, master = np.array([0.0, 0.22, 0.51, 0.8, 1.0]), np.array([0.0, 0.1, 0.27, 0.4, 0.58, 0.7, 0.88, 1.0])
    along = np.concatenate([slave, master])
    x = np.stack([along, np.full(12 + 1, 0.5)], axis=1)
    down, up = (np.stack([k, k + 1], axis=1) for k in (np.arange(4), np.arange(5, 12)))
    mortar = Mortar(slave_facets={"bar2": down}, master_facets={"bar2": up[:, ::-1]})
    weights = mortar.meet(x, x, 0.1).at(x).weights.toarray()
    assert np.allclose(weights[:, :5], np.eye(5), atol=1e-15)
    shares = np.convolve(np.diff(slave), [0.5, 0.5])
    assert np.allclose(-weights[:, 5:].T @ shares, np.convolve(np.diff(master), [0.5, 0.5]), atol=1e-15)


def test_facets_of_two_kinds_make_one_surface() -> None:
    square = np.array(
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]
    )
    table = np.array([[-1.0, -1.0, 0.0], [3.0, -1.0, 0.0], [3.0, 2.0, 0.0], [-1.0, 2.0, 0.0]])
    mixed = {"quad4": np.array([[0, 3, 2, 1]]), "tri3": np.array([[1, 2, 4], [4, 2, 5]])}
    x = np.concatenate([square, table])
    mortar = Mortar(slave_facets=mixed, master_facets={"quad4": np.array([[6, 7, 8, 9]])})
    rows = mortar.meet(x, x, 0.1).at(x)
    assert np.allclose(rows.weights.toarray()[:, :6], np.eye(6), atol=1e-15)
    assert np.allclose(rows.normal, [0.0, 0.0, 1.0], atol=1e-15)
    turned_round = Mortar(
        slave_facets={"quad4": np.array([[9, 8, 7, 6]])}, master_facets={k: f[:, ::-1] for k, f in mixed.items()}
    )
    assert np.isfinite(turned_round.meet(x, x, 0.1).at(x).gap).all()


@pytest.mark.parametrize("facets", [{}, {"bar2": np.zeros((0, 2), dtype=int)}, {"point1": np.array([[0]])}])
def test_what_has_no_extent_has_no_mortar(facets: dict[str, np.ndarray]) -> None:
    with pytest.raises(InputError, match="facets"):
        Mortar(slave_facets=facets, master_facets={"bar2": np.array([[0, 1]])})


def askew(dim: int, covered: bool) -> tuple[np.ndarray, Mortar]:
    """A bent surface and another one that is not parallel to it, apart; the second covers all of it or ends before."""
    if dim == 2:
        bent, over = [[0.0, 0.0], [0.5, 0.1], [1.0, 0.0]], [[-1.0, 0.2], [0.3, 0.4], [2.0, 0.6]]
        facets = {"bar2": np.array([[1, 0], [2, 1]])}, {"bar2": np.array([[3, 4], [4, 5]])}
    else:
        bent = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.1], [0.0, 1.0, 0.0]]
        over = [[-1.0, -1.0, 0.3], [2.0, -1.0, 0.6], [2.0, 2.0, 0.9], [-1.0, 2.0, 0.6]]
        facets = {"quad4": np.array([[0, 1, 2, 3]])}, {"quad4": np.array([[4, 7, 6, 5]])}
    x = np.concatenate([bent, over])
    if not covered:
        x[len(bent) :, 0] = 0.4 + 0.3 * x[len(bent) :, 0]
    return x, Mortar(slave_facets=facets[0], master_facets=facets[1])


@pytest.mark.parametrize("covered", [True, False])
@pytest.mark.parametrize("dim", [2, 3])
def test_rows_of_surfaces_that_are_not_parallel_have_no_resultant_and_no_moment(dim: int, covered: bool) -> None:
    """Across an open gap, too: the slave is pushed where the master pushes back, along the normals of the slave."""
    x, mortar = askew(dim, covered)
    rows = mortar.meet(x, x, 1.0).at(x)
    assert np.isfinite(rows.gap).all() and rows.gap.min() > 0.1
    forces = rows.gradient().toarray().reshape(len(rows.gap), *x.shape)
    assert np.abs(forces.sum(axis=1)).max() < 1e-14
    arms = np.zeros((len(x), 3))
    arms[:, :dim] = x
    wide = np.zeros((*forces.shape[:2], 3))
    wide[:, :, :dim] = forces
    assert np.abs(np.cross(arms[None], wide).sum(axis=1)).max() < 1e-14
