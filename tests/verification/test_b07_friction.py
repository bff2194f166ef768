"""B07: Cattaneo's and Mindlin's line contact, pressed and then pulled along until Q = mu P/2.

A round elastic body, R = E = 1, with nu = 0.45 on a rigid floor, 20 elements across half the contact: normal and
tangential tractions of an almost incompressible body on a rigid one do not disturb each other.  The floor is driven,
without inertia.
"""

import numpy as np
import pytest

import softway as sw
from softway.typing import Array

YOUNGS, NU, MU, RADIUS = 1.0, 0.45, 0.3, 1.0
STIFF = YOUNGS / (1.0 - NU**2)
WIDTH = 0.1
DEPTH = 0.8


def graded(step: float, even: float, end: float) -> Array:
    """From zero in even steps, then in steps that grow by a quarter."""
    found = [0.0]
    while found[-1] < end:
        step *= 1.0 if found[-1] < even else 1.25
        found.append(found[-1] + step)
    return np.append(found[:-2], end)


def round_body(across: int) -> sw.Mesh:
    """The body above the floor, with the tags ``low`` and ``top``."""
    half = graded(WIDTH / across, 1.6 * WIDTH, 0.8)
    x, y = np.concatenate([-half[:0:-1], half]), graded(WIDTH / across, 0.0, DEPTH)
    X, Y = np.meshgrid(x, y, indexing="ij")
    arc = RADIUS - np.sqrt(RADIUS**2 - X**2)
    points = np.stack([X.ravel(), (arc + Y * (1.2 - arc) / 1.2).ravel()], axis=1)
    number = np.arange(X.size).reshape(X.shape)
    corners = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    mesh = sw.Mesh(points=points, blocks={"quad4": np.stack(corners, axis=-1).reshape(-1, 4)})
    low = np.isin(np.arange(X.size), number[:, 0]) & (np.abs(points[:, 0]) < 1.5 * WIDTH)
    high = np.isin(np.arange(X.size), number[:, -1])
    return mesh.with_tag("low", lambda p: low).with_tag("top", lambda p: high)


def test_the_zone_that_sticks():
    """The case allows 0.05 for the zone and for the greatest traction."""
    mesh = round_body(20)
    path = sw.Table(times=(0.0, 1.0, 2.0), displacements=((0.0, 0.0), (0.0, 0.016), (0.006, 0.016)))
    scene = sw.Scene(
        bodies={
            "body": sw.Solid(
                mesh=mesh,
                material=sw.LinearElastic(E=YOUNGS, nu=NU),
                density=1.0,
                supports=(sw.Fixed(on="top"),),
            ),
            "floor": sw.Tool(shape=sw.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), motion=path),
        },
        contacts=(sw.Contact(between=("body.low", "floor"), name="floor", friction=sw.Coulomb(mu=MU)),),
        inertia=sw.Off(),
    )
    x = mesh.points[mesh.nodes("low"), 0]
    order = np.argsort(x)
    width = np.gradient(x[order])
    reached = []
    for step in sw.march(scene, until=2.0, step=0.05):
        force, pull = (getattr(step.after, n)["floor"] for n in ("pressure", "traction"))
        closed, sliding = (getattr(step.after, n)["floor"] for n in ("closed", "sliding"))
        if step.after.time > 1.01:
            ratio = float(pull[:, 0].sum() / (MU * force.sum()))
            half = np.sqrt(4.0 * force.sum() * RADIUS / (np.pi * STIFF))
            sticks = 0.5 * (np.ptp(x[closed & ~sliding]) + WIDTH / 20)
            greatest = float(np.sqrt(force.sum() * STIFF / (np.pi * RADIUS)))
            peak = np.abs(pull[order, 0] / width).max() / (MU * greatest)
            reached.append((ratio, sticks / half, peak))
    ratio, zone, peak = min(reached, key=lambda r: abs(r[0] - 0.5))
    assert ratio == pytest.approx(0.5, abs=0.02)
    assert zone == pytest.approx(np.sqrt(1.0 - ratio), abs=0.05)
    assert peak == pytest.approx(np.sqrt(ratio), rel=0.05)
    zones = np.array([r[1] for r in reached])
    assert (np.diff(zones) < 1e-12).all()
