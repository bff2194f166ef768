"""Bodies that spin about a pin without loads: marches and conserved quantities."""

from dataclasses import dataclass, replace

import numpy as np

import softway as sw
from softway.arrays import Array
from softway.bodies.internal_force.slab_average import SlabForce
from softway.laws.law import Material
from softway.marching.results.step import Step


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spin:
    """March of a spinning body over m slabs.

    Parameters
    ----------
    time, energy, momentum
        (m + 1,) ends of the slabs, with energy and angular momentum about the pin.
    tip
        (m + 1, d) position of the tip.
    """

    time: Array
    energy: Array
    momentum: Array
    tip: Array

    @property
    def length(self) -> Array:
        """Distance (m + 1,) of the tip from the pin."""
        return np.asarray(np.linalg.norm(self.tip, axis=1))

    @property
    def period(self) -> float:
        """Period of one turn, from the final angle."""
        angle = np.unwrap(np.arctan2(self.tip[:, 1], self.tip[:, 0]))
        return float(2.0 * np.pi * self.time[-1] / (angle[-1] - angle[0]))

    def drift(self, name: str) -> float:
        """Greatest change of ``energy`` or ``momentum``, relative to the first value."""
        values = getattr(self, name)
        return float(np.abs(values / values[0] - 1.0).max())


def recorded(steps: list[Step], mesh: sw.Mesh) -> Spin:
    """Record the march of a body; its tip is the mean of the nodes ``tip``."""
    nodes, first = mesh.nodes("tip"), steps[0].before
    ledgers = [s.ledger for s in steps]
    states = [first, *(s.after for s in steps)]
    energy = [x.energy_kinetic + x.energy_strain for x in ledgers]
    momentum = [x.spin[2] for x in ledgers]
    return Spin(
        time=np.array([s.time for s in states]),
        energy=np.array([energy[0] - ledgers[0].energy_error, *energy]),
        momentum=np.array([momentum[0], *momentum]),
        tip=np.array([(mesh.points + s.displacement["body"])[nodes].mean(axis=0) for s in states]),
    )


def pendulum(length: float, stiffness: float, mass: float, speed: float, *, step: float, turns: float) -> Spin:
    """March a bar of two nodes, with axial ``stiffness`` [N] and ``mass`` per length, pinned at one end (D05)."""
    mesh = sw.Mesh(
        points=np.array([[0.0, 0.0], [length, 0.0]]),
        blocks={"bar2": np.array([[0, 1]])},
        tags={"pin": np.array([0]), "tip": np.array([1])},
    )
    bar = sw.Solid(
        mesh=mesh,
        material=sw.laws.StVenantKirchhoff(E=stiffness),
        density=mass,
        section=sw.bodies.Bar(area=1.0),
        supports=(sw.Fixed(on="pin"),),
        velocity=sw.bodies.OnTag(tag="tip", value=(0.0, speed)),
        force=sw.bodies.DiscreteGradient(),
    )
    until = turns * 2.0 * np.pi * length / speed
    return recorded(list(sw.march(sw.Scene(bodies={"body": bar}), until=until, step=step)), mesh)


def bar(law: Material, force: SlabForce, data: dict[str, float], *, turns: float, steps: int = 60) -> Spin:
    """March the bar of D06: 20 by 2 cells, pinned at the middle of its left end, stretched by its rotation."""
    length, width, omega = data["L"], data["section"], data["omega0"]
    plain = sw.meshes.Rectangle(size=(length, width), cells=(20, 2), origin=(0.0, -0.5 * width)).build()
    pin = np.flatnonzero(np.abs(plain.points).sum(axis=1) < 1e-9)
    mesh = replace(plain, tags={"pin": pin, "tip": plain.nodes("right")})
    solid = sw.Solid(
        mesh=mesh,
        material=law,
        density=data["rho"],
        section=sw.bodies.PlaneStress(),
        supports=(sw.Fixed(on="pin"),),
        force=force,
    )
    model = sw.build(sw.Scene(bodies={"body": solid}))
    x = mesh.points[:, 0]
    u = np.stack([data["rho"] * omega**2 / data["E"] * (0.5 * length**2 * x - x**3 / 6.0), 0.0 * x], axis=1)
    place = mesh.points + u
    v = omega * np.stack([-place[:, 1], place[:, 0]], axis=1)
    model = replace(model, displacement=u * model.free, velocity=v * model.free)
    turn = 2.0 * np.pi / omega
    return recorded(list(sw.march(model, until=turns * turn, step=turn / steps)), mesh)
