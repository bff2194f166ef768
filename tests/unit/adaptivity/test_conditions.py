"""Closed contact rows of nodes with inertia through a transfer: normal velocities beside momentum, spin and energy."""

from collections.abc import Sequence

import numpy as np
import pytest
import scipy.sparse as sp
from turning import around, balances, moving, on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.projections.conditions import ClosedRows, conditions_of
from softway.adaptivity.transfer import transfer
from softway.arrays import Array
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

ROUNDING = 1e-12
SPEED = -0.3


def closed(on: AdaptedSolid, normal: Sequence[float], times: int = 1) -> ClosedRows:
    """Rows of the nodes at the bottom along a normal, each as often as told."""
    nodes = np.repeat(on.adapted.mesh.nodes("bottom"), times)
    k, d = len(nodes), len(normal)
    columns = (d * nodes[:, None] + np.arange(d)).ravel()
    entries = np.tile(normal, k), columns, d * np.arange(k + 1)
    return ClosedRows(gradient=sp.csr_array(entries, shape=(k, on.points.size)), velocity=np.full(k, SPEED))


@pytest.mark.parametrize("times", [1, 2], ids=["once", "twice"])
@pytest.mark.parametrize(
    ("mesh", "normal"),
    [
        (rectangle((1.0, 1.0), (5, 5), cell="tri3"), (0.6, 0.8)),
        (rectangle((1.0, 1.0), (5, 5), cell="quad4"), (0.6, 0.8)),
        (box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"), (0.48, 0.6, 0.64)),
    ],
    ids=["tri3", "quad4", "tet4"],
)
def test_ten_remeshings_of_a_body_with_closed_rows(mesh: Mesh, normal: tuple[float, ...], times: int) -> None:
    body = solid(mesh, sw.NeoHookean(E=1.0, nu=0.3))
    axes = np.eye(mesh.dim)
    before = on_levels(body, around(body, 0.5 * axes[0] + 0.5 * axes[1], 3))
    motion = transfer(before, before, moving(before), closed=closed(before, normal, times)).motion
    for k in range(1, 11):
        place = 0.5 + 0.3 * (np.cos(k) * axes[0] + np.sin(k) * axes[1])
        after = on_levels(body, around(body, place, 3))
        rows = closed(after, normal, times)
        found = transfer(before, after, motion, closed=rows)
        old, new = balances(before, motion), balances(after, found.motion)
        speed: Array = rows.gradient @ found.motion.velocity.ravel()
        assert speed == pytest.approx(SPEED, abs=ROUNDING)
        assert new.momentum == pytest.approx(old.momentum, abs=ROUNDING * old.momenta)
        assert new.spin == pytest.approx(old.spin, abs=ROUNDING * old.moments)
        assert new.energy == pytest.approx(old.energy, rel=ROUNDING)
        assert abs(found.scalar - 1.0) < 0.03
        before, motion = after, found.motion


def test_the_velocity_with_given_values_has_the_least_energy() -> None:
    on = on_levels(solid(rectangle((1.0, 1.0), (3, 3), cell="tri3")), np.zeros(18))
    motions = np.tile(np.eye(2), (len(on.points), 1))
    found = conditions_of(on, motions, closed(on, (0.0, 1.0)))
    values = np.append(np.full(4, SPEED), [0.2, 0.1])
    least = found.change(values)
    assert found.of(least) == pytest.approx(values, abs=1e-13)
    other = np.sin(7.0 * on.points)
    other = other - found.change(found.of(other))
    assert found.of(other) == pytest.approx(0.0, abs=1e-13)
    assert float((least * (on.mass @ other)).sum()) == pytest.approx(0.0, abs=1e-13)
