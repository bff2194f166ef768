"""Contacts with heat as the tests of another code define them; as a program, the numbers of ours in the docs."""

from collections.abc import Callable

import numpy as np
import scipy.linalg as la
from scipy.optimize import brentq

import softway as sw
from softway.arrays import Array
from softway.bodies import Axisymmetric, Driven, Fixed, Off, Thermal
from softway.contact import NodeToSurface
from softway.heat import Conduction, ContactHeat, Temperature
from softway.laws.heat.contact_heat import STEFAN_BOLTZMANN
from softway.meshes.generators.shapes import box, rectangle

GAS, EMISSIVITY, GOOD = 0.09187557, 1.0 / 3.0, 1e7
"""Gas [W/(m K)], effective emissivity and conductivity of the blocks [W/(m K)] of the radiating gap."""
STEEL, ALUMINIUM = 16.2, 210.0
"""Conductivities of the pressed blocks [W/(m K)]; their conductance at the hardness is the harmonic mean."""
HARMONIC = 2.0 * STEEL * ALUMINIUM / (STEEL + ALUMINIUM)
HOT, COLD, START, HEIGHT = 800.0, 250.0, 525.0, 0.5
"""Temperatures of the outer faces and at the start [K], and the height of the blocks [m]."""
STRETCH = (1.0 - 0.29**2) / 1.93e11 + (1.0 - 0.36**2) / 6.8e10
"""Approach of the outer faces over the pressure: two blocks of one metre in plane strain, free above [m/Pa]."""
HEATS = (8e3 * 0.5, 2.7e3 * 0.9)
"""Heat capacities of both blocks [J/(m^3 K)], as given there."""
Two = tuple[float, float]


def last_flow(steps: list[sw.Step]) -> float:
    """Heat flow across the contact in the last slab [W]."""
    before, end = steps[-2:]
    return (end.ledger.heat.through[0] - before.ledger.heat.through[0]) / (end.after.time - before.after.time)


def radiating(dim: int, **given: object) -> float:
    """Heat flow [W] across a gap of one metre between unit blocks of one cell, at 200 and 100 K."""
    ends = tuple(Fixed(on=tag) for tag in ("left", "right"))

    def block(x: float) -> sw.Solid:
        if dim == 1:
            mesh = sw.meshes.Interval(length=1.0, cells=1, origin=x).build()
        else:
            mesh = (rectangle if dim == 2 else box)((1.0,) * dim, (1,) * dim, origin=(x, *(0.0,) * (dim - 1)))
        thermal = Thermal(law=Conduction(conductivity=GOOD, capacity=1.0), temperature=100.0)
        return sw.Solid(
            mesh=mesh, material=sw.LinearElastic(E=1.0, nu=0.0), density=1.0, supports=ends, thermal=thermal
        )

    heat = ContactHeat(gas=GAS, roughness=1e-12, emissivity=EMISSIVITY)
    contact = sw.Contact(between=("left.right", "right.left"), heat=heat, **given)
    loads = Temperature(on="left.left", value=200.0), Temperature(on="right.right", value=100.0)
    bodies = {"left": block(0.0), "right": block(2.0)}
    scene = sw.Scene(bodies=bodies, contacts=(contact,), loads=loads, inertia=Off())
    return last_flow(list(sw.march(scene, until=3.0, step=1.0)))


def radiated(sigma: float = STEFAN_BOLTZMANN) -> float:
    """The same flow [W], exactly: the faces of the gap differ from the ends by the flow over the conductivity."""

    def excess(flow: float) -> float:
        one, other = 200.0 - flow / GOOD, 100.0 + flow / GOOD
        return GAS * (one - other) + EMISSIVITY * sigma * (one**4 - other**4) - flow

    return float(brentq(excess, 0.0, 100.0, xtol=1e-13, rtol=1e-14))


def pressed(
    pressure: float, hardness: float, capacities: Two, cells: tuple[int, int, int], drive: float, **given: object
) -> sw.Scene:
    """Two blocks of one metre, steel and aluminium, pressed by their outer faces.

    Parameters
    ----------
    pressure, hardness
        Pressure at the end of the drive, and the hardness [Pa].
    capacities
        Heat capacities of both blocks [J/(m^3 K)].
    cells
        Cells along each block, and across the first and the second.
    drive
        Time in which the outer faces approach [s].
    """
    laws = (1.93e11, 0.29, STEEL), (6.8e10, 0.36, ALUMINIUM)
    push = Driven(on="left", components="x", velocity=(2.0 * pressure * STRETCH / drive, 0.0), times=(0.0, drive))
    bodies = {}
    for k, (name, (E, nu, conductivity), end) in enumerate(
        zip(("steel", "aluminium"), laws, (push, Fixed(on="right", components="x")), strict=True)
    ):
        law = Conduction(conductivity=conductivity, capacity=capacities[k])
        bodies[name] = sw.Solid(
            mesh=rectangle((1.0, HEIGHT), (cells[0], cells[1 + k]), origin=(float(k), 0.0)),
            material=sw.LinearElastic(E=E, nu=nu), density=1.0, thermal=Thermal(law=law, temperature=START),
            supports=(Fixed(on="bottom", components="y"), end),
        )  # fmt: skip
    heat = ContactHeat(conductance=HARMONIC, hardness=hardness, exponent=1.0)
    contact = sw.Contact(between=("steel.right", "aluminium.left"), heat=heat, **given)
    loads = Temperature(on="steel.left", value=HOT), Temperature(on="aluminium.right", value=COLD)
    return sw.Scene(bodies=bodies, contacts=(contact,), loads=loads, inertia=Off())


