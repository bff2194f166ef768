"""Everything that can be found wrong in a scenario before computing, and the scales of what is right."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isinf

import numpy as np

from softway.bodies.fields import sample
from softway.bodies.section import Axisymmetric
from softway.bodies.solid import Solid
from softway.contact.contact import Contact
from softway.errors import InputError
from softway.march.march import proposed
from softway.model import build
from softway.record.probes import readings
from softway.scenario.references import (
    candidate_nodes,
    check_density,
    check_dimensions,
    check_loads,
    check_solid,
    check_timings,
    mesh_of,
    solid_named,
    tool_named,
)
from softway.scenario.rigid import free_motions
from softway.scenario.scales import (
    BodyScales,
    ContactScales,
    automatic_step,
    body_scales,
    contact_duration,
    section_of,
)
from softway.scenario.scenario import Scenario, built
from softway.scene import Scene, StaticStart
from softway.time.weight import limit
from softway.typing import BoolArray

# A node this deep inside an obstacle, relative to the size of the body, counts as touching: rounding of coordinates.
_OVERLAP = 1e-12


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Checked:
    """A scenario in which nothing was found wrong.

    Parameters
    ----------
    scenario
        As given.
    scene
        With every mesh made and in its place.
    bodies, contacts
        Scales by name and by label.
    step, slabs
        Length of a slab [s], the automatic one if that was asked for, and how many there are.
    """

    scenario: Scenario
    scene: Scene
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
    for name, body in scenario.bodies.items():
        if isinstance(body, Solid):
            check_density(body.density, f"bodies.{name}.density")
    scene = built(scenario)
    solids = {n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}
    if not solids:
        raise InputError("bodies", f"no Solid among {list(scene.bodies)}", 'at least one body of kind = "Solid"')
    check_dimensions(scene, solids)
    fixed = {n: check_solid(s, f"bodies.{n}") for n, s in solids.items()}
    check_loads(scenario.loads, "loads", solids)
    check_timings(scene.contacts)
    bodies = {n: body_scales(s, mesh_of(s), int((~fixed[n]).sum())) for n, s in solids.items()}
    contacts = {c.label: _contact(scene, c, bodies, f"contacts[{k}]") for k, c in enumerate(scene.contacts)}
    readings(scenario.output.probes, {n: mesh_of(s) for n, s in solids.items()})
    if isinstance(scenario.start, StaticStart):
        check_loads(scenario.start.loads, "start.loads", solids)
        _check_held(solids, fixed)
    step, slabs = slabs_of(scenario, scene, bodies)
    return Checked(scenario=scenario, scene=scene, bodies=bodies, contacts=contacts, step=step, slabs=slabs)


def slabs_of(scenario: Scenario, scene: Scene, bodies: Mapping[str, BodyScales]) -> tuple[float, int]:
    """Length of a slab [s] and their number; the automatic one below the stability limit of the weight."""
    time = scenario.time
    if time.step != "auto":
        step = time.step
    elif isinf(limit(time.weight)):
        step = automatic_step(time.end, [b.edge / b.wave_speed for b in bodies.values()])
    else:
        step = proposed(build(scene), "auto", time.weight, time.end)
    if step > time.end:
        raise InputError("time.step", f"{step:g} s is longer than the end, {time.end:g} s", "a shorter step")
    return step, int(np.ceil(time.end / step * (1.0 - 1e-12)))


def _contact(scene: Scene, contact: Contact, bodies: Mapping[str, BodyScales], where: str) -> ContactScales:
    """Scales of a contact; refuses a start inside the obstacle."""
    nodes = candidate_nodes(scene, contact, where)
    tool = tool_named(scene.bodies, contact.between[1], f"{where}.between")
    solid = solid_named(scene.bodies, contact.body, where)
    mesh, shape = mesh_of(solid), tool.shape
    points = mesh.points[nodes] + sample(solid.displacement, mesh)[nodes]
    gap = np.asarray(shape.gap(points))
    least = int(np.argmin(gap))
    size = max(bodies[contact.body].length, float(np.abs(points).max()))
    if gap[least] < -_OVERLAP * size:
        place = ", ".join(f"{x:.6g}" for x in points[least])
        depth = f"{-gap[least]:.6g} m"
        raise InputError(
            f"{where}.between",
            f"{contact.body!r} starts {depth} inside {contact.between[1]!r}: node {nodes[least]} at ({place}) m",
            f"move the body out by {depth}: bodies.{contact.body}.place.translation or .bottom",
        )
    normals = np.asarray(shape.normal_at(points))
    speeds = -np.einsum("ni,ni->n", normals, sample(solid.velocity, mesh)[nodes])
    duration = contact_duration(mesh.points, normals, bodies[contact.body].wave_speed)
    return ContactScales(nodes=len(nodes), gap=float(gap[least]), approach=float(speeds.max()) + 0.0, duration=duration)


def _check_held(solids: Mapping[str, Solid], fixed: Mapping[str, BoolArray]) -> None:
    """Refuse a static start of a body that can move as a whole."""
    for name, solid in solids.items():
        mesh = mesh_of(solid)
        axisymmetric = isinstance(section_of(solid, mesh), Axisymmetric)
        motions = free_motions(mesh.points, fixed[name], axisymmetric)
        if motions:
            raise InputError(
                f"bodies.{name}.supports",
                f"{len(solid.supports)} supports leave free: {', '.join(motions)}; no static start",
                'supports that hold it, such as { on = "left" }, or start = "AsGiven"',
            )
