"""Notes on thermal stresses that a law with a flow does not limit."""

from softway.bodies.elements.section import Bar, PlaneStress
from softway.bodies.internal_force.materials import laws_of
from softway.bodies.solid import Solid
from softway.errors import Note
from softway.laws.law import initial_moduli
from softway.scenario.checks.locking import flowing, poisson
from softway.scenario.checks.names import mesh_of
from softway.scenario.checks.scales import section_of

FLOWS = 1e-2
"""Increase of Poisson's ratio in a flow from which a law counts as one that flows."""


def thermal_notes(solid: Solid) -> tuple[Note, ...]:
    """Note on a solid with free faces whose thermal stress stands beside a law that yields or flows."""
    heat = solid.thermal
    if heat is None or not (heat.expansion or heat.melting_strain):
        return ()
    if not isinstance(section_of(solid, mesh_of(solid)), Bar | PlaneStress):
        return ()
    flow = [
        type(law).__name__ for law in laws_of(solid.material) if flowing(law) > poisson(initial_moduli(law)) + FLOWS
    ]
    if not flow:
        return ()
    problem = (
        f"in bars and in plane stress the flow of {', '.join(flow)} does not limit the stress of a hindered expansion"
    )
    remedy = "nothing while that stress stays below the yield stress; or PlaneStrain, Axisymmetric or a body in space"
    return (Note(where="thermal.expansion", problem=problem, remedy=remedy),)
