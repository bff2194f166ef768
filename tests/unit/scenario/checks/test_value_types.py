"""What Python puts into a scenario is looked at before it is used: place, value, and what belongs there."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.scenario.checks.check import check

LAW = sw.LinearElastic(E=1.0)
MESH = sw.meshes.Interval(length=1.0, cells=4)
BAR = sw.Solid(mesh=MESH, material=LAW, density=1.0, velocity=sw.bodies.Uniform(value=1.0))
WALL = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.3, normal=-1.0))
TIP = sw.Contact(between=("bar.right", "wall"))
PROBE = sw.Probe(name="p", of="bar", tag="left")
WHOLE = sw.Scenario(bodies={"bar": BAR, "wall": WALL}, contacts=(TIP,), time=sw.Time(end=0.5, step=0.05))


def of(**changes: object) -> sw.Scenario:
    """The scenario with another bar."""
    return replace(WHOLE, bodies={"bar": replace(BAR, **changes), "wall": WALL})


# What is done; then what the message must contain.
MISTAKES: dict[str, tuple[Callable[[], object], str, str]] = {
    "unit in Python": (lambda: sw.LinearElastic(E="1 Pa"), "E: '1 Pa' is not a number", "SI units"),
    "nothing as number": (lambda: sw.NeoHookean(E=1.0, nu=None), "nu: None is not a number", "SI units"),
    "several moduli": (lambda: sw.LinearElastic(E=np.ones(2)), "E: array", "a number"),
    "time as text": (lambda: sw.Time(end="1 s"), "end: '1 s' is not a number", "SI units"),
    "step as text": (lambda: sw.Time(end=1.0, step="1 ms"), "step: '1 ms'", "SI units"),
    "frames as text": (lambda: sw.Output(fields_every="1 ms"), "fields_every: '1 ms'", "SI units"),
    "tolerance as text": (lambda: sw.FixedPoint(tolerance="1e-8"), "tolerance: '1e-8'", "a number"),
    "point as text": (lambda: sw.obstacles.HalfSpace(point="1 m", normal=1.0), "point: '1 m'", "SI units"),
    "no obstacle": (lambda: sw.Tool(shape=None), "shape: None", "HalfSpace"),
    "density as text": (lambda: of(density="7850 kg/m^3"), "bodies.bar.density: '7850 kg/m^3'", "without quotes"),
    "density of nodes": (lambda: of(density=np.ones(4)), "bodies.bar.density: array", "a density"),
    "velocity as number": (lambda: of(velocity=1.0), "bodies.bar.velocity: 1.0", "Uniform"),
    "velocity of two nodes": (lambda: of(velocity=np.ones((2, 1))), "bodies.bar.velocity: values of shape", "(5, 1)"),
    "mesh as file": (lambda: of(mesh="bar.msh"), "bodies.bar.mesh: 'bar.msh'", "MeshFile"),
    "no mesh": (lambda: of(mesh=None), "bodies.bar.mesh: None", "Interval"),
    "half cells": (lambda: of(mesh=replace(MESH, cells=4.5)), "bodies.bar.mesh.cells: 4.5", "a whole number"),
    "length as text": (lambda: of(mesh=replace(MESH, length="1 m")), "bodies.bar.mesh.length: '1 m'", "a length"),
    "class for a law": (lambda: of(material=sw.LinearElastic), "bodies.bar.material: <class", "NeoHookean"),
    "name for a law": (lambda: of(material="steel S235"), "bodies.bar.material: 'steel S235'", "LinearElastic"),
    "one support": (lambda: of(supports=sw.Fixed(on="left")), "bodies.bar.supports: Fixed", "tuple of Fixed or Driven"),
    "list of bodies": (lambda: replace(WHOLE, bodies=[BAR]), "bodies: [Solid", "Mapping"),
    "a body without a name": (lambda: replace(WHOLE, bodies={1: BAR}), "bodies: 1 is not a name", "text"),
    "no body": (lambda: replace(WHOLE, bodies={"bar": 3}), "bodies.bar: 3", "Solid or Tool"),
    "one contact": (lambda: replace(WHOLE, contacts=TIP), "contacts: Contact", "a tuple of Contact"),
    "rule by name": (lambda: replace(WHOLE, contacts=(replace(TIP, timing="Energy"),)), "contacts[0].timing", "Paper"),
    "friction as number": (
        lambda: replace(WHOLE, contacts=(replace(TIP, friction=0.3),)), "contacts[0].friction: 0.3", "Coulomb"),
    "time as number": (lambda: replace(WHOLE, time=3.0), "time: 3.0", "Time"),
    "solver by name": (lambda: replace(WHOLE, solver="Newton"), "solver: 'Newton'", "Newton"),
    "half an iteration": (lambda: replace(WHOLE, solver=sw.FixedPoint(limit=1.5)), "solver.limit: 1.5", "whole number"),
    "operator by name": (lambda: replace(WHOLE, solver=sw.FixedPoint(operator="foo")), "solver.operator: ", "'auto'"),
    "gravity as number": (lambda: replace(WHOLE, loads=9.81), "loads: 9.81", "Gravity"),
    "one probe": (lambda: replace(WHOLE, output=sw.Output(probes=PROBE)), "output.probes: Probe", "a tuple of Probe"),
    "title as number": (lambda: replace(WHOLE, title=3), "title: 3", "text"),
    "a path for a scenario": (lambda: "bar.toml", "scenario: 'bar.toml'", "softway.load(FILE)"),
}  # fmt: skip


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_in_python_names_place_value_and_remedy(case):
    make, told, remedy = MISTAKES[case]
    with pytest.raises(sw.InputError) as caught:
        check(make())
    where, _, remedies = str(caught.value).partition("try: ")
    assert told in where and remedy in remedies


def test_what_fits_is_left_alone():
    numbers = replace(WHOLE, bodies={"bar": replace(BAR, density=np.float32(1)), "wall": WALL}, contacts=[TIP])
    for scenario in (numbers, of(velocity=np.ones((5, 1))), of(velocity=lambda points: points), of(mesh=MESH.build())):
        assert check(scenario).slabs == 10


def test_a_sweep_takes_a_file_and_lists(tmp_path):
    with pytest.raises(sw.InputError, match="is not a path"):
        sw.sweep(WHOLE, {"time.end": [1.0]})
    with pytest.raises(sw.InputError, match="is not a list of values"):
        sw.sweep(tmp_path / "bar.toml", {"time.end": 1.0})
