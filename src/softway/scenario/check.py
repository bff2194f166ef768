"""Everything that can be found wrong in a scenario before computing, and the scales of what is right."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.march.begin import SOON, require_apart, require_supported
from softway.march.march import proposed
from softway.model import Model, build
from softway.record.probes import readings
from softway.scenario.references import (
    check_contact,
    check_contacts,
    check_density,
    check_dimensions,
    check_loads,
    check_solid,
    mesh_of,
)
from softway.scenario.scales import (
    BodyScales,
    ContactScales,
    body_scales,
    contact_duration,
)
from softway.scenario.scenario import Scenario, built
from softway.scenario.sorts import require
from softway.scene import StaticStart
from softway.solve.explicit import Explicit
from softway.solve.stability import require_stable
from softway.typing import Array

MOST = 1_000_000_000
"""Slabs that nobody waits for."""
SAME = 1e-9
"""Difference of gaps, in lengths of the body, below which places are equally near."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Checked:
    """A scenario in which nothing was found wrong.

    Parameters
    ----------
    scenario
        As given.
    model
        The scene as arrays, ready to march.
    bodies, contacts
        Scales by name and by label.
    step, slabs
        Length of a slab [s], the automatic one if that was asked for, and how many there are.
    """

    scenario: Scenario
    model: Model
    bodies: Mapping[str, BodyScales]
    contacts: Mapping[str, ContactScales]
    step: float
    slabs: int


def check(scenario: Scenario) -> Checked:
    """Make the meshes and look at every name, sign, dimension and start.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    """
    _require_scenario(scenario)
    for name, body in scenario.bodies.items():
        if isinstance(body, Solid):
            check_density(body.density, f"bodies.{name}.density")
    scene = built(scenario)
    solids = {n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}
    if not solids:
        raise InputError("bodies", f"no Solid among {list(scene.bodies)}", 'at least one body of kind = "Solid"')
    check_dimensions(scene, solids)
    for name, solid in solids.items():
        if not mesh_of(solid).edge() > 0.0:
            raise InputError(
                f"bodies.{name}.mesh", "an edge of length zero", "a node of its own at each corner of a cell"
            )
    fixed = {n: check_solid(s, f"bodies.{n}") for n, s in solids.items()}
    check_loads(scenario.loads, "loads", solids)
    check_contacts(scene.contacts)
    bodies = {n: body_scales(s, mesh_of(s), int((~fixed[n]).sum())) for n, s in solids.items()}
    for k, contact in enumerate(scene.contacts):
        check_contact(scene.bodies, contact, f"contacts[{k}]")
    readings(scenario.output.probes, {n: mesh_of(s) for n, s in solids.items()})
    if isinstance(scenario.start, StaticStart):
        check_loads(scenario.start.loads, "start.loads", solids)
    model = build(scene)
    require_apart(model, model.displacement)
    contacts = {c.label: _contact(model, k, bodies) for k, c in enumerate(scene.contacts)}
    require_supported(model)
    time = scenario.time
    if time.step != "auto" and time.step > time.end:
        raise InputError("time.step", f"{time.step:g} s is longer than the end, {time.end:g} s", "a shorter step")
    solver = scenario.solver
    step = proposed(model, time.step, time.weight, time.end, solver)
    stepping = solver if isinstance(solver, Explicit) else time.weight
    if not (isinstance(stepping, Explicit) and time.step == "auto"):  # then a share of the limit
        require_stable(model, model.displacement, stepping, step)
    slabs = int(np.ceil(time.end / step * (1.0 - 1e-12)))
    if slabs > MOST:
        raise InputError("time.end", f"{slabs:.3g} slabs of {step:.3g} s", "an earlier end, or longer slabs")
    return Checked(scenario=scenario, model=model, bodies=bodies, contacts=contacts, step=step, slabs=slabs)


def _require_scenario(scenario: object) -> None:
    """Refuse what is no scenario, and one with parts that are not of the sorts that belong there."""
    if not isinstance(scenario, Scenario):
        raise InputError("scenario", f"{scenario!r:.60} is none", "a Scenario, such as softway.load(FILE)")
    require(scenario, Scenario, "")


def _contact(model: Model, number: int, bodies: Mapping[str, BodyScales]) -> ContactScales:
    """Scales of a contact."""
    u = model.displacement
    rows = model.rows(u)
    here = rows.of(number) & rows.near
    driven = model.encounters.meet(u, u, 0.0, SOON).at(u).drive / SOON
    normals, gaps, speeds = rows.normal[here], rows.gap(u)[here], (driven - rows.along(model.velocity))[here]
    if not here.any():
        normals, gaps, speeds = _nearest(model, number)
    parts = [model.parts[k] for k in model.opponents[number] if k >= 0]
    least = np.flatnonzero(gaps <= gaps.min() + SAME * max(bodies[p.name].length for p in parts))
    first = least[np.argmax(speeds[least])]
    durations = [contact_duration(p.mesh.points, normals[first], bodies[p.name].wave_speed) for p in parts]
    return ContactScales(
        nodes=len(np.unique(rows.node[rows.of(number)])),
        gap=float(gaps.min()),
        approach=float(speeds[first]) + 0.0,
        duration=min(durations),
    )


def _nearest(model: Model, number: int) -> tuple[Array, Array, Array]:
    """Direction (1, d), distance (1,) and closing speed (1,) of the nearest nodes of two solids that are far apart."""
    contact = model.scene.contacts[number]
    parts = [model.parts[k] for k in model.opponents[number]]
    tags = contact.tag, contact.opponent_tag
    one, other = (p.mesh.nodes(tag) + p.rows.start for p, tag in zip(parts, tags, strict=True))
    x = model.points + model.displacement
    distance, found = cKDTree(x[other]).query(x[one])
    least = int(np.argmin(distance))
    a, b = one[least], other[found[least]]
    direction = (x[a] - x[b]) / distance[least]
    return direction[None], distance[[least]], -np.array([(model.velocity[a] - model.velocity[b]) @ direction])
