"""An elastic bar with heat bounces between two walls for ten thousand slabs: what rounding and bounces add up to."""

import numpy as np
import pytest

import softway as sw

THETA, SPEED, SLABS, STEP = 300.0, 0.2, 10_000, 0.005


def scene(delta: float) -> sw.Scene:
    """Bar of length 1 with the coupling ``delta = E alpha^2 theta / c`` between walls 1.1 apart."""
    law = sw.heat.Conduction(conductivity=0.01 / THETA, capacity=1.0 / THETA)
    heat = sw.bodies.Thermal(law=law, temperature=THETA, expansion=float(np.sqrt(delta)) / THETA)
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=3), material=sw.laws.Hencky(E=1.0, nu=0.0), density=1.0,
        velocity=sw.bodies.Uniform(value=SPEED), thermal=heat,
    )  # fmt: skip
    left, right = (
        sw.Tool(shape=sw.obstacles.HalfSpace(point=point, normal=normal))
        for point, normal in ((-0.05, 1.0), (1.05, -1.0))
    )
    contacts = tuple(sw.Contact(between=(f"bar.{side}", side)) for side in ("left", "right"))
    return sw.Scene(bodies={"bar": bar, "left": left, "right": right}, contacts=contacts)


@pytest.mark.minutes
def test_ten_thousand_slabs_keep_both_laws() -> None:
    """What the slabs round adds up to 1e-11 of the kinetic energy at most.

    The kinetic energy is never above the available energy, that at the start less theta times what was produced.
    """
    rows, releases = [], 0
    for step in sw.march(scene(0.05), until=SLABS * STEP, step=STEP, method=sw.FixedPoint(tolerance=1e-12)):
        found = step.ledger
        rows.append((found.energy_kinetic, found.energy_strain, found.heat.content, found.heat.produced))
        releases += sum(e.kind == "release" for e in step.events)
    assert len(rows) == SLABS and releases >= 10
    kinetic, strain, content, produced = np.array(rows).T
    start = 0.5 * SPEED**2
    assert np.ptp(kinetic + strain + content) < 1e-11 * start
    assert produced.min() > -1e-12 * content[0] / THETA
    available = start - THETA * np.cumsum(produced)
    assert (kinetic - available).max() < 1e-11 * start
    assert 0.2 * start < available[-1] < 0.95 * start
