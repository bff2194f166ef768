"""Press of case E02 with meshes that are replaced."""

import numpy as np

import softway as sw
from softway.adaptivity.rezoning.volume import volume_of
from softway.arrays import Array
from softway.laws.law import Material
from softway.meshes.remeshed.remesh import Remeshing

HEIGHT = 0.75
LAW = sw.laws.NortonHoff(K=1.0, m=0.3)
KEPT = sw.meshes.Remesh(quality=0.0, angle=0.0, ratio=1e9, shortened=0.0)
"""Limits that no cell reaches."""


def press(cells: tuple[int, int], remesh: Remeshing, material: Material = LAW) -> sw.Scene:
    """Press of case E02, with contacts on the flank."""
    mesh = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=cells).build()
    body = sw.Solid(
        mesh=mesh.with_tag("flank", lambda x: (x[:, 0] > 0.999) & (x[:, 1] < 0.999 * HEIGHT)),
        material=material,
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="mean",
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
        remesh=remesh,
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, HEIGHT), normal=(0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    rough = sw.laws.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    contacts = tuple(
        sw.Contact(between=(f"body.{tag}", "platen"), name=tag, friction=rough) for tag in ("top", "flank")
    )
    return sw.Scene(bodies={"body": body, "platen": platen}, contacts=contacts, inertia=sw.bodies.Off())


def forged(
    how: Remeshing, reduction: float, slabs: int, cells: tuple[int, int], material: Material = LAW
) -> list[sw.Step]:
    """Slabs of the press up to a reduction."""
    until = reduction * HEIGHT
    return list(sw.march(press(cells, how, material), until=until, step=until / slabs))


def places(one: sw.Step) -> Array:
    """Places (n, 2) of the nodes [m]."""
    return np.asarray(one.model.points + one.after.displacement["body"])


def volume(one: sw.Step) -> float:
    """Volume of the body [m^3]."""
    part = one.model.parts[0]
    return volume_of(part.mesh.blocks, part.internal.section, places(one))


def force(one: sw.Step) -> float:
    """Force of the platen [N]."""
    return sum(c.force_n for c in one.ledger.contacts.values())
