"""Bimetal billets pressed by a platen, whose meshes are replaced."""

from collections.abc import Callable, Mapping

import numpy as np

import softway as sw
from softway.adaptivity.rezoning.volume import volume_of
from softway.adaptivity.rezoning.zones import zones_of
from softway.arrays import Array, BoolArray
from softway.bodies.internal_force.regions import RegionForces
from softway.laws.law import Material
from softway.meshes.remeshed.remesh import Remeshing

HEIGHT = 0.8
HOW = sw.meshes.Remesh(ratio=1.5, shortened=0.0)
HARDENING = sw.laws.LinearHardening(modulus=0.5)
SOFT = sw.J2(E=1e3, nu=0.3, yield_stress=1.0, hardening=HARDENING)
HARD = sw.J2(E=2e3, nu=0.3, yield_stress=2.0, hardening=HARDENING)
LAWS: Mapping[str, Material] = {"core": SOFT, "skin": HARD}
DENSITIES = {"core": 1.0, "skin": 2.0}

Where = Callable[[Array], BoolArray]


def core(x: Array) -> BoolArray:
    """A cylinder of half of the radius."""
    return np.asarray(x[:, 0] < 0.5)


def layer(x: Array) -> BoolArray:
    """The lower half."""
    return np.asarray(x[:, 1] < 0.5 * HEIGHT)


def inclusion(x: Array) -> BoolArray:
    """A ring inside."""
    return np.asarray((np.abs(x[:, 0] - 0.5) < 0.26) & (np.abs(x[:, 1] - 0.4) < 0.22))


def divided(mesh: sw.Mesh, where: Where) -> sw.Mesh:
    """Mesh with the regions of a core and its skin."""
    return mesh.with_region("core", where).with_region("skin", lambda x: ~where(x))


def billet(
    remesh: Remeshing,
    mesh: sw.Mesh | None = None,
    where: Where = core,
    thermal: sw.bodies.Thermal | None = None,
    laws: Mapping[str, Material] = LAWS,
) -> sw.Scene:
    """Upper half of a billet of revolution under a platen with friction."""
    plain = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(8, 8)).build() if mesh is None else mesh
    body = sw.Solid(
        mesh=divided(plain, where),
        material=laws,
        density=DENSITIES,
        section=sw.bodies.Axisymmetric(),
        dilatation="mean" if "quad4" in plain.blocks else "corner",
        remesh=remesh,
        thermal=thermal,
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, HEIGHT), normal=(0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    contact = sw.Contact(between=("body.surface", "platen"), friction=sw.laws.Coulomb(mu=0.2))
    return sw.Scene(bodies={"body": body, "platen": platen}, contacts=(contact,), inertia=sw.bodies.Off())


def pressed(scene: sw.Scene, reduction: float, slabs: int) -> list[sw.Step]:
    """Slabs of a billet up to a reduction of its height."""
    until = reduction * HEIGHT
    return list(sw.march(scene, until=until, step=until / slabs))


def masses(one: sw.Step) -> Array:
    """Mass (2,) of each material [kg]."""
    part = one.model.parts[0]
    internal, materials = part.internal, part.materials
    assert isinstance(internal, RegionForces)
    return np.array([materials.densities[t.number] * internal.volumes[t.region] for t in internal.terms])


def volumes(one: sw.Step, state: sw.State | None = None) -> Array:
    """Present volume (2,) of each material after a slab, or in another state on its mesh [m^3]."""
    part, at = one.model.parts[0], one.after if state is None else state
    zones = zones_of(part.mesh, part.materials.owner)
    places = part.mesh.points + at.displacement["body"]
    return np.array([volume_of(blocks, part.internal.section, places) for blocks in zones.blocks])


def accounted(steps: list[sw.Step]) -> None:
    """Masses stay, changes of the mesh keep the volume of each material and the energy, and the ledger is closed."""
    for last, one in zip(steps[:-1], steps[1:], strict=True):
        np.testing.assert_allclose(masses(one), masses(steps[0]), rtol=1e-12)
        if one.exchanges:
            np.testing.assert_allclose(volumes(one, one.before), volumes(last), rtol=1e-13)
            assert abs(one.exchanges["body"].volume) < 1e-13
            assert abs(one.exchanges["body"].energy) < 1e-13 * one.ledger.work_external
        assert abs(one.ledger.energy_error) < 1e-11 * one.ledger.work_external
