"""Warm billets whose meshes are replaced, and what holds in all changes of their meshes."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from forging import HEIGHT, press

import softway as sw
from softway.arrays import Array
from softway.bodies.setup.heat_loads import HeatLoad
from softway.laws.law import Material
from softway.meshes.remeshed.remesh import Remeshing

HOW = sw.meshes.Remesh(ratio=1.3, shortened=0.0)
PLASTIC = sw.J2(E=1e3, nu=0.3, yield_stress=1.0, hardening=sw.laws.LinearHardening(modulus=0.5))
STEEL = sw.heat.Conduction(conductivity=1e-2, capacity=1e-2)
WARM = sw.bodies.Thermal(law=STEEL, temperature=lambda x: 1000.0 + 100.0 * x[:, 1])


def billet(
    remesh: Remeshing,
    thermal: sw.bodies.Thermal = WARM,
    cell: str = "quad4",
    material: Material = PLASTIC,
    contact: sw.heat.ContactHeat | None = None,
    loads: tuple[HeatLoad, ...] = (),
) -> sw.Scene:
    """The press with a warm body."""
    plain = press((6, 5), remesh, material)
    mesh = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(6, 5), cell=cell).build()
    mesh = mesh.with_tag("flank", lambda x: (x[:, 0] > 0.999) & (x[:, 1] < 0.999 * HEIGHT))
    dilatation = "mean" if cell == "quad4" else "corner"
    body = replace(plain.bodies["body"], mesh=mesh, thermal=thermal, dilatation=dilatation)
    contacts = tuple(replace(one, heat=contact) for one in plain.contacts)
    return replace(plain, bodies={**plain.bodies, "body": body}, contacts=contacts, loads=loads)


def upset(scene: sw.Scene, reduction: float, slabs: int) -> list[sw.Step]:
    until = reduction * HEIGHT
    return list(sw.march(scene, until=until, step=until / slabs))


def temperatures(one: sw.Step) -> Array:
    return one.after.fields["temperature"]["body"][:, 0]


def accounted_changes(steps: list[sw.Step], least: float = -1e-14) -> Iterator[tuple[sw.Step, sw.Step]]:
    """Steps before and after each change of the mesh; content is in the accounts to rounding, and no change lowers the
    entropy.
    """
    for last, taken in pairwise(steps):
        old, new = last.ledger.heat, taken.ledger.heat
        assert old is not None
        assert new is not None
        assert abs(new.error) < 1e-12 * new.content
        if taken.exchanges:
            assert new.entropy - new.produced - old.entropy >= least
            yield last, taken


def keeps_its_heat(steps: list[sw.Step], least: float = -1e-14) -> None:
    """Content and energy are in the accounts to rounding; changes of the mesh keep the content, lower no entropy, and
    bring no new extremes.
    """
    for last, taken in accounted_changes(steps, least):
        before, after = temperatures(last), taken.before.fields["temperature"]["body"]
        assert before.min() * (1.0 - 1e-12) <= after.min()
        assert after.max() <= before.max() * (1.0 + 1e-12)
    assert abs(steps[-1].ledger.energy_error) < 1e-12 * steps[-1].ledger.work_external
