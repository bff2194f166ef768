"""The operator of a slab with pressures as unknowns of its factor: the same answers in the pattern of the cells."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.kernels.geometry.jacobians import cell_geometry
from softway.meshes.element import element, tabulate
from softway.meshes.generators.shapes import box

SHEAR, BULK, LENGTH = 1.0, 1e4, 0.3


def parts(n: int):
    """``A_s``, G and D of decisions/solver/0013: a cube of n^3 bricks of tet10, density one, a slab of 0.3 s."""
    mesh = box((1.0, 1.0, 1.0), (n, n, n), cell="tet10")
    nodes, size = mesh.blocks["tet10"], 3 * mesh.n_nodes
    table = element("tet10", 3)
    gradients, weights, _ = cell_geometry(mesh.points[nodes], table.dN, table.weights)
    e, q, a, _ = gradients.shape
    B = np.zeros((e, q, 3, 3, 3 * a))
    for j in range(3):
        B[:, :, :, j, j::3] = np.moveaxis(gradients, 3, 2)
    strain = 0.5 * (B + np.swapaxes(B, 2, 3)).reshape(e, q, 9, 3 * a)
    trace = np.einsum("eqjjx->eqx", B)
    stiff = np.einsum("eqki,eqkj,eq->eij", strain, strain, weights, optimize=True)
    stiff -= np.einsum("eqi,eqj,eq->eij", trace, trace, weights, optimize=True) / 3.0
    dofs = (nodes[:, :, None] * 3 + np.arange(3)).reshape(e, -1)
    K = assembled(2.0 * SHEAR * stiff, dofs, dofs, (size, size))
    mass = np.zeros(size)
    lumped = np.einsum("qa,eq->ea", np.abs(table.N), weights)
    np.add.at(mass, dofs.reshape(e, a, 3), lumped[:, :, None])
    corner = tabulate("tet4", table.points)[0]
    G = assembled(np.einsum("qc,eqi,eq->eci", corner, trace, weights), nodes[:, :4], dofs, (mesh.n_nodes, size))
    W = np.zeros(mesh.n_nodes)
    np.add.at(W, nodes[:, :4], np.einsum("qc,eq->ec", corner, weights))
    used = W > 0.0
    quarter = LENGTH**2 / 4.0
    return sp.csc_array(sp.diags_array(mass) + quarter * K), sp.csr_array(G)[used], quarter * BULK / W[used]


def assembled(blocks, rows, columns, shape):
    at = (np.broadcast_to(rows[:, :, None], blocks.shape), np.broadcast_to(columns[:, None], blocks.shape))
    return sp.csr_array((blocks.ravel(), (at[0].ravel(), at[1].ravel())), shape=shape)


def test_the_extended_factor_is_the_operator() -> None:
    A, G, D = parts(3)
    wide = sp.csc_array(A + G.T @ sp.diags_array(D) @ G)
    extended = sp.csc_array(sp.block_array([[A, G.T], [G, sp.diags_array(-1.0 / D)]]))
    assert extended.nnz < 0.2 * wide.nnz
    b = np.random.default_rng(2).standard_normal(A.shape[0])
    exact = splu(wide).solve(b)
    found = splu(extended).solve(np.concatenate([b, np.zeros(len(D))]))[: len(b)]
    assert np.abs(found - exact).max() < 1e-11 * np.abs(exact).max()


def test_it_is_quasi_definite() -> None:
    """As many negative eigenvalues as there are pressures, and none at zero."""
    A, G, D = parts(1)
    root = sp.diags_array(np.sqrt(D))
    scaled = sp.block_array([[A, G.T @ root], [root @ G, -sp.eye_array(len(D))]]).toarray()
    values = np.linalg.eigvalsh(scaled)
    assert (values < 0.0).sum() == len(D) and np.abs(values).min() > 1e-4
    assert np.linalg.eigvalsh(A.toarray()).min() > 0.0
