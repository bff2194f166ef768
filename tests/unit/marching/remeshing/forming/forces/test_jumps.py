"""Press of case E02 to 77 per cent: what each change of the mesh does to the force, beside what the process does."""

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
LEGS = (0.36, 0.03), (0.77 * HEIGHT, 0.00375)
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


def marched() -> Iterator[tuple[sw.Step, float | None]]:
    """Slabs, and the jump of their force relative to that of the same slab on the old mesh, which goes on; None without
    a change.
    """
    last: sw.Step | None = None
    for until, step in LEGS:
        state = None if last is None else last.march_state
        for one in sw.march(scene(), until=until, step=step, state=state):
            jump = None
            if one.exchanges:
                assert last is not None
                before = last.march_state
                old = next(slabs(prepare(last.model, before.settings, before).stepper, before))
                jump = force(one) / force(old) - 1.0 if old.after.time == one.after.time else np.nan
            yield one, jump
            last = one


@pytest.mark.minutes
def test_to_77_per_cent_with_small_jumps_of_the_force() -> None:
    """Volume within 1e-4; jumps below 1e-3 up to 74 per cent, and below 2e-3 to the end, where the corner has sides of
    a tenth of the height; on the way the force is that of case E02.
    """
    steps, jumps = zip(*marched(), strict=True)
    count = changes(list(steps))
    assert len(count) >= 5
    assert steps[-1].after.time == pytest.approx(0.77 * HEIGHT)
    assert volume(steps[-1]) == pytest.approx(np.pi * HEIGHT, rel=1e-4)
    assert sum(abs(steps[k].exchanges["body"].volume) for k in count) < 1e-12
    found = [(one.after.time / HEIGHT, abs(jump)) for one, jump in zip(steps, jumps, strict=True) if jump is not None]
    assert max(jump for reduction, jump in found if reduction < 0.745 and np.isfinite(jump)) < 1e-3
    assert max(jump for _, jump in found if np.isfinite(jump)) < 2e-3
    table = np.array(sheet("E02")["reference"]["fine_12x10x24"])
    early = [one for one in steps[1:] if one.after.time < 0.3 * HEIGHT]
    middle = np.array([0.5 * (one.before.time + one.after.time) for one in early]) / HEIGHT
    np.testing.assert_allclose([force(one) for one in early], np.interp(middle, table[:, 0], table[:, 1]), rtol=5e-3)
