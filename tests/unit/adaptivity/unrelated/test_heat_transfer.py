"""Heat between unrelated meshes: contents to rounding, ranges, entropies, uniform and linear temperatures, order."""

from itertools import pairwise

import numpy as np
import pytest
import scipy.sparse as sp

from softway.adaptivity.unrelated.heat import HeatTransfer, heat_transfer, require_simplices, sampled
from softway.adaptivity.unrelated.transport_plan import transport_plan
from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric, PlaneStrain, Section, Volume
from softway.bodies.inertia.nodal_heat import heat_masses
from softway.errors import InputError
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

CELLS = ("tri3", "tri6", "quad4", "quad8", "quad9", "tet4", "tet10", "hex8", "hex27")


def irregular(cell: str, count: int, seed: int) -> Mesh:
    """Unit square or cube; the nodes inside of linear cells are moved."""
    space = cell.startswith(("tet", "hex"))
    mesh = box((1.0,) * 3, (count,) * 3, cell=cell) if space else rectangle((1.0, 1.0), (count, count), cell=cell)
    if cell not in ("tri3", "quad4", "tet4", "hex8"):
        return mesh
    inside = np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes("surface"))
    points = np.array(mesh.points)
    points[inside] += 0.2 / count * np.random.default_rng(seed).uniform(-1.0, 1.0, (len(inside), mesh.dim))
    return Mesh(points=points, blocks=mesh.blocks, tags=mesh.tags)


def section_of(mesh: Mesh) -> Section:
    return Volume() if mesh.dim == 3 else Axisymmetric()


def passed(one: Mesh, other: Mesh, section: Section) -> tuple[HeatTransfer, Array, Array]:
    """Transfer between two meshes, and the capacities of their nodes."""
    before, after = (heat_masses(mesh, section, 3.0) for mesh in (one, other))
    sides = (sampled(mesh.blocks, mesh.points, section) for mesh in (one, other))
    return heat_transfer(*sides, before, after), before, after


@pytest.mark.parametrize("cell", CELLS)
def test_contents_ranges_and_entropies(cell: str) -> None:
    rng = np.random.default_rng(5)
    for counts in ((2, 3), (3, 2)):
        one, other = (irregular(cell, count, seed) for seed, count in enumerate(counts))
        transfer, before, after = passed(one, other, section_of(one))
        values = 300.0 + 200.0 * rng.uniform(size=one.n_nodes) + 900.0 * one.points[:, 0] ** 8
        entropy = float(before @ np.log(values))
        found = transfer.carried(values, entropy, np.log)
        assert after @ found == pytest.approx(before @ values, rel=1e-14)
        assert values.min() * (1.0 - 1e-12) <= found.min()
        assert found.max() <= values.max() * (1.0 + 1e-12)
        assert after @ np.log(found) >= entropy * (1.0 - 1e-14)
        even = transfer.carried(np.full(one.n_nodes, 700.0), 700.0, np.log)
        assert even == pytest.approx(700.0, rel=1e-14)
        mixed = transfer.mixed(found)
        assert after @ mixed == pytest.approx(before @ values, rel=1e-14)
        assert after @ np.log(mixed) > after @ np.log(found)


@pytest.mark.parametrize("cell", ["tri3", "tet4"])
def test_the_same_mesh_keeps_every_temperature(cell: str) -> None:
    mesh = irregular(cell, 3, 1)
    transfer, before, _ = passed(mesh, mesh, PlaneStrain() if mesh.dim == 2 else Volume())
    values = np.random.default_rng(2).uniform(300.0, 900.0, mesh.n_nodes)
    found = transfer.carried(values, float(before @ np.log(values)), np.log)
    assert found == pytest.approx(values, rel=1e-9)


def test_errors_on_finer_meshes_are_of_second_order() -> None:
    def exact(points: Array) -> Array:
        return 300.0 + 10.0 * points[:, 0] ** 2 + np.sin(3.0 * points[:, 1])

    errors = []
    for count in (10, 20, 40):
        one, other = irregular("tri3", count, 1), irregular("tri3", count * 13 // 10, 2)
        transfer, before, after = passed(one, other, PlaneStrain())
        values = exact(one.points)
        found = transfer.carried(values, float(before @ np.log(values)), np.log)
        errors.append(np.sqrt(after @ (found - exact(other.points)) ** 2 / after.sum()))
    assert errors[0] < 0.02
    assert all(fine < 0.55 * coarse for coarse, fine in pairwise(errors))
    assert errors[2] < 0.2 * errors[0]


def test_sums_are_exact_where_no_factors_give_them() -> None:
    """Two bodies that have nothing in common but the sum: what one has too much the other gets."""
    kernel = sp.csr_array(np.array([[1.0, 0.5, 0.0], [0.2, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    rows, columns = np.array([1.0, 2.0, 3.0]), np.array([1.5, 1.0, 3.5])
    plan = transport_plan(kernel, rows, columns)
    whole = plan.amounts.toarray() + np.outer(plan.given, plan.taken) / plan.given.sum()
    assert whole.min() >= 0.0
    assert whole.sum(axis=1) == pytest.approx(rows, rel=1e-14)
    assert whole.sum(axis=0) == pytest.approx(columns, rel=1e-14)
    assert plan.means(np.array([1.0, 2.0, 3.0])) == pytest.approx(whole.T @ [1.0, 2.0, 3.0] / columns, rel=1e-14)


def test_serendipity_hexahedra_have_no_simplices() -> None:
    with pytest.raises(InputError, match="hex20"):
        require_simplices(["hex20"])
