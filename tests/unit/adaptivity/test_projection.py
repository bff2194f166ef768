"""Projections between meshes against the exact ones on the united mesh."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve
from turning import around, moving, on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid, adapted_solid
from softway.adaptivity.projections.projection import projection
from softway.meshes.adaptive.overlay import common_matrix, embedding, overlay, united
from softway.meshes.generators.shapes import box, disc, interval, rectangle
from softway.meshes.mesh import Mesh

MESHES = [
    interval(1.0, cells=6),
    interval(1.0, cells=4, cell="bar3"),
    rectangle((1.0, 1.0), (4, 4), cell="tri3"),
    rectangle((1.0, 1.0), (3, 3), cell="tri6"),
    disc(1.0, 4, cell="tri6"),
    box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"),
    box((1.0, 1.0, 1.0), (2, 1, 1), cell="tet10"),
]


def pair(mesh: Mesh, **others: object) -> tuple[AdaptedSolid, AdaptedSolid]:
    """A body on a mesh that is fine at one end, and on one that is fine at the other."""
    body = solid(mesh, sw.LinearElastic(E=1.0, nu=0.3), **others)
    ends = mesh.points.min(axis=0), mesh.points.max(axis=0)
    before, after = (on_levels(body, around(body, place, 4, 0.6)) for place in ends)
    return before, after


@pytest.mark.parametrize("mesh", MESHES, ids=lambda mesh: next(iter(mesh.blocks)))
def test_velocities_have_the_momenta_of_all_functions(mesh: Mesh) -> None:
    before, after = pair(mesh)
    velocity = moving(before).velocity
    masses = before.element_masses(), after.element_masses()
    common = common_matrix(overlay(before.adapted, after.adapted), *masses)
    mass = common_matrix(overlay(after.adapted, after.adapted), masses[1], masses[1])
    momenta = common.T @ velocity
    found = mass @ projection(before, after).velocity(velocity)
    assert found == pytest.approx(momenta, abs=1e-13 * abs(momenta).max())
    assert abs(after.consistent_mass() - mass).max() < 1e-14 * abs(mass).max()


@pytest.mark.parametrize("mesh", MESHES[:-2], ids=lambda mesh: next(iter(mesh.blocks)))
def test_displacements_are_near_the_exact_projection_with_its_centre_of_mass(mesh: Mesh) -> None:
    before, after = pair(mesh)
    u = moving(before).displacement
    cast = projection(before, after)
    both = united(before.adapted, after.adapted)
    ours, theirs = (wide(embedding(m.adapted, both), mesh.dim) for m in (after, before))
    whole = adapted_solid("body", before.solid, both, np.zeros(0, int))
    form = wide(whole.consistent_mass(), mesh.dim) + cast.time**2 * whole.part.tangent(np.zeros(whole.points.shape))
    exact = spsolve(sp.csc_array(ours.T @ form @ ours), ours.T @ (form @ (theirs @ u.ravel())))
    near = (cast.values.forward @ u).ravel()
    found = cast.displacement(u).ravel()
    mass = wide(after.consistent_mass(), mesh.dim)
    if mesh is not MESHES[4]:  # stiffness of curved cells depends on the quadrature
        assert size(ours.T @ form @ ours, found - exact) < 1e-3 * size(ours.T @ form @ ours, near - exact) + 1e-13
        totals = [(mass @ x).reshape(-1, mesh.dim).sum(axis=0) for x in (found, exact)]
        assert totals[0] == pytest.approx(
            totals[1], abs=1e-11 * abs(mass @ exact).sum()
        )  # rounding of the stiffness in both
    assert size(ours.T @ form @ ours, found - exact) < 0.02 * size(ours.T @ form @ ours, exact)


@pytest.mark.parametrize("cell", ["quad4", "quad8", "quad9", "hex8", "hex20", "hex27"])
def test_projections_of_cells_with_hanging_nodes_are_exact(cell: str) -> None:
    flat = cell.startswith("quad")
    mesh = rectangle((1.0, 1.0), (3, 3), cell=cell) if flat else box((3.0, 1.0, 1.0), (3, 1, 1), cell=cell)
    body = solid(mesh, sw.LinearElastic(E=1.0, nu=0.3))
    cut = mesh.dim * (np.arange(mesh.n_cells) == 0)
    before, after = on_levels(body, (2 if flat else 1) * cut), on_levels(body, cut[::-1])
    assert before.adapted.mesh.hanging is not None
    motion, cast, dofs = moving(before), projection(before, after), after.dofs
    common = common_matrix(overlay(before.adapted, after.adapted), before.element_masses(), after.element_masses())
    momenta = dofs.forces(common.T @ motion.velocity)
    found = dofs.forces(after.consistent_mass() @ cast.velocity(motion.velocity))
    assert found == pytest.approx(momenta, abs=1e-13 * abs(momenta).max())
    both = united(before.adapted, after.adapted)
    ours, theirs = (wide(embedding(m.adapted, both), mesh.dim) for m in (after, before))
    whole = adapted_solid("body", before.solid, both, np.zeros(0, int))
    form = wide(whole.consistent_mass(), mesh.dim) + cast.time**2 * whole.stiffness()
    pushed = dofs.forces((ours.T @ (form @ (theirs @ motion.displacement.ravel()))).reshape(after.points.shape))
    exact = dofs.nodes(spsolve(dofs.matrix(sp.csc_array(ours.T @ form @ ours)), pushed))
    assert cast.displacement(motion.displacement) == pytest.approx(exact, abs=1e-10 * abs(exact).max())


def wide(matrix: sp.csr_array, d: int) -> sp.csr_array:
    """Matrix that acts on each of d components."""
    return sp.csr_array(sp.kron(matrix, sp.eye_array(d), format="csr"))


def size(form: sp.csr_array, field: np.ndarray) -> float:
    """Norm of a field in a form."""
    return float(np.sqrt(field @ (form @ field)))


def test_nothing_is_solved_on_a_finer_mesh() -> None:
    body = solid(rectangle((1.0, 1.0), (4, 4), cell="tri3"))
    before, after = (on_levels(body, around(body, np.zeros(2), k)) for k in (2, 4))
    field = np.random.default_rng(3).normal(size=before.points.shape)
    cast = projection(before, after)
    values = cast.values.forward @ field
    assert np.array_equal(cast.velocity(field), values)
    assert np.array_equal(cast.displacement(field), values)
    assert np.array_equal(cast.values.back @ values, field)


def test_supports_along_a_direction() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3")
    before, after = pair(mesh, supports=(sw.Fixed(on="bottom", direction=(1.0, 1.0)),))
    motion = moving(before)
    cast = projection(before, after)
    low = after.adapted.mesh.nodes("bottom")
    for field in (cast.velocity(motion.velocity), cast.displacement(motion.displacement)):
        assert (field[low] @ np.ones(2)) == pytest.approx(np.zeros(len(low)), abs=1e-14)
