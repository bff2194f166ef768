"""Internal forces of solids with stored energies, by the fused kernels."""

from softway.kernels.fused.elastic import force as fused
from softway.kernels.jit.compilation import called
from softway.kernels.slab.stored.tables import cells_at, stored_at


@called
def stored_forces(first, d, solids, u, force, energy):
    """Set the internal force (N,) and the energy (parts,) of solids with the ``first`` nodes (parts + 1,)."""
    for part in range(len(first) - 1):
        it = stored_at(solids[part])
        start, n, rows = first[part], first[part + 1] - first[part], len(it.u)
        for i in range(rows):
            k = i if i < n else it.extra[i - n] if i + 1 < rows else -1
            for a in range(d):
                it.u[i, a] = u[(start + k) * d + a] if k >= 0 else 0.0
                it.out[i, a] = 0.0
        total = 0.0
        for k in range(len(it.cells)):
            total += _of_cells(it.cells[k], it.u, it.out)
        for k in range(len(it.extra)):
            for a in range(d):
                it.out[it.extra[k], a] += it.out[n + k, a]
        for i in range(n):
            for a in range(d):
                force[(start + i) * d + a] = it.out[i, a]
        energy[part] = total


@called
def _of_cells(place, u, out):
    """Add the forces of cells of one type to ``out`` (n, d); their energy."""
    it, total = cells_at(place), 0.0
    it.energy[:] = 0.0
    fused(
        it.measure,
        it.law,
        it.moduli,
        it.rows,
        it.table,
        it.geometry,
        it.starts,
        0,
        len(it.starts) - 1,
        u,
        out,
        it.energy,
    )
    for block in range(len(it.energy)):
        some = 0.0
        for lane in range(it.energy.shape[1]):
            some += it.energy[block, lane]
        total += some
    return total
