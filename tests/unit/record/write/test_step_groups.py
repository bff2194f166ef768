"""Slabs that were compiled together are recorded as if each had its step."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from records import differences
from softway.marching.march import march_in_groups
from softway.marching.slab.step_group import StepGroup, in_steps
from softway.marching.state.march_state import Settings
from softway.record.write.history_columns import columns
from softway.record.write.progress import Occasional

SLABS = 240


def bar(every: float = 1.7) -> sw.Scenario:
    """Bars that are held at one end, stretched by their weight, and strike a wall; three frames of 240 slabs."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=5),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=0.1),
        supports=(sw.Fixed(on="left"),),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.02, normal=-1.0))
    return scenario({"body": solid, "wall": wall}, "right", (), 0.02, every)


def disc(every: float = 0.3) -> sw.Scenario:
    """A disc that falls on a floor and turns."""
    solid = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=4),
        material=sw.LinearElastic(E=1e3, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.2, -1.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.02), normal=(0.0, 1.0)))
    gravity = sw.Gravity(acceleration=(0.0, -9.81))
    return scenario({"body": solid, "wall": floor}, "boundary", (gravity,), 0.004, every)


def scenario(bodies, tag: str, loads: tuple, step: float, every: float) -> sw.Scenario:
    """Scenario with probes of every quantity, at a tag and a place, by component and norm."""
    at = (0.6,) if tag == "right" else (0.6, 0.2)
    kinds = [(q, c) for q in ("displacement", "position", "velocity", "reaction") for c in ("x", "norm")]
    probes = [sw.Probe(name=f"{q}-{c}", of="body", tag=tag, quantity=q, component=c) for q, c in kinds]
    probes.append(sw.Probe(name="place", of="body", at=at, quantity="velocity"))
    return sw.Scenario(
        title="groups",
        bodies=bodies,
        contacts=(sw.Contact(between=(f"body.{tag}", "wall")),),
        loads=loads,
        time=sw.Time(end=SLABS * step, step=step),
        output=sw.Output(fields_every=every, probes=probes),
    )


def groups(given: sw.Scenario) -> list[object]:
    """March in groups."""
    checked, time = sw.check(given), given.time
    settings = Settings(
        until=time.end, step=checked.step, weight=time.weight, method=given.solver, control=time.control
    )
    return list(march_in_groups(checked.model, settings))


@pytest.mark.parametrize("case", [bar, disc], ids=lambda case: case.__name__)
def test_records_have_the_same_bits(case, tmp_path: Path) -> None:
    """Also with a frame for each slab, and in the middle of groups: lines are those of the steps."""
    seen: list[sw.Progress] = []
    sw.run(case(), tmp_path / "steps", progress=seen.append)
    done = sw.run(case(), tmp_path / "groups")
    assert len(seen) == done.history.rows - 1 == SLABS and done.events.rows > 1 and len(done.fields) > 3
    assert differences(tmp_path / "steps", tmp_path / "groups") == []
    told: list[sw.Progress] = []
    sw.run(case(), tmp_path / "occasional", progress=Occasional(told.append))
    assert differences(tmp_path / "steps", tmp_path / "occasional") == []
    assert len(told) < SLABS / 2 and told[-1].slabs == SLABS and told[-1].time == seen[-1].time  # the same bits


def test_a_run_that_stopped_goes_on_in_groups(tmp_path: Path) -> None:
    sw.run(bar(), tmp_path / "whole")
    seen: list[sw.Progress] = []

    def stop(progress: sw.Progress) -> None:
        seen.append(progress)
        if len(seen) == 37:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(bar(), tmp_path / "stopped", progress=stop)
    sw.resume(tmp_path / "stopped", scenario=bar())
    assert (tmp_path / "stopped/history.csv").read_bytes() == (tmp_path / "whole/history.csv").read_bytes()


@pytest.mark.parametrize("case", [bar, disc], ids=lambda case: case.__name__)
def test_numbers_of_a_group_are_those_of_its_steps(case) -> None:
    """Every column of the history, of whole groups and of parts."""
    found = groups(case())
    some = [one for one in found if isinstance(one, StepGroup)]
    assert sum(len(one) for one in some) > SLABS / 2 and len(list(in_steps(iter(found)))) == SLABS
    for group in (*some, max(some, key=len).part(3, 9)):
        steps = list(group.steps())
        assert len(steps) == len(group) and steps[-1].slab == group.step(len(group) - 1).slab
        for column in columns(group.model.contacts.labels):
            each = [column.value(step) for step in steps]
            np.testing.assert_array_equal(np.broadcast_to(column.value(group.numbers()), len(group)), each, column.name)
        assert group.march_state.state.time == steps[-1].march_state.state.time  # the same bits
