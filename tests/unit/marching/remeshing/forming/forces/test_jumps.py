"""Press of case E02 to 80 per cent: what each change of the mesh does to the force, beside what the process does."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from forging import HEIGHT, changes, force, press, volume

import softway as sw
from softway.apps.verify.case import sheet
from softway.arrays import Array
from softway.marching.slabs import slabs
from softway.marching.start.preparation import prepare
from softway.meshes.remeshed.remesh import Remesh

CELLS, GRADING = (16, 12), (3.0, 2.5)
LEGS = (0.36, 0.03), (0.8 * HEIGHT, 0.00375)
"""Ends and slab lengths: short slabs while the flank folds onto the platen."""


def graded(length: float, along: Array, by: float) -> Array:
    """Places on a side whose sides get smaller towards its end."""
    return np.asarray(length * np.expm1(-by * along / length) / np.expm1(-by))


def scene() -> sw.Scene:
    """The press with small cells at the corner, and one contact of the whole surface, whose area of friction does not
    change when a side of the flank becomes one of the end face.
    """
    found = press(CELLS, Remesh(ratio=1.25))
    body = found.bodies["body"]
    assert isinstance(body, sw.Solid)
    sides = zip((1.0, HEIGHT), body.mesh.points.T, GRADING, strict=True)
    points = np.stack([graded(*side) for side in sides], axis=1)
    contact = replace(found.contacts[0], between=("body", "platen"), name="platen")
    body = replace(body, mesh=replace(body.mesh, points=points))
    return replace(found, bodies={**found.bodies, "body": body}, contacts=(contact,))


def going_on(last: sw.Step, until: float) -> tuple[float, int]:
    """Mean force on the old mesh, which goes on from a slab until a time, and the nodes in contact at the end."""
    before, impulse = last.march_state, 0.0
    for one in slabs(prepare(last.model, before.settings, before).stepper, before):
        impulse += force(one) * (one.after.time - one.before.time)
        if one.after.time > until - 1e-12:
            return impulse / (one.after.time - last.after.time), touching(one)
    raise AssertionError("the old mesh ends before the new one")


def touching(step: sw.Step) -> int:
    """Number of nodes in contact."""
    return sum(contact.count for contact in step.ledger.contacts.values())


def marched() -> Iterator[tuple[sw.Step, tuple[float, int] | None]]:
    """Slabs, and for those on new meshes their force relative to that on the old mesh, less one, with the number of
    nodes that are in contact on the new one only.
    """
    last: sw.Step | None = None
    for until, step in LEGS:
        state = None if last is None else last.march_state
        for one in sw.march(scene(), until=until, step=step, state=state):
            found = None
            if one.exchanges:
                assert last is not None
                old, count = going_on(last, one.after.time)
                found = force(one) / old - 1.0, touching(one) - count
            yield one, found
            last = one


@pytest.mark.minutes
def test_to_80_per_cent_with_small_jumps_of_the_force() -> None:
    """Volume within 1e-4; jumps of 1.2e-3 at most but for the two changes at whose slab a node of the flank touches
    one slab earlier on the new mesh.

    The force of that node is less than what the process does there without a change, 2e-2.  On the way the force is
    that of case E02.
    """
    steps, jumps = zip(*marched(), strict=True)
    count = changes(list(steps))
    assert len(count) >= 20
    assert steps[-1].after.time == pytest.approx(0.8 * HEIGHT)
    assert volume(steps[-1]) == pytest.approx(np.pi * HEIGHT, rel=1e-4)
    assert sum(abs(steps[k].exchanges["body"].volume) for k in count) < 1e-12
    found = [one for one in jumps if one is not None]
    earlier = [abs(jump) for jump, more in found if more > 0]
    assert max(abs(jump) for jump, more in found if more <= 0) < 1.2e-3
    assert len(earlier) <= 3
    assert max(earlier, default=0.0) < 6e-3
    table = np.array(sheet("E02")["reference"]["fine_12x10x24"])
    early = [one for one in steps[1:] if one.after.time < 0.3 * HEIGHT]
    middle = np.array([0.5 * (one.before.time + one.after.time) for one in early]) / HEIGHT
    np.testing.assert_allclose([force(one) for one in early], np.interp(middle, table[:, 0], table[:, 1]), rtol=5e-3)