def faces(scene: sw.Scene, step: sw.Step) -> tuple[Array, Array]:
    """Temperatures of the nodes of both faces of the contact [K]."""
    found = step.after.fields["temperature"]
    return tuple(found[name][np.isclose(body.mesh.points[:, 0], 1.0), 0] for name, body in scene.bodies.items())


def steady(pressure: float, hardness: float) -> tuple[float, float, float]:
    """Exact flux [W/m^2] and temperatures of both faces [K] at the end: three resistances in series."""
    flux = (HOT - COLD) / (1.0 / STEEL + hardness / (HARMONIC * pressure) + 1.0 / ALUMINIUM)
    return flux, HOT - flux / STEEL, COLD + flux / ALUMINIUM


def on_the_way(time: float, pressure: float, hardness: float, cells: int) -> Two:
    """Temperatures of both faces [K] at a time [s]: exact in time, in linear cells along the blocks."""
    n, edge = cells + 1, 1.0 / cells
    K, C = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    for body, (k, heat) in enumerate(zip((STEEL, ALUMINIUM), HEATS, strict=True)):
        for i in range(body * n, body * n + cells):
            K[i : i + 2, i : i + 2] += k / edge * pair
            C[i : i + 2] += 0.5 * heat * edge
    K[cells : n + 1, cells : n + 1] += HARMONIC * pressure / hardness * pair
    free, ends = np.arange(1, 2 * n - 1), [0, 2 * n - 1]
    end = np.linalg.solve(K[np.ix_(free, free)], -K[np.ix_(free, ends)] @ np.array([HOT, COLD]))
    root = np.sqrt(C[free])
    rate, shape = la.eigh(K[np.ix_(free, free)] / np.outer(root, root))
    now = end + shape @ (np.exp(-rate * time) * (shape.T @ ((START - end) * root))) / root
    return float(now[cells - 1]), float(now[cells])


def cylinders(gap: float, first: str = "shaft", **given: object) -> float:
    """Heat flow [W] from a shaft of radius and height one, 100 K hotter, across a gap of unit conductivity.

    The cells are longer than the gap; ``first`` is the body that the contact names first.
    """
    thermal = Thermal(law=Conduction(conductivity=1e6, capacity=1.0), temperature=100.0)
    ends = tuple(Fixed(on=tag) for tag in ("left", "right"))
    bodies = {
        name: sw.Solid(
            mesh=rectangle((1.0, 1.0), (1, 1), origin=(x, 0.0)), section=Axisymmetric(), density=1.0,
            material=sw.LinearElastic(E=1.0, nu=0.0), supports=ends, thermal=thermal,
        )
        for name, x in (("shaft", 0.0), ("ring", 1.0 + gap))
    }  # fmt: skip
    between = ("shaft.right", "ring.left") if first == "shaft" else ("ring.left", "shaft.right")
    contact = sw.Contact(between=between, heat=ContactHeat(gas=1.0, roughness=1e-12), **given)
    loads = Temperature(on="shaft.left", value=200.0), Temperature(on="ring.right", value=100.0)
    scene = sw.Scene(bodies=bodies, contacts=(contact,), loads=loads, inertia=Off())
    return abs(last_flow(list(sw.march(scene, until=4.0, step=1.0))))


def main(tell: Callable[..., None] = print) -> None:
    """Print the numbers of ours."""
    tell("radiating gap:", radiating(3), "exact", radiated())
    for pressure, hardness in ((100.0, 26.875), (1.8e-11 / STRETCH, 1.0)):
        scene = pressed(pressure, hardness, (STEEL, ALUMINIUM), (1, 2, 3), 1.0)
        steps = list(sw.march(scene, until=9.1, step=0.35))
        found = [float(t.mean()) for t in faces(scene, steps[-1])]
        tell(f"{pressure:.4f} Pa:", last_flow(steps) / HEIGHT, *found, "exact", *steady(pressure, hardness))
    for step in (60.0, 20.0, 10.0, 5.0):
        scene = pressed(1.8e-11 / STRETCH, 1.0, HEATS, (40, 10, 10), 1.0)
        *_, last = sw.march(scene, until=240.0, step=step)
        tell(f"240 s, slabs of {step:g} s:", *(float(t.mean()) for t in faces(scene, last)))
    tell("exact", *on_the_way(240.0, 1.8e-11 / STRETCH, 1.0, 320))
    for first, given in (("shaft", {}), ("ring", {}), ("shaft", {"method": NodeToSurface(nodes="both")})):
        tell("cylinders,", first, "first:", cylinders(1.0, first, **given))


if __name__ == "__main__":
    main()
