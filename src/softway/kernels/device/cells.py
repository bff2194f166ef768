"""Internal force, products of its tangent, and diagonal blocks: one thread for each cell, then one for each node.

A thread of a cell writes its forces to rows of its own, and a thread of a node adds the rows of its cells in a fixed
order: no atomic operations, so the same device gives the same bits in every run.

Common arguments:

``law``, ``bulk_part``, ``shear``
    Number of the law, see :mod:`softway.kernels.device.materials`, and its constants [Pa].
``rows`` (a, e)
    Node of each corner a of the cells.
``table`` (q, a, 3), ``geometry`` (q, 10, e)
    Derivatives of the shape functions along the reference coordinates; ``X_Jr = dxi_r/dX_J`` [1/m] in row 3 J + r, and
    the volume of the point [m^3].
``first``
    Row of ``own`` of the first corner of the first cell; corner a of cell e has the row ``first + a E + e``.
``u``, ``w`` (n d,)
    Displacement and its change [m].
``own`` (rows, d) or (rows, d d)
    Forces [N], or stiffness [N/m], of the cells.
"""

from softway.kernels.device.door import wp
from softway.kernels.device.materials import carrier, energy, flux_change, strain, stress


@wp.func
def natural(u: wp.array(dtype=wp.float64), rows: wp.array2d(dtype=wp.int32), table: wp.array3d(dtype=wp.float64),
            q: int, cell: int, d: int):  # fmt: skip
    """Derivatives ``D_ri`` of a nodal field along the reference coordinates."""
    D = wp.mat33d()
    for a in range(rows.shape[0]):
        at = rows[a, cell] * d
        for i in range(d):
            value = u[at + i]
            for r in range(d):
                D[r, i] = D[r, i] + table[q, a, r] * value
    return D


@wp.func
def inverse_slopes(geometry: wp.array3d(dtype=wp.float64), q: int, cell: int):
    """``X_Jr`` of a point."""
    X = wp.mat33d()
    for J in range(3):
        for r in range(3):
            X[J, r] = geometry[q, 3 * J + r, cell]
    return X


@wp.func
def collect(D: wp.mat33d, table: wp.array3d(dtype=wp.float64), own: wp.array2d(dtype=wp.float64),
            place: int, q: int, a: int, d: int):  # fmt: skip
    """Add ``f_ai = sum_r table_ar D_ri`` to the row ``place`` of a corner."""
    for i in range(d):
        value = own[place, i]
        for r in range(d):
            value = value + table[q, a, r] * D[r, i]
        own[place, i] = value


@wp.kernel
def force(law: int, bulk_part: wp.float64, shear: wp.float64, d: int, first: int, start: int,
          rows: wp.array2d(dtype=wp.int32), table: wp.array3d(dtype=wp.float64),
          geometry: wp.array3d(dtype=wp.float64), u: wp.array(dtype=wp.float64),
          own: wp.array2d(dtype=wp.float64), energies: wp.array(dtype=wp.float64)):  # fmt: skip
    """Forces of the cells, and their energies [J] from ``start`` on."""
    cell = wp.tid()
    corners, cells = rows.shape[0], rows.shape[1]
    for a in range(corners):
        for i in range(d):
            own[first + a * cells + cell, i] = wp.float64(0.0)
    total = wp.float64(0.0)
    for q in range(table.shape[0]):
        X = inverse_slopes(geometry, q, cell)
        H = X * natural(u, rows, table, q, cell, d)
        E = strain(law, H)
        volume = geometry[q, 9, cell]
        total = total + volume * energy(law, bulk_part, shear, E)
        D = volume * (wp.transpose(X) * (stress(law, bulk_part, shear, E) * carrier(law, H)))
        for a in range(corners):
            collect(D, table, own, first + a * cells + cell, q, a, d)
    energies[start + cell] = total


@wp.kernel
def product(law: int, bulk_part: wp.float64, shear: wp.float64, d: int, first: int,
            rows: wp.array2d(dtype=wp.int32), table: wp.array3d(dtype=wp.float64),
            geometry: wp.array3d(dtype=wp.float64), u: wp.array(dtype=wp.float64),
            w: wp.array(dtype=wp.float64), own: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Changes of the forces of the cells due to a change w of the displacement."""
    cell = wp.tid()
    corners, cells = rows.shape[0], rows.shape[1]
    for a in range(corners):
        for i in range(d):
            own[first + a * cells + cell, i] = wp.float64(0.0)
    for q in range(table.shape[0]):
        X = inverse_slopes(geometry, q, cell)
        H = X * natural(u, rows, table, q, cell, d)
        dH = X * natural(w, rows, table, q, cell, d)
        dP = flux_change(law, bulk_part, shear, H, dH)
        D = geometry[q, 9, cell] * (wp.transpose(X) * dP)
        for a in range(corners):
            collect(D, table, own, first + a * cells + cell, q, a, d)


@wp.kernel
def diagonal(law: int, bulk_part: wp.float64, shear: wp.float64, d: int, first: int,
             rows: wp.array2d(dtype=wp.int32), table: wp.array3d(dtype=wp.float64),
             geometry: wp.array3d(dtype=wp.float64), u: wp.array(dtype=wp.float64),
             own: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Derivatives of the forces of the cells on a node by the displacement of this node: (i, j) in column i d + j."""
    cell, a = wp.tid()
    place = first + a * rows.shape[1] + cell
    for k in range(d * d):
        own[place, k] = wp.float64(0.0)
    for q in range(table.shape[0]):
        X = inverse_slopes(geometry, q, cell)
        H = X * natural(u, rows, table, q, cell, d)
        for j in range(d):
            moved = wp.mat33d()
            for r in range(d):
                moved[r, j] = table[q, a, r]
            D = geometry[q, 9, cell] * (wp.transpose(X) * flux_change(law, bulk_part, shear, H, X * moved))
            for i in range(d):
                value = own[place, i * d + j]
                for r in range(d):
                    value = value + table[q, a, r] * D[r, i]
                own[place, i * d + j] = value


@wp.kernel
def gather(start: wp.array(dtype=wp.int32), places: wp.array(dtype=wp.int32), own: wp.array2d(dtype=wp.float64),
           out: wp.array2d(dtype=wp.float64)):  # fmt: skip
    """Sums (n, c) over the rows ``places[start[n]:start[n + 1]]`` of each node."""
    node, i = wp.tid()
    total = wp.float64(0.0)
    for k in range(start[node], start[node + 1]):
        total = total + own[places[k], i]
    out[node, i] = total
