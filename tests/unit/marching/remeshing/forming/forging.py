"""Press of case E02 with meshes that are replaced."""

from typing import Any

import numpy as np

import softway as sw
from softway.adaptivity.rezoning.volume import volume_of
from softway.arrays import Array
from softway.laws.law import Material
from softway.meshes.remeshed.remesh import Remeshing
from softway.record.storage.serialisation import packed, unpacked

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


def changes(steps: list[sw.Step]) -> list[int]:
    """Numbers of the slabs with a new mesh."""
    return [k for k, step in enumerate(steps) if step.exchanges]


def continues(scene: sw.Scene, whole: list[sw.Step], slabs: int, **given: Any) -> list[sw.Step]:
    """Slabs of a march from the stored state after some of its slabs; their states have the same bits."""
    rest = list(sw.march(scene, state=unpacked(*packed(whole[slabs - 1].march_state)), **given))
    assert len(rest) == len(whole) - slabs
    for one, other in zip(rest, whole[slabs:], strict=True):
        (text, arrays), (same, others) = packed(one.march_state), packed(other.march_state)
        assert text == same and all(np.array_equal(arrays[name], others[name]) for name in others)
        assert set(one.exchanges) == set(other.exchanges)
    return rest


def has_no_jumps(whole: list[sw.Step], most: float) -> None:
    """The matter of the nodes of the first mesh is in the same places, but for ``most`` [m], before and after a change
    of the mesh.
    """
    assert changes(whole)
    for k in changes(whole):
        old, new = whole[k - 1], whole[k]
        meshes = old.model.remeshed["body"], new.model.remeshed["body"]
        before = meshes[0].matter @ places(old)
        after = meshes[1].matter @ (new.model.points + new.before.displacement["body"])
        np.testing.assert_allclose(after, before, atol=most)
