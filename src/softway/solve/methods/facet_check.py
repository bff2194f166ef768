"""Check of iterates on kept facets for overlap with other facets."""

from dataclasses import replace

from softway.arrays import Array
from softway.solve.equations.slab_equations import SlabEquations

NEARLY = 1e-7
"""Relative change of velocity below which kept facets are compared with the surface."""


def check_facets(system: SlabEquations, q: Array, change: float) -> tuple[bool, SlabEquations]:
    """Check whether an iterate is free of overlap; return the equations to continue with, with missing facets added."""
    if not system.contact.kept:
        return True, system
    if change > NEARLY * system.model.space.greatest(q):
        return False, system
    u1 = system.path.end(q)
    if system.contact.facets_complete(u1):
        return True, system
    return False, replace(system, contact=system.contact.with_added_facets(u1))
