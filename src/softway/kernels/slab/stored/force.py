"""Internal forces of solids with stored energies, by the fused kernels.

They are called by their address: a kernel that calls a function contains its code, and compiles it again.
"""

from functools import cache

from softway.kernels.fused.elastic import force as fused
from softway.kernels.jit.by_address import WHOLE, caller
from softway.kernels.jit.compilation import Stage, called, function_at
from softway.kernels.slab.stored.tables import cells_at, stored_at

_call = caller(WHOLE)


@called
def stored_forces(first, d, solids, u, force, energy):
    """Set the internal force (N,) and the energy (parts,) of solids with the ``first`` nodes (parts + 1,)."""
    for part in range(len(first) - 1):
        it = stored_at(solids[part])
        start, n = first[part], first[part + 1] - first[part]
        for i in range(n):
            for a in range(d):
                it.u[i, a] = u[(start + i) * d + a]
        _call(it.forces, solids[part])
        for i in range(n):
            for a in range(d):
                force[(start + i) * d + a] = it.out[i, a]
        energy[part] = it.energy[0]


@cache
def solid_forces() -> Stage:
    """Function of the address of a solid, that computes its forces and its energy."""
    return function_at(WHOLE, _solid_forces)


def _solid_forces(place):
    it = stored_at(place)
    n, d = len(it.u) - len(it.extra) - 1, it.u.shape[1]
    for k in range(len(it.extra)):
        for a in range(d):
            it.u[n + k, a] = it.u[it.extra[k], a]
    it.out[:] = 0.0
    it.energy[0] = 0.0
    for k in range(len(it.cells)):
        c = cells_at(it.cells[k])
        c.energy[:] = 0.0
        parts = len(c.starts) - 1
        fused(c.measure, c.law, c.moduli, c.rows, c.table, c.geometry, c.starts, 0, parts, it.u, it.out, c.energy)
        for block in range(len(c.energy)):
            some = 0.0
            for lane in range(c.energy.shape[1]):
                some += c.energy[block, lane]
            it.energy[0] += some
    for k in range(len(it.extra)):
        for a in range(d):
            it.out[it.extra[k], a] += it.out[n + k, a]
    return 1
