"""Notes on a scenario: meshes that are computed, although their results may be wrong."""

from collections.abc import Mapping

from softway.bodies.solid import Solid
from softway.errors import Note, within
from softway.meshes.examination import examined
from softway.scenario.checks.names import mesh_of


def mesh_notes(solids: Mapping[str, Solid]) -> tuple[Note, ...]:
    """Notes on the meshes of the solids by name.

    Raises
    ------
    InputError
        For a mesh whose cells overlap, or with a node that hangs on a facet.
    """
    notes: list[Note] = []
    for name, solid in solids.items():
        with within(f"bodies.{name}.mesh"):
            notes += [note.within(f"bodies.{name}") for note in examined(mesh_of(solid))]
    return tuple(notes)
