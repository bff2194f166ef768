"""Probes of a scenario of solids and rigid bodies, resolved on their meshes and bodies."""

from collections.abc import Mapping

from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.mechanisms.members.mechanism import Mechanism
from softway.meshes.mesh import Mesh
from softway.record.write.mechanism.probes import body_reading
from softway.record.write.mechanism.rigid_table import RigidReading
from softway.record.write.probes import NONE, Changing, Reading, readings, require_names, solid_reading
from softway.scenario.scenario import Scenario


def probe_readings(
    scenario: Scenario,
    meshes: Mapping[str, Mesh],
    mechanism: Mechanism | None,
    present: Mapping[str, Changing] = NONE,
) -> tuple[Reading | RigidReading, ...]:
    """Resolve the probes of a scenario; ``present`` are the meshes of solids that change.

    Raises
    ------
    InputError
        With the path ``output.probes[k]``.
    """
    probes = scenario.output.probes
    for k, probe in enumerate(probes):
        body = scenario.bodies.get(probe.of)
        if probe.quantity == "temperature" and isinstance(body, Solid) and body.thermal is None:
            problem, remedy = (
                f"the solid {probe.of!r} has no temperature",
                f"bodies.{probe.of}.thermal, or displacement",
            )
            raise InputError(f"output.probes[{k}].quantity", problem, remedy)
    if mechanism is None:
        solids = {name: body for name, body in scenario.bodies.items() if isinstance(body, Solid)}
        changing = {name for name, solid in solids.items() if solid.adapt or solid.remesh}
        return readings(probes, meshes, {name: mesh for name, mesh in present.items() if name in changing})
    require_names(probes)
    found: list[Reading | RigidReading] = []
    for k, probe in enumerate(probes):
        path = f"output.probes[{k}]"
        if probe.of in mechanism.bodies:
            found.append(RigidReading(body_reading(path, probe, mechanism)))
        else:
            found.append(solid_reading(path, probe, meshes, tuple(mechanism.bodies)))
    return tuple(found)
