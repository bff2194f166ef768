"""A model that takes over solids of another one has the bits of one that is built in full."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies.inertia.inertia_scaling import Scaled
from softway.heat.coupled.build import build
from softway.meshes.generators.shapes import disc, rectangle
from softway.model.model import Model


def scene(cells: int, timing: sw.contact.Energy | sw.contact.Impulse = sw.contact.Energy()) -> sw.Scene:
    ball = sw.Solid(mesh=disc(0.5, 4, cell="tri3"), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
                    velocity=sw.bodies.Uniform(value=(0.0, -0.1)))  # fmt: skip
    block = sw.Solid(mesh=rectangle((1.0, 0.5), (cells, 3), cell="quad4", origin=(-0.5, -1.005)),
                     material=sw.LinearElastic(E=2.0, nu=0.3), density=2.0)  # fmt: skip
    contact = sw.Contact(between=("ball.boundary", "block.top"), timing=timing)
    return sw.Scene(bodies={"block": block, "ball": ball}, contacts=(contact,))


def changed(old: sw.Scene, cells: int) -> sw.Scene:
    """The scene with another block, and the very same ball."""
    return replace(old, bodies={**old.bodies, "block": scene(cells).bodies["block"]})


def same(one: Model, other: Model) -> None:
    """All arrays of the models are the same."""
    for name in ("displacement", "velocity", "weight", "massive", "touchable", "edge", "floor", "part_of", "linked"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    for name in ("mass", "follow", "passing"):
        a, b = getattr(one, name), getattr(other, name)
        assert all(np.array_equal(getattr(a, part), getattr(b, part)) for part in ("data", "indices", "indptr")), name
    u = 0.01 * np.sin(3.0 * one.points)
    assert np.array_equal(one.inertia_and_stiffness(u, 0.3).data, other.inertia_and_stiffness(u, 0.3).data)
    assert np.array_equal(one.force(u), other.force(u))
    rows = one.rows(u), other.rows(u)
    assert np.array_equal(rows[0].gradient.data, rows[1].gradient.data)
    assert np.array_equal(rows[0].gap(u), rows[1].gap(u))


@pytest.mark.parametrize("timing", [sw.contact.Energy(), sw.contact.Impulse()], ids=["Energy", "Impulse"])
def test_the_bits_are_those_of_a_full_build(timing: sw.contact.Energy) -> None:
    old = scene(6, timing)
    known, new = build(old), changed(old, 9)
    found, full = build(new, known), build(new)
    assert found.parts[1].internal is known.parts[1].internal
    assert found.parts[1].nodes != known.parts[1].nodes
    assert found.parts[0].internal is not known.parts[0].internal
    same(found, full)


def test_other_massless_nodes_have_other_masses() -> None:
    old = scene(6)
    known = build(old)
    apart = replace(old, contacts=())
    same(build(apart, known), build(apart))
    scaled = replace(old, inertia=Scaled(factor=2.0))
    same(build(scaled, known), build(scaled))
