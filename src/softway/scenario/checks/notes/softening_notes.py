"""Notes on impacts that bring matter to where its law loses its stability."""

from collections.abc import Mapping

from softway.bodies.elements.section import Bar, PlaneStress, Section
from softway.errors import Note
from softway.laws.bulk import StVenantKirchhoff
from softway.laws.elasticity.compression import BAR_STRETCH, plane_impact, stable_stretch
from softway.laws.elasticity.elastic_constants import lame
from softway.model.model import Model
from softway.scenario.checks.scales import ContactScales

CONCENTRATION = 2.0
"""Compression at edges and corners, relative to that behind a plane front."""


def softening_notes(model: Model, contacts: Mapping[str, ContactScales]) -> tuple[Note, ...]:
    """Notes on St. Venant-Kirchhoff bodies that approach too fast, see docs/theory/bodies/softening.md; one for each.

    Two solids share the speed of their approach.  Without inertia there are no waves, and no notes.
    """
    if not model.inert:
        return ()
    notes: dict[str, Note] = {}
    for k, contact in enumerate(model.scene.contacts):
        solids = [model.parts[n] for n in model.contact_solids[k]]
        speed = contacts[contact.label].approach / len(solids)
        for part in solids:
            factor, section = model.scene.inertia.factor, part.internal.section
            for law, wave in zip(part.materials.laws, part.materials.speeds(section, factor), strict=True):
                if type(law) is not StVenantKirchhoff:
                    continue
                stretch = _stable(law, section)
                bound = plane_impact(stretch) * wave
                if speed * CONCENTRATION > bound:
                    notes.setdefault(part.name, _note(part.name, speed, bound, stretch))
    return tuple(notes.values())


def _stable(law: StVenantKirchhoff, section: Section) -> float:
    """Least stable stretch of a material in a section."""
    if isinstance(section, Bar):
        return BAR_STRETCH
    first, shear = lame(law.E, law.nu)
    if isinstance(section, PlaneStress):
        return stable_stretch(2.0 * first / (first + 2.0 * shear))
    return stable_stretch(first / shear)


def _note(name: str, speed: float, bound: float, stretch: float) -> Note:
    problem = (
        f"hits at {speed:.3g} m/s; a plane impact at {bound:.3g} m/s, and half of that at edges and corners, "
        f"compresses StVenantKirchhoff matter to {stretch:.2g} of its length, where it loses its stability: it may "
        "collapse and end the march"
    )
    return Note(where=f"bodies.{name}.material", problem=problem, remedy="NeoHookean, which stiffens under compression")
