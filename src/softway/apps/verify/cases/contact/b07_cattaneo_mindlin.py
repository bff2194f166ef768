"""B07: Cattaneo-Mindlin line contact, pressed and then pulled tangentially until Q = mu P/2.

Round elastic body, R = E = 1, nu = 0.45, on a rigid floor, with 20 elements across half the contact. The normal and
tangential tractions of a nearly incompressible body on a rigid one are uncoupled. The floor is driven, without inertia.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.record.view.plots.curves import Curve, Panel

YOUNGS, NU, MU, RADIUS = 1.0, 0.45, 0.3, 1.0
STIFF = YOUNGS / (1.0 - NU**2)
WIDTH = 0.1
DEPTH = 0.8


def graded(step: float, even: float, end: float) -> Array:
    """Coordinates from zero in equal steps, then in steps that grow by a quarter."""
    found = [0.0]
    while found[-1] < end:
        step *= 1.0 if found[-1] < even else 1.25
        found.append(found[-1] + step)
    return np.append(found[:-2], end)


def round_body(across: int) -> sw.Mesh:
    """Mesh of the body above the floor, with the tags ``low`` and ``top``."""
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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pulled:
    """Pulled contact of k slabs.

    Parameters
    ----------
    ratio, zone, peak
        (k,) Q / (mu P), stick zone / half width, and greatest traction / (mu p0).
    place, traction
        (c,) node positions / half width, (k, c) traction / (mu p0).
    """

    ratio: Array
    zone: Array
    peak: Array
    place: Array
    traction: Array

    def at(self, ratio: float) -> tuple[float, float]:
        """Stick zone and peak traction at a ratio, interpolated linearly between slabs."""
        return float(np.interp(ratio, self.ratio, self.zone)), float(np.interp(ratio, self.ratio, self.peak))


@cache
def pulled() -> Pulled:
    """March the case."""
    mesh = round_body(20)
    path = sw.bodies.Table(times=(0.0, 1.0, 2.0), displacements=((0.0, 0.0), (0.0, 0.016), (0.006, 0.016)))
    body = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=YOUNGS, nu=NU), density=1.0, supports=(sw.Fixed(on="top"),))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), motion=path)
    contact = sw.Contact(between=("body.low", "floor"), name="floor", friction=sw.Coulomb(mu=MU))
    scene = sw.Scene(bodies={"body": body, "floor": floor}, contacts=(contact,), inertia=sw.bodies.Off())
    x = mesh.points[mesh.nodes("low"), 0]
    order = np.argsort(x)
    width = np.gradient(x[order])
    rows: list[tuple[float, float, float]] = []
    tractions: list[Array] = []
    half = WIDTH
    for step in sw.march(scene, until=2.0, step=0.05):
        if step.after.time <= 1.01:
            continue
        force, pull = step.after.pressure["floor"], step.after.traction["floor"]
        load = float(force.sum())
        half, greatest = np.sqrt(4.0 * load * RADIUS / (np.pi * STIFF)), np.sqrt(load * STIFF / (np.pi * RADIUS))
        sticks = x[step.after.closed["floor"] & ~step.after.sliding["floor"]]
        traction = pull[order, 0] / width / (MU * greatest)
        zone = 0.5 * (np.ptp(sticks) + WIDTH / 20) / half
        rows.append((float(pull[:, 0].sum() / (MU * load)), float(zone), float(np.abs(traction).max())))
        tractions.append(traction)
    ratio, zones, peak = np.array(rows).T
    return Pulled(ratio=ratio, zone=zones, peak=peak, place=x[order] / half, traction=np.array(tractions))


def compute() -> Outcome:
    """Compute the case, interpolated to Q / (mu P) = 1/2 between slabs."""
    march = pulled()
    zone, peak = march.at(0.5)
    nearest = int(np.argmin(np.abs(march.ratio - 0.5)))
    stuck = np.sqrt(1.0 - march.ratio[nearest])
    x = np.linspace(-1.0, 1.0, 401)
    exact = np.sqrt(1.0 - x**2) - stuck * np.sqrt(np.maximum(1.0 - (x / stuck) ** 2, 0.0))
    curves = (
        Curve(x=march.place, y=np.abs(march.traction[nearest]), kind="dots", label="nodes"),
        Curve(x=x, y=exact, kind="exact", label="Cattaneo, Mindlin"),
    )
    panel = Panel(title=f"Traction at Q = {march.ratio[nearest]:.3f} mu P", x="x / b", y="q / (mu p0)", curves=curves)
    return Outcome(values={"c/b": zone, "peak traction/(mu p0)": peak}, panels=(panel,))
