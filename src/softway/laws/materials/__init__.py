"""Common materials with their constants and sources."""

from softway.laws.materials.library import find as find
from softway.laws.materials.library import names as names
from softway.laws.materials.material import Material as Material

__all__ = ["Material", "find", "names"]
