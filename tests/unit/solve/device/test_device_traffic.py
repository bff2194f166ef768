"""Bytes of the model of the time in docs/theory/solver/device.md, from the arrays on the device."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.internal_force.device_force import cell_groups


def test_bytes_of_a_product(device: str) -> None:
    from softway.kernels.device.device_cells import DeviceCells

    solid = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(16, 16, 16)),
        material=sw.LinearElastic(E=1.0, nu=0.3),
        density=1.0,
    )
    model = sw.build(sw.Scene(bodies={"cube": solid}))
    part = model.parts[0]
    cells = DeviceCells.of(cell_groups(part.internal, np.arange(model.shape[0])), model.shape, 1, device)
    (rows, table, geometry), count = cells.groups[0].arrays, 16**3
    assert rows.capacity / count == 32
    assert geometry.capacity / count == 640
    assert table.capacity == 8 * 8 * 3 * 8
    assert cells.own.capacity / count == 192
    assert cells.places.capacity / count == 32
    per_cell = (rows.capacity + geometry.capacity + 2 * cells.own.capacity + cells.places.capacity) / count
    fields = 3 * 24 + 4  # u and w read, the product written, and the start of the rows of a node
    assert per_cell + fields == pytest.approx(1164)
